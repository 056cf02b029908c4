#include "meshes/facing_distance.h"
#include "core/even_places.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace fppg
{

std::vector<FacetSpot> even_places(const SurfaceMesh& mesh, std::size_t count)
{
    std::vector<double> up_to(mesh.facets.size());
    double area = 0;
    for (std::size_t f = 0; f < mesh.facets.size(); ++f) up_to[f] = area += mesh.areas[f];
    std::vector<FacetSpot> out(count);
    for (std::size_t i = 0; i < count; ++i)
    {
        const double share = (static_cast<double>(i) + 0.5) / static_cast<double>(count);
        const auto at = std::upper_bound(up_to.begin(), up_to.end() - 1, share * area);
        const auto f = static_cast<std::uint32_t>(at - up_to.begin());
        const auto& [a, b, c] = mesh.facets[f];
        out[i] = {f, even_on_facet({mesh.vertices[a], mesh.vertices[b], mesh.vertices[c]},
                                   static_cast<double>(i))};
    }
    return out;
}

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
