#include "fppg/motion_gaps.h"

#include "core/json.h"
#include "core/text.h"
#include "core/text_table.h"
#include "files/vtk.h"

#include <fmt/format.h>

#include <cmath>

namespace fppg
{

namespace
{

/// Pairs that keep their places are listed where they are nearer, dp.
constexpr double listed_dp = 4;

std::string place_of(const Vec3& p)
{
    // What is rounding beside the others is 0.
    const auto tidy = [least = 1e-9 * norm(p)](double v) { return std::abs(v) < least ? 0 : v; };
    return fmt::format("({:.5g}, {:.5g}, {:.5g})", tidy(p.x), tidy(p.y), tidy(p.z));
}

std::string cut(const std::string& name)
{
    constexpr std::size_t most = 28;
    return name.size() <= most ? name : name.substr(0, most - 3) + "...";
}

std::vector<std::string> row_of(const MkGap& pair)
{
    const bool overlaps = pair.overlapping > 0;
    return {fmt::format("{} {}", pair.first, cut(pair.first_name)),
            fmt::format("{} {}", pair.second, cut(pair.second_name)),
            overlaps               ? "overlap"
            : pair.least_dp < 1000 ? fmt::format("{:.3f}", pair.least_dp)
                                   : fmt::format("{:.4g}", pair.least_dp),
            fmt::format("{:.5g}", overlaps ? pair.overlap_time : pair.time),
            place_of(overlaps ? pair.overlap_place : pair.place),
            pair.moves ? fmt::format("{}", pair.looks) : "stand",
            overlaps ? fmt::format("{:.3g} deep{}", pair.depth_dp,
                                   pair.moves ? fmt::format(", {:.0f} % of the looks",
                                                            100.0 * pair.overlapping / pair.looks)
                                              : "")
                     : ""};
}

std::string resolving_text(const MotionGaps& gaps)
{
    const double more = gaps.resolving_factor();
    const double more_walls = std::pow(more, 2.0 / 3);
    std::string out = fmt::format("  dp {:.3g} m puts 4 particles across nine in ten of them: ",
                                  gaps.resolving_dp);
    if (!(gaps.volume_particles + gaps.wall_particles > 0))
        return out + fmt::format(
                         "{:.3g} times as many particles of fluid, {:.3g} times as many of walls\n",
                         more, more_walls);
    const double fluid = gaps.volume_particles * more, walls = gaps.wall_particles * more_walls;
    return out + fmt::format(
                     "about {:.2g} particles, {:.2g} of fluid and floating bodies, {:.2g} of "
                     "walls; {:.2g} now\n",
                     fluid + walls, fluid, walls, gaps.volume_particles + gaps.wall_particles);
}

} // namespace

double MotionGaps::resolving_factor() const
{
    return resolving_dp > 0 && resolving_dp < dp ? std::pow(dp / resolving_dp, 3) : 1;
}

std::string to_text(const MotionGaps& gaps)
{
    std::string out = fmt::format("Gaps of {} through its motion, up to {:g} s, in dp of {:g} m\n",
                                  gaps.definition, gaps.end, gaps.dp);
    std::vector<std::vector<std::string>> rows{
        {"mkbound", "and", "least gap", "at s", "near m", "looks", "overlap"}};
    std::size_t far = 0;
    for (const MkGap& pair : gaps.pairs)
    {
        if (pair.moves || pair.overlapping > 0 || pair.least_dp < listed_dp)
            rows.push_back(row_of(pair));
        else
            ++far;
    }
    if (rows.size() > 1) out += text_table(rows, 2, "  ");
    if (far > 0)
        out += fmt::format("  {} that keep their places and are {:g} dp apart or more\n",
                           counted(far, "pair", "pairs"), listed_dp);
    if (gaps.area > 0)
    {
        out += "Passages at the start, in front of surfaces that fluid can reach\n";
        for (std::size_t w = 0; w < MotionGaps::widths_dp.size(); ++w)
            out += fmt::format("  thinner than {:g} dp: {:.3g} % of the area, {:.4g} m2\n",
                               MotionGaps::widths_dp[w], 100 * gaps.narrow_area[w] / gaps.area,
                               gaps.narrow_area[w]);
        if (gaps.narrowest_dp > 0)
            out += fmt::format("  the narrowest: {:.3g} dp near {} m\n", gaps.narrowest_dp,
                               place_of(gaps.narrowest_at));
        if (gaps.resolving_factor() > 1) out += resolving_text(gaps);
    }
    for (const std::string& note : gaps.notes) out += "Note: " + note + '\n';
    return out;
}

std::string to_json(const MotionGaps& gaps)
{
    Json json;
    json["definition"] = gaps.definition;
    json["dp"] = gaps.dp;
    json["end"] = gaps.end;
    json["pairs"] = Json::array();
    for (const MkGap& pair : gaps.pairs)
    {
        Json one{{"mkbound", {pair.first, pair.second}},
                 {"moves", pair.moves},
                 {"least_dp", pair.least_dp},
                 {"time", pair.time},
                 {"place", {pair.place.x, pair.place.y, pair.place.z}},
                 {"looks", pair.looks},
                 {"step_dp", pair.step_dp},
                 {"overlapping_looks", pair.overlapping}};
        one["names"] = {pair.first_name, pair.second_name};
        if (pair.overlapping > 0)
        {
            one["overlap_time"] = pair.overlap_time;
            one["depth_dp"] = pair.depth_dp;
            one["overlap_place"] = {pair.overlap_place.x, pair.overlap_place.y,
                                    pair.overlap_place.z};
        }
        json["pairs"].push_back(one);
    }
    json["passages"] = {
        {"area", gaps.area},
        {"widths_dp", MotionGaps::widths_dp},
        {"narrow_area", gaps.narrow_area},
        {"narrowest_dp", gaps.narrowest_dp},
        {"narrowest_at", {gaps.narrowest_at.x, gaps.narrowest_at.y, gaps.narrowest_at.z}},
        {"resolving_dp", gaps.resolving_dp},
        {"resolving_particles",
         gaps.volume_particles * gaps.resolving_factor() +
             gaps.wall_particles * std::pow(gaps.resolving_factor(), 2.0 / 3)}};
    json["notes"] = gaps.notes;
    return json.text(2) + "\n";
}

std::string to_vtk(const MotionGaps& gaps)
{
    const std::size_t n = gaps.places.size();
    std::string out = vtk_head + fmt::format("POINTS {} float\n", n);
    for (const NarrowPlace& p : gaps.places)
        for (int axis = 0; axis < 3; ++axis)
            append_big_endian(out, static_cast<float>(p.position[axis]));
    out += fmt::format("\nVERTICES {} {}\n", n, 2 * n);
    for (std::uint32_t i = 0; i < n; ++i)
    {
        append_big_endian(out, std::uint32_t{1});
        append_big_endian(out, i);
    }
    out += fmt::format("\nPOINT_DATA {}\nSCALARS Gap float\nLOOKUP_TABLE default\n", n);
    for (const NarrowPlace& p : gaps.places) append_big_endian(out, p.gap_dp);
    out += "\nSCALARS Mk unsigned_short\nLOOKUP_TABLE default\n";
    for (const NarrowPlace& p : gaps.places) append_big_endian(out, p.mkbound);
    out += '\n';
    return out;
}

} // namespace fppg
