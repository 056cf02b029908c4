#include "meshes/facing_distance.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace fppg
{

double facing_distance(const std::vector<Vec3>& normals, const MeshQuery& query,
                       const FacetSpot& from, FacetSide side, double reach)
{
    const Vec3& n = normals[from.facet];
    const Vec3& p = from.place;
    int axis = 0;
    for (const int other : {1, 2})
        if (std::abs(n[other]) > std::abs(n[axis])) axis = other;
    const double slant = std::abs(n[axis]);
    const bool is_upwards = (n[axis] < 0) == (side == FacetSide::Behind);
    Vec3 origin = p;
    if (!is_upwards) origin[axis] -= reach / slant;
    double nearest = std::numeric_limits<double>::infinity();
    for (const Crossing& crossing : query.crossings(origin, axis))
    {
        if (!is_upwards && crossing.position > p[axis]) break;
        if (crossing.facet == from.facet || dot(normals[crossing.facet], n) > -0.5) continue;
        const double distance = std::abs(crossing.position - p[axis]) * slant;
        nearest = std::min(nearest, distance);
    }
    return nearest <= reach ? nearest : std::numeric_limits<double>::infinity();
}

} // namespace fppg
