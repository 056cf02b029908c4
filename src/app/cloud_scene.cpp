#include "app/cloud_scene.h"

#include "compare/report_words.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>

namespace fppg
{

SceneSet scene_by_mk(const ParticleCloud& cloud, const std::string& name)
{
    std::map<std::uint16_t, ScenePart> parts;
    for (std::size_t i = 0; i < cloud.positions.size(); ++i)
    {
        ScenePart& part = parts[cloud.mk[i]];
        if (part.positions.empty())
        {
            part.colour = hex_of(colour_of(cloud, i, RenderColour::Mk));
            part.mk = cloud.mk[i];
            part.label = fmt::format("mk {}", cloud.mk[i]);
            if (!cloud.type.empty())
                part.label += fmt::format(" {}", particle_type_name(cloud.type[i]));
        }
        part.positions.push_back(cloud.positions[i]);
    }
    SceneSet set;
    set.name = name;
    set.dp = cloud.dp;
    for (auto& [mk, part] : parts) set.parts.push_back(std::move(part));
    return set;
}

void add_motion(SceneSet& set, const std::vector<MovingBlock>& moving)
{
    constexpr std::size_t most_frames = 250;
    for (const MovingBlock& block : moving)
        for (ScenePart& part : set.parts)
        {
            if (part.mk != block.mk || block.places.size() < 2) continue;
            const std::size_t last = block.places.size() - 1;
            const std::size_t step = (last + most_frames - 1) / most_frames;
            for (std::size_t i = 0; i <= last; i += step) part.frames.push_back(block.places[i]);
            set.end = block.step * static_cast<double>((part.frames.size() - 1) * step);
        }
}

std::vector<double> frame_times(const SceneSet& set)
{
    std::size_t frames = 1;
    for (const ScenePart& part : set.parts) frames = std::max(frames, part.frames.size());
    std::vector<double> out(frames);
    for (std::size_t i = 1; i < frames; ++i)
        out[i] = set.end * static_cast<double>(i) / static_cast<double>(frames - 1);
    return out;
}

void add_marks(SceneSet& set, const NearPlaces& places, double within_dp)
{
    constexpr std::size_t most_start_marks = 20000;
    std::map<std::uint16_t, std::string> names;
    for (const auto& [mkbound, name] : places.names)
    {
        names[mkbound] = name;
        for (ScenePart& part : set.parts)
            if (part.mk == mkbound + places.mk_bound_first && !name.empty())
                part.label += ": " + name;
    }
    set.mark_label = fmt::format("gaps below {:g} dp", within_dp);
    set.frames = frame_times(set).size();
    for (const NearPlace& place : places.places)
        set.marks.push_back(
            {place.look, place.place,
             fmt::format("{} and {}: {} at ({:.4g}, {:.4g}, {:.4g}) m", names[place.first],
                         names[place.second],
                         place.gap_dp > 0 ? fmt::format("{:.2f} dp", place.gap_dp) : "overlap",
                         place.place.x, place.place.y, place.place.z)});
    const std::size_t step = places.narrow.size() / most_start_marks + 1;
    for (std::size_t i = 0; i < places.narrow.size(); i += step)
        set.start_marks.push_back(places.narrow[i].position);
}

} // namespace fppg
