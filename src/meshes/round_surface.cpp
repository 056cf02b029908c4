#include "meshes/round_surface.h"

#include <cmath>

namespace fppg
{
namespace
{

/// A point's level and the way in which it grows: zero on the round surface, positive outside.
struct Level
{
    double value = 0; ///< metres
    Vec3 gradient;
};

Vec3 unit(const Vec3& p)
{
    const double length = norm(p);
    return length > 0 ? p / length : Vec3{};
}

Vec3 axis_of(const FittedBody& body)
{
    return unit(body.p1 - body.p0);
}

Level level_at(const FittedBody& body, const Vec3& p)
{
    switch (body.round)
    {
        case RoundShape::Sphere:
            return {norm(p - body.p0) - body.radius, unit(p - body.p0)};
        case RoundShape::Cylinder:
        {
            const Vec3 u = axis_of(body);
            const Vec3 out = p - body.p0 - u * dot(p - body.p0, u);
            return {norm(out) - body.radius, unit(out)};
        }
        case RoundShape::Ellipsoid:
            return {norm(p - body.p0) + norm(p - body.p1) - body.radius,
                    unit(p - body.p0) + unit(p - body.p1)};
        case RoundShape::None:
            break;
    }
    return {};
}

bool is_cover(const FittedBody& body, std::uint32_t facet)
{
    return body.round == RoundShape::Cylinder &&
           std::fabs(dot(body.mesh.normals[facet], axis_of(body))) > 0.5;
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
        if (distance <= 1e-9 * body.radius) return true;
    }
    return false;
}

} // namespace

void project_to_round(const FittedBody& body, Vec3& position, std::uint32_t facet, bool is_2d)
{
    if (body.round == RoundShape::None) return;
    const bool is_cylinder = body.round == RoundShape::Cylinder;
    const bool on_rim = is_cylinder && is_on_rim(body, position, facet);
    if (is_cover(body, facet) && !on_rim) return;
    // In two dimensions a particle on a rim can move along one line only: in the plane and in that
    // of the cover.
    const Vec3 line = is_2d && on_rim ? unit(cross(axis_of(body), Vec3{0, 1, 0})) : Vec3{};
    // Newton's method: the start is nearer than the radius by orders of magnitude, so that a few
    // steps reach rounding.
    const double enough = 1e-15 * body.radius;
    for (int step = 0; step < 8; ++step)
    {
        const Level level = level_at(body, position);
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
    if (body.round == RoundShape::None || is_cover(body, facet)) return flat;
    const Vec3 normal = unit(level_at(body, position).gradient);
    return dot(normal, flat) < 0 ? -normal : normal;
}

double exact_distance(const FittedBody& body, const Vec3& position, std::uint32_t facet)
{
    if (body.round == RoundShape::None || is_cover(body, facet))
        return dot(position - body.mesh.vertices[body.mesh.facets[facet][0]],
                   body.mesh.normals[facet]);
    const Level level = level_at(body, position);
    const double growth = norm(level.gradient);
    const double distance = growth > 0 ? level.value / growth : level.value;
    // A surface that is drawn to look inwards has its inside elsewhere.
    return dot(level.gradient, body.mesh.normals[facet]) < 0 ? -distance : distance;
}

} // namespace fppg
