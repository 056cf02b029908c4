#include "relax/wall_planes.h"

#include <algorithm>
#include <limits>

namespace fppg
{

namespace
{

/// Normals of one smooth wall seen from places a few dp apart differ less than this cosine says.
constexpr double same_wall = 0.8;

bool is_known(const WallPlanes& found, const Vec3& normal)
{
    return std::any_of(found.begin(), found.end(),
                       [&](const WallPlane& plane)
                       { return dot(plane.normal, normal) > same_wall; });
}

/// A place farther off the wall at `nearest`, at most `reach` from it. The step is shorter than the
/// distance, so that it passes through no other wall.
Vec3 farther_off(const Vec3& from, const Vec3& nearest, double reach)
{
    const double distance = norm(nearest - from);
    return from + (from - nearest) * (std::min(0.95 * distance, reach - distance) / distance);
}

} // namespace

WallPlanes find_nearest_wall(const Vec3& point, double reach, const ClosestWallPoint& closest,
                             double within)
{
    WallPlanes found;
    found.distance = std::numeric_limits<double>::infinity();
    if (!closest) return found;
    found.nearest = closest(point, within);
    found.distance = norm(found.nearest - point);
    if (found.distance > 0 && found.distance < reach)
        found.planes[static_cast<std::size_t>(found.count++)] = {
            (found.nearest - point) / found.distance, found.distance};
    return found;
}

void add_further_walls(WallPlanes& found, const Vec3& point, double reach,
                       const ClosestWallPoint& closest)
{
    // Two steps lead from half a dp to the reach; walls that meet there make three needed.
    Vec3 from = point;
    Vec3 nearest = found.nearest;
    for (int probe = 0; probe < 5 && found.count > 0 && found.count < 3; ++probe)
    {
        from = farther_off(from, nearest, reach);
        nearest = closest(from, norm(nearest - from));
        const double distance = norm(nearest - from);
        if (!(distance > 0) || distance >= reach * (1 - 1e-6)) return;
        const Vec3 normal = (nearest - from) / distance;
        if (is_known(found, normal)) continue;
        const double in_front = dot(nearest - point, normal);
        if (in_front < reach)
            found.planes[static_cast<std::size_t>(found.count++)] = {normal, in_front};
    }
}

WallPlanes find_wall_planes(const Vec3& point, double reach, const ClosestWallPoint& closest)
{
    WallPlanes found = find_nearest_wall(point, reach, closest);
    add_further_walls(found, point, reach, closest);
    return found;
}

bool is_way_free(const Vec3& from, const Vec3& to, double limit, const ClosestWallPoint& closest)
{
    if (!closest) return true;
    const double length = norm(to - from);
    double within = std::numeric_limits<double>::infinity();
    for (double way = 0;;)
    {
        const Vec3 at = length > 0 ? from + (way / length) * (to - from) : from;
        const Vec3 nearest = closest(at, within);
        const double distance = norm(nearest - at);
        if (distance < limit) return false;
        if (way >= length) return true;
        const double step = std::min(length - way, 0.9 * distance);
        way += step;
        within = (distance + step) * (1 + 1e-9);
    }
}

} // namespace fppg
