#include "meshes/crowded_points.h"

#include "core/parallel.h"
#include "meshes/close_pairs.h"

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

namespace fppg
{
namespace
{

/// So much of a distance may be lacking: coordinates of files are rounded.
constexpr double rounding = 1e-4;

} // namespace

std::vector<double> nearest_distances(const std::vector<Vec3>& points, double reach, int threads)
{
    const ClosePairs pairs(points, reach, threads);
    std::vector<double> out(points.size(), reach * reach);
    parallel_for(pairs.chunks(), threads,
                 [&](std::size_t chunk)
                 {
                     pairs.for_each_pair_of(chunk,
                                            [&](std::uint32_t i, std::uint32_t, double squared)
                                            { out[i] = std::min(out[i], squared); });
                 });
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
    const ClosePairs pairs(points, distance, threads);
    std::vector<std::vector<Crowded>> of_chunk(pairs.chunks());
    parallel_for(of_chunk.size(), threads,
                 [&](std::size_t chunk)
                 {
                     pairs.for_each_pair_of(chunk,
                                            [&](std::uint32_t i, std::uint32_t j, double squared)
                                            {
                                                if (squared < least * least &&
                                                    place_of(j) < place_of(i) &&
                                                    !(may_stay && may_stay(i, j)))
                                                    of_chunk[chunk].push_back({i, j});
                                            });
                 });
    std::vector<Crowded> crowded;
    for (const auto& some : of_chunk) crowded.insert(crowded.end(), some.begin(), some.end());
    std::sort(crowded.begin(), crowded.end(),
              [&](const Crowded& a, const Crowded& b)
              { return place_of(a.point) < place_of(b.point); });
    std::vector<char> goes(points.size(), 0);
    for (const Crowded& pair : crowded)
        if (goes[pair.before] == 0) goes[pair.point] = 1;
    return goes;
}

} // namespace fppg
