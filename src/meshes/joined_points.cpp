#include "meshes/joined_points.h"

#include "meshes/point_grid.h"

#include <cstdint>

namespace fppg
{

// Each point is of the cluster of one within half the reach, so that most pairs need not be looked
// at.
DisjointSet joined_within(const std::vector<Vec3>& points, double reach)
{
    DisjointSet sets(points.size());
    PointGrid middles(reach / 2, points.size() / 4);
    std::vector<std::vector<std::uint32_t>> clusters;
    for (std::uint32_t i = 0; i < points.size(); ++i)
    {
        const auto near = middles.nearest(points[i], reach / 2);
        if (near)
            sets.join(i, clusters[*near].front());
        else
        {
            middles.add(points[i]);
            clusters.emplace_back();
        }
        clusters[near.value_or(static_cast<std::uint32_t>(clusters.size() - 1))].push_back(i);
    }
    const auto are_near = [&](std::uint32_t a, std::uint32_t b)
    {
        for (const std::uint32_t i : clusters[a])
            for (const std::uint32_t j : clusters[b])
            {
                const Vec3 way = points[i] - points[j];
                if (dot(way, way) <= reach * reach) return true;
            }
        return false;
    };
    PointGrid wide(2 * reach, clusters.size());
    for (const Vec3& p : middles.points()) wide.add(p);
    for (std::uint32_t a = 0; a < clusters.size(); ++a)
        wide.for_each_near(middles.points()[a], 2 * reach * (1 + 1e-9),
                           [&](std::uint32_t b, double)
                           {
                               const std::uint32_t i = clusters[a].front();
                               const std::uint32_t j = clusters[b].front();
                               if (b < a && sets.find(i) != sets.find(j) && are_near(a, b))
                                   sets.join(i, j);
                           });
    return sets;
}

} // namespace fppg
