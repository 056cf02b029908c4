#include "relax/slide.h"

#include "fit/walk.h"

namespace fppg
{

namespace
{

constexpr int max_crossings = 64;
/// Borders met before the rest of a step is dropped: in a narrowing corner they are met for ever.
constexpr int max_borders = 4;

/// The coordinate of a point that belongs to the corner across side s: 1 there, 0 on the side.
double barycentric(const WorkFacet& facet, std::size_t s, const Vec3& point)
{
    const Vec3& from = facet.corners[s];
    const Vec3 inward = cross(facet.normal, facet.corners[(s + 1) % 3] - from);
    return dot(point - from, inward) / dot(facet.corners[(s + 2) % 3] - from, inward);
}

} // namespace

bool slide(const WorkMesh& mesh, SlidePlace& place, const Vec3& step, double inside)
{
    double left = norm(step);
    if (!(left > 0)) return true;
    SurfaceRay ray{place.position, place.facet, step / left};
    std::size_t entered = 3;
    int borders = 0;
    for (int crossing = 0; crossing < max_crossings; ++crossing)
    {
        const WorkFacet& facet = mesh.facets[ray.facet];
        if (!facet.has_plane) return false;
        const FacetExit exit = find_exit(facet, ray, entered, left);
        ray.position = ray.position + ray.direction * exit.length;
        left -= exit.length;
        if (exit.side != 3 && facet.neighbours[exit.side] != no_index)
        {
            entered = cross_side(mesh, ray, exit.side);
            continue;
        }
        if (exit.side != 3)
        {
            const Vec3 edge =
                facet.corners[exit.side == 2 ? 0 : exit.side + 1] - facet.corners[exit.side];
            const Vec3 along = edge / norm(edge);
            ray.position = ray.position + cross(facet.normal, along) * inside;
            const double share = dot(ray.direction, along);
            ray.direction = along * std::copysign(1.0, share);
            left *= std::abs(share);
            entered = 3;
            if (++borders < max_borders && left > inside) continue;
        }
        place = {onto_plane(facet, ray.position), ray.facet};
        return true;
    }
    return false;
}

SlidePlace place_on_facet(const WorkMesh& mesh, std::uint32_t parent, const Vec3& point)
{
    const std::uint32_t piece = mesh.locate(parent, point);
    const WorkFacet& facet = mesh.facets[piece];
    std::array<double, 3> share;
    double sum = 0;
    for (std::size_t s = 0; s < 3; ++s)
    {
        share[s] = std::max(0.0, barycentric(facet, s, point));
        sum += share[s];
    }
    // A facet without area has no coordinates within: they are infinite or, as 0 / 0 is left out
    // above, nothing.
    if (!std::isfinite(sum) || !(sum > 0.5)) return {facet.corners[0], piece};
    if (std::abs(sum - 1) < 1e-9) return {onto_plane(facet, point), piece};
    return {
        (facet.corners[2] * share[0] + facet.corners[0] * share[1] + facet.corners[1] * share[2]) /
            sum,
        piece};
}

} // namespace fppg
