#include "meshes/crowded_points.h"

#include "core/parallel.h"
#include "meshes/close_pairs.h"
#include "meshes/point_slabs.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <tuple>
#include <utility>

namespace fppg
{
namespace
{

/// So much of a distance may be lacking: coordinates of files are rounded.
constexpr double rounding = 1e-4;
/// More points than this are worked on in slabs, to need less memory.
constexpr std::size_t points_together = 2'000'000;

/// The members of a slab, then those of the ones beside it that are within reach.
std::vector<std::uint32_t> members_and_near(const std::vector<Vec3>& points,
                                            const std::vector<PointSlab>& slabs, std::size_t s,
                                            double reach)
{
    const PointSlab& slab = slabs[s];
    std::vector<std::uint32_t> out = slab.members;
    const auto add_near = [&](const PointSlab& beside)
    {
        for (const std::uint32_t i : beside.members)
            if (const double at = points[i][slab.axis];
                at >= slab.low - reach && at <= slab.high + reach)
                out.push_back(i);
    };
    if (s > 0) add_near(slabs[s - 1]);
    if (s + 1 < slabs.size()) add_near(slabs[s + 1]);
    return out;
}

/// Calls visit(chunk, i, j, squared distance) for every point i and every other one j within reach,
/// in any order; chunks are worked through by one thread each, and all pairs of i are of one chunk.
/// Before, begin(chunks) is called for each round of chunks, and end() after it.
template <typename Begin, typename Visit, typename End>
void for_each_close_pair(const std::vector<Vec3>& points, double reach, int threads,
                         const Begin& begin, const Visit& visit, const End& end)
{
    if (points.size() <= points_together)
    {
        const ClosePairs pairs(points, reach, threads);
        begin(pairs.chunks());
        parallel_for(pairs.chunks(), threads,
                     [&](std::size_t chunk)
                     {
                         pairs.for_each_pair_of(
                             chunk, [&](std::uint32_t i, std::uint32_t j, double squared)
                             { visit(chunk, i, j, squared); });
                     });
        end();
        return;
    }
    std::vector<std::uint32_t> all(points.size());
    std::iota(all.begin(), all.end(), 0u);
    const std::vector<PointSlab> slabs = cut_into_slabs(points, all, points_together, 2 * reach);
    all = {};
    for (std::size_t s = 0; s < slabs.size(); ++s)
    {
        const PointSlab& slab = slabs[s];
        const std::vector<std::uint32_t> members = members_and_near(points, slabs, s, reach);
        std::vector<Vec3> own(members.size());
        for (std::size_t k = 0; k < own.size(); ++k) own[k] = points[members[k]];
        const ClosePairs pairs(own, reach, threads);
        begin(pairs.chunks());
        parallel_for(pairs.chunks(), threads,
                     [&](std::size_t chunk)
                     {
                         pairs.for_each_pair_of(
                             chunk,
                             [&](std::uint32_t i, std::uint32_t j, double squared)
                             {
                                 if (i < slab.members.size())
                                     visit(chunk, members[i], members[j], squared);
                             });
                     });
        end();
    }
}

} // namespace

std::vector<double> nearest_distances(const std::vector<Vec3>& points, double reach, int threads)
{
    std::vector<double> out(points.size(), reach * reach);
    for_each_close_pair(
        points, reach, threads, [](std::size_t) {},
        [&](std::size_t, std::uint32_t i, std::uint32_t, double squared)
        { out[i] = std::min(out[i], squared); },
        [] {});
    for (double& distance : out) distance = std::sqrt(distance);
    return out;
}

std::vector<char> find_crowded(const std::vector<Vec3>& points,
                               const std::vector<std::uint32_t>& rank, double distance,
                               const std::function<bool(std::size_t, std::size_t)>& may_stay,
                               int threads)
{
    struct Crowded
    {
        std::uint32_t point = 0;
        std::uint32_t before = 0; ///< of it, too near
    };
    const auto place_of = [&](std::uint32_t i) { return std::tuple(rank[i], i); };
    const double least = (1 - rounding) * distance;
    std::vector<std::vector<Crowded>> of_chunk;
    std::vector<Crowded> crowded;
    for_each_close_pair(
        points, distance, threads, [&](std::size_t chunks) { of_chunk.resize(chunks); },
        [&](std::size_t chunk, std::uint32_t i, std::uint32_t j, double squared)
        {
            if (squared < least * least && place_of(j) < place_of(i) &&
                !(may_stay && may_stay(i, j)))
                of_chunk[chunk].push_back({i, j});
        },
        [&]
        {
            for (const auto& some : of_chunk)
                crowded.insert(crowded.end(), some.begin(), some.end());
            of_chunk.clear();
        });
    std::sort(crowded.begin(), crowded.end(),
              [&](const Crowded& a, const Crowded& b)
              { return place_of(a.point) < place_of(b.point); });
    std::vector<char> goes(points.size(), 0);
    for (const Crowded& pair : crowded)
        if (goes[pair.before] == 0) goes[pair.point] = 1;
    return goes;
}

} // namespace fppg
