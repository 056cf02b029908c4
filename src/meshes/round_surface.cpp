#include "meshes/round_surface.h"

#include "meshes/cad_surface.h"

#include <cmath>

namespace fppg
{
namespace
{

bool is_cover(const FittedBody& body, std::uint32_t facet)
{
    return std::fabs(dot(body.mesh.normals[facet], body.round->cover_normal)) > 0.5;
}

/// Whether a point lies on a side of its facet in which a cover or the tube ends.
bool is_on_rim(const FittedBody& body, const Vec3& position, std::uint32_t facet)
{
    const SurfaceMesh& mesh = body.mesh;
    for (std::size_t side = 0; side < 3; ++side)
    {
        const std::uint32_t beyond = mesh.neighbours[facet][side];
        if (beyond != no_index && is_cover(body, beyond) == is_cover(body, facet)) continue;
        const Vec3& a = mesh.vertices[mesh.facets[facet][side]];
        const Vec3& b = mesh.vertices[mesh.facets[facet][(side + 1) % 3]];
        const double distance = norm(cross(b - a, position - a)) / norm(b - a);
        if (distance <= 1e-9 * body.round->size) return true;
    }
    return false;
}

} // namespace

Vec3 unit(const Vec3& p)
{
    const double length = norm(p);
    return length > 0 ? p / length : Vec3{};
}

void project_to_exact(const FittedBody& body, Vec3& position, std::uint32_t facet, bool is_2d)
{
    if (body.cad != nullptr) body.cad->project(body.mesh, position, facet, is_2d);
    if (body.round == nullptr) return;
    const RoundSurface& surface = *body.round;
    const bool has_covers = !(surface.cover_normal == Vec3{});
    const bool on_rim = has_covers && is_on_rim(body, position, facet);
    if (is_cover(body, facet) && !on_rim) return;
    // In two dimensions a particle on a rim can move along one line only: in the plane and in that
    // of the cover.
    const Vec3 line = is_2d && on_rim ? unit(cross(surface.cover_normal, Vec3{0, 1, 0})) : Vec3{};
    // Newton's method: the start is nearer than the radius by orders of magnitude, so that a few
    // steps reach rounding.
    const double enough = 1e-15 * surface.size;
    for (int step = 0; step < 8; ++step)
    {
        const Level level = surface.level_at(position);
        Vec3 way = level.gradient;
        if (is_2d) way.y = 0;
        if (!(line == Vec3{})) way = line * dot(line, level.gradient);
        const double rate = dot(way, level.gradient);
        // In a plane that only touches the surface there is no way towards it.
        if (std::fabs(level.value) <= enough || !(rate > 1e-6)) return;
        position = position - way * (level.value / rate);
    }
}

Vec3 exact_normal(const FittedBody& body, const Vec3& position, std::uint32_t facet)
{
    const Vec3& flat = body.mesh.normals[facet];
    if (body.cad != nullptr)
        if (const auto foot = body.cad->foot(body.mesh, position, facet)) return foot->normal;
    if (body.round == nullptr || is_cover(body, facet)) return flat;
    const Vec3 normal = unit(body.round->level_at(position).gradient);
    return dot(normal, flat) < 0 ? -normal : normal;
}

double exact_distance(const FittedBody& body, const Vec3& position, std::uint32_t facet)
{
    if (body.cad != nullptr)
        if (const auto foot = body.cad->foot(body.mesh, position, facet))
            return dot(position - foot->point, foot->normal);
    if (body.round == nullptr || is_cover(body, facet))
        return dot(position - body.mesh.vertices[body.mesh.facets[facet][0]],
                   body.mesh.normals[facet]);
    const Level level = body.round->level_at(position);
    const double growth = norm(level.gradient);
    const double distance = growth > 0 ? level.value / growth : level.value;
    // A surface that is drawn to look inwards has its inside elsewhere.
    return dot(level.gradient, body.mesh.normals[facet]) < 0 ? -distance : distance;
}

} // namespace fppg
