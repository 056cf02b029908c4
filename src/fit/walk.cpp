#include "fit/walk.h"

namespace fppg
{

namespace
{

/// Facets crossed before a walk is given up: no straight line over facets that are not tiny
/// against its length needs as many; one that circles a vertex does.
constexpr int max_crossings = 2000;

struct Exit
{
    std::size_t side = 3; ///< 3: the line ends within the facet
    double length = 0;
};

Exit find_exit(const WorkFacet& facet, const SurfaceRay& ray, std::size_t entered, double length)
{
    Exit exit{3, length};
    for (std::size_t s = 0; s < 3; ++s)
    {
        if (s == entered) continue;
        const Vec3& from = facet.corners[s];
        const Vec3 inward = cross(facet.normal, facet.corners[s == 2 ? 0 : s + 1] - from);
        const double rate = dot(ray.direction, inward);
        if (!(rate < 0)) continue;
        const double reach = std::max(0.0, dot(ray.position - from, inward) / -rate);
        if (reach < exit.length) exit = {s, reach};
    }
    return exit;
}

} // namespace

SurfaceRay walk(const WorkMesh& mesh, SurfaceRay ray, double length)
{
    std::size_t entered = 3;
    for (int crossing = 0; crossing < max_crossings; ++crossing)
    {
        const WorkFacet& facet = mesh.facets[ray.facet];
        const Exit exit = find_exit(facet, ray, entered, length);
        ray.position = ray.position + ray.direction * exit.length;
        if (exit.side == 3)
        {
            // Rounding of earlier crossings is taken back: the point lies in this facet's plane.
            ray.position =
                ray.position - facet.normal * dot(ray.position - facet.corners[0], facet.normal);
            return ray;
        }
        const std::uint32_t next = facet.neighbours[exit.side];
        if (next == no_index) break;
        length -= exit.length;
        const WorkFacet& other = mesh.facets[next];
        const Vec3 side =
            facet.corners[exit.side == 2 ? 0 : exit.side + 1] - facet.corners[exit.side];
        const Vec3 along = side / norm(side);
        const double a = dot(ray.direction, along);
        const double b = dot(ray.direction, cross(along, facet.normal));
        ray.direction = along * a + cross(along, other.normal) * b;
        entered = other.neighbours[0] == ray.facet ? 0 : other.neighbours[1] == ray.facet ? 1 : 2;
        // Two facets can share two edges; the one walked over is told by its vertices.
        if (other.vertices[entered] != facet.vertices[exit.side == 2 ? 0 : exit.side + 1])
            for (std::size_t s = 0; s < 3; ++s)
                if (other.neighbours[s] == ray.facet &&
                    other.vertices[s] == facet.vertices[exit.side == 2 ? 0 : exit.side + 1])
                    entered = s;
        ray.facet = next;
    }
    ray.facet = no_index;
    return ray;
}

} // namespace fppg
