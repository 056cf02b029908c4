#include "core/parallel.h"
#include "gaps/case_parts.h"
#include "gaps/passages.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace fppg
{

namespace
{

/// Whether two parts keep their places against each other at all times.
bool keep_their_places(const CasePart& a, const CasePart& b, const std::vector<double>& times)
{
    if (!a.motion && !b.motion) return true;
    const auto relative = [&](double t) { return inverse_of(a.place(t)) * b.place(t); };
    const Transform first = relative(times.front());
    const double size = norm(b.tree->bounds().max - b.tree->bounds().min);
    const Vec3 corner = b.tree->bounds().max;
    return std::all_of(times.begin(), times.end(),
                       [&](double t)
                       {
                           const Transform now = relative(t);
                           // A turn about the corner would not move it.
                           return norm(now(corner) - first(corner)) <= 1e-6 * size &&
                                  norm(now(b.tree->bounds().min) - first(b.tree->bounds().min)) <=
                                      1e-6 * size &&
                                  norm(now.linear[0] - first.linear[0]) <= 1e-6 &&
                                  norm(now.linear[1] - first.linear[1]) <= 1e-6;
                       });
}

std::vector<NearPlace> places_of(const CasePart& a, const CasePart& b,
                                 const std::vector<double>& times, double within, double dp)
{
    std::vector<NearPlace> out;
    const auto add = [&](std::size_t look, const SurfaceGap& gap)
    {
        const Vec3 middle = (gap.on_first + gap.on_second) * 0.5;
        out.push_back({look, a.place(times[look])(middle), gap.crosses ? 0 : gap.distance / dp,
                       a.mkbound, b.mkbound});
    };
    const auto gap_at = [&](double t)
    { return a.tree->gap_to(*b.tree, inverse_of(a.place(t)) * b.place(t), within); };
    if (keep_their_places(a, b, times))
    {
        const SurfaceGap gap = gap_at(times.front());
        if (std::isfinite(gap.distance) && !gap.crosses && gap.distance > touching_dp * dp)
            for (std::size_t look = 0; look < times.size(); ++look) add(look, gap);
        return out;
    }
    for (std::size_t look = 0; look < times.size(); ++look)
    {
        const SurfaceGap gap = gap_at(times[look]);
        if (std::isfinite(gap.distance)) add(look, gap);
    }
    return out;
}

} // namespace

NearPlaces find_near_places(const std::string& definition, const MotionGapOptions& options,
                            const std::vector<double>& times, double within_dp)
{
    const GapCase of = read_gap_case(definition, options);
    const double dp = of.def.grid.dp;
    NearPlaces out;
    out.notes = of.notes;
    out.mk_bound_first = of.def.mk_bound_first;
    for (const CasePart& part : of.parts) out.names.emplace_back(part.mkbound, part.name);
    std::vector<std::pair<std::size_t, std::size_t>> pairs;
    for (std::size_t a = 0; a < of.parts.size(); ++a)
        for (std::size_t b = a + 1; b < of.parts.size(); ++b) pairs.emplace_back(a, b);
    std::vector<std::vector<NearPlace>> found(pairs.size());
    parallel_for(pairs.size(), options.threads,
                 [&](std::size_t k)
                 {
                     found[k] = places_of(of.parts[pairs[k].first], of.parts[pairs[k].second],
                                          times, within_dp * dp, dp);
                 });
    for (const std::vector<NearPlace>& of_pair : found)
        out.places.insert(out.places.end(), of_pair.begin(), of_pair.end());
    std::stable_sort(out.places.begin(), out.places.end(),
                     [](const NearPlace& a, const NearPlace& b) { return a.look < b.look; });
    if (!options.finds_passages) return out;
    MotionGaps passages;
    find_passages(of.def, of.solids, options.threads, passages);
    out.notes.insert(out.notes.end(), passages.notes.begin(), passages.notes.end());
    for (const NarrowPlace& place : passages.places)
        if (place.gap_dp < within_dp) out.narrow.push_back(place);
    return out;
}

} // namespace fppg
