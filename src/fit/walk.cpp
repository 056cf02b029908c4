#include "fit/walk.h"

namespace fppg
{

namespace
{

/// Facets crossed before a walk is given up: no straight line over facets that are not tiny
/// against its length needs as many; one that circles a vertex does.
constexpr int max_crossings = 2000;

} // namespace

FacetExit find_exit(const WorkFacet& facet, const SurfaceRay& ray, std::size_t entered,
                    double length)
{
    FacetExit exit{3, length};
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

std::size_t cross_side(const WorkMesh& mesh, SurfaceRay& ray, std::size_t side)
{
    const WorkFacet& facet = mesh.facets[ray.facet];
    const std::uint32_t next = facet.neighbours[side];
    const WorkFacet& other = mesh.facets[next];
    const std::size_t end = side == 2 ? 0 : side + 1;
    const Vec3 edge = facet.corners[end] - facet.corners[side];
    const Vec3 along = edge / norm(edge);
    const double a = dot(ray.direction, along);
    const double b = dot(ray.direction, cross(along, facet.normal));
    ray.direction = along * a + cross(along, other.normal) * b;
    std::size_t entered = other.neighbours[0] == ray.facet   ? 0
                          : other.neighbours[1] == ray.facet ? 1
                                                             : 2;
    // Two facets can share two edges; its vertices say which one was crossed.
    if (other.vertices[entered] != facet.vertices[end])
        for (std::size_t s = 0; s < 3; ++s)
            if (other.neighbours[s] == ray.facet && other.vertices[s] == facet.vertices[end])
                entered = s;
    ray.facet = next;
    return entered;
}

SurfaceRay walk(const WorkMesh& mesh, SurfaceRay ray, double length)
{
    std::size_t entered = 3;
    for (int crossing = 0; crossing < max_crossings; ++crossing)
    {
        const WorkFacet& facet = mesh.facets[ray.facet];
        if (!facet.has_plane) break;
        const FacetExit exit = find_exit(facet, ray, entered, length);
        ray.position = ray.position + ray.direction * exit.length;
        if (exit.side == 3)
        {
            ray.position = onto_plane(facet, ray.position);
            return ray;
        }
        if (facet.neighbours[exit.side] == no_index) break;
        length -= exit.length;
        entered = cross_side(mesh, ray, exit.side);
    }
    ray.facet = no_index;
    return ray;
}

} // namespace fppg
