#include "meshes/crowded_points.h"

#include "core/parallel.h"
#include "meshes/point_grid.h"

#include <algorithm>
#include <cmath>
#include <tuple>

namespace fppg
{
namespace
{

constexpr std::size_t points_per_chunk = 1024;
/// So much of a distance may be lacking: coordinates of files are rounded.
constexpr double rounding = 1e-4;

/// Cells twice as long as the reach: eight of them are looked into instead of 27.
PointGrid grid_of_all(const std::vector<Vec3>& points, double reach)
{
    PointGrid grid(2 * reach, points.size());
    for (const Vec3& p : points) grid.add(p);
    return grid;
}

} // namespace

std::vector<double> nearest_distances(const std::vector<Vec3>& points, double reach, int threads)
{
    const PointGrid grid = grid_of_all(points, reach);
    std::vector<double> out(points.size());
    parallel_for(
        points.size(), threads,
        [&](std::size_t i)
        {
            double best = reach * reach;
            grid.for_each_near(points[i], reach,
                               [&](std::uint32_t j, double squared)
                               {
                                   if (j != i) best = std::min(best, squared);
                               });
            out[i] = std::sqrt(best);
        },
        points_per_chunk);
    return out;
}

std::vector<char> find_crowded(const std::vector<Vec3>& points,
                               const std::vector<std::uint32_t>& rank, double distance,
                               const std::function<bool(std::size_t, std::size_t)>& may_stay,
                               int threads)
{
    const PointGrid grid = grid_of_all(points, distance);
    const double least = (1 - rounding) * distance;
    const auto is_too_near = [&](std::size_t i, std::size_t j, double squared)
    { return j != i && squared < least * least && !(may_stay && may_stay(i, j)); };
    std::vector<char> has_near(points.size(), 0);
    parallel_for(
        points.size(), threads,
        [&](std::size_t i)
        {
            grid.for_each_near(points[i], distance,
                               [&](std::uint32_t j, double squared)
                               {
                                   if (is_too_near(i, j, squared)) has_near[i] = 1;
                               });
        },
        points_per_chunk);
    std::vector<std::uint32_t> order;
    for (std::uint32_t i = 0; i < points.size(); ++i)
        if (has_near[i] != 0) order.push_back(i);
    const auto comes_before = [&](std::uint32_t a, std::uint32_t b)
    { return std::tuple(rank[a], a) < std::tuple(rank[b], b); };
    std::sort(order.begin(), order.end(), comes_before);
    std::vector<char> goes(points.size(), 0);
    for (const std::uint32_t i : order)
        grid.for_each_near(points[i], distance,
                           [&](std::uint32_t j, double squared)
                           {
                               if (goes[j] == 0 && is_too_near(i, j, squared) && comes_before(j, i))
                                   goes[i] = 1;
                           });
    return goes;
}

} // namespace fppg
