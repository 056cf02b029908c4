#include "offset/offset_surface.h"

#include "offset/quadric.h"

#include <algorithm>
#include <cmath>

namespace fppg
{
namespace
{

/// On the faces beside a crease, dp.
constexpr double beside_crease = 0.03;

} // namespace

Vec3 project_to_depth(const WallDepth& wall, const Vec3& p, double depth)
{
    Vec3 at = p;
    for (int step = 0; step < 16; ++step)
    {
        const DepthPlace place = wall.at(at);
        const double off = depth - place.depth;
        if (std::fabs(off) < 1e-12 * depth) break;
        at = place.depth > 0 ? place.foot + depth * place.direction : at + off * place.direction;
    }
    return at;
}

Vec3 project_to_crease(const WallDepth& wall, const Vec3& p, double depth, double dp,
                       const std::vector<Vec3>& towards)
{
    Vec3 at = p;
    for (int step = 0; step < 6; ++step)
    {
        Quadric quadric;
        for (const Vec3& t : towards)
        {
            const Vec3 way = t - at;
            const double size = norm(way);
            if (!(size > 0)) continue;
            // At first on the faces themselves: the start may be beside the crease.
            const double share = step == 0 ? 1 : std::min(beside_crease * dp, size) / size;
            const Vec3 beside = at + share * way;
            const DepthPlace place = wall.at(beside);
            const double depth_at = place.depth + dot(place.direction, at - beside);
            quadric.add_plane(place.direction, depth - depth_at);
        }
        const Vec3 move = quadric.least_point();
        if (!(norm(move) < 0.5 * dp)) return project_to_depth(wall, p, depth);
        at = at + move;
        if (norm(move) < 1e-9 * dp) break;
    }
    return norm(at - p) < 0.5 * dp ? project_to_depth(wall, at, depth)
                                   : project_to_depth(wall, p, depth);
}

} // namespace fppg
