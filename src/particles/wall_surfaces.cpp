#include "particles/wall_surfaces.h"

#include "meshes/round_surface.h"

#include <cmath>

namespace fppg
{
namespace
{

double squared(const Vec3& v)
{
    return dot(v, v);
}

/// Squared distance from p to the segment a b.
double segment_distance(const Vec3& a, const Vec3& b, const Vec3& p)
{
    const Vec3 along = b - a;
    const double length = squared(along);
    const double t = length > 0 ? std::clamp(dot(p - a, along) / length, 0.0, 1.0) : 0;
    return squared(p - (a + t * along));
}

/// Both facets of the edge of `facet` nearest to p have the same angle there.
Vec3 mean_at_edge(const SurfaceMesh& mesh, std::uint32_t facet, const Vec3& p)
{
    const auto& corners = mesh.facets[facet];
    std::size_t nearest = 0;
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t side = 0; side < 3; ++side)
    {
        const double d = segment_distance(mesh.vertices[corners[side]],
                                          mesh.vertices[corners[(side + 1) % 3]], p);
        if (d >= least) continue;
        least = d;
        nearest = side;
    }
    Vec3 sum;
    for (const std::uint32_t f : mesh.edge_facets[mesh.facet_edges[facet][nearest]])
        if (f != no_index) sum = sum + mesh.normals[f];
    return sum;
}

/// The angle of the facet at its corner v.
double angle_at(const SurfaceMesh& mesh, std::uint32_t facet, std::uint32_t v)
{
    const auto& corners = mesh.facets[facet];
    const std::size_t at = corners[0] == v ? 0 : corners[1] == v ? 1 : 2;
    const Vec3& origin = mesh.vertices[corners[at]];
    const Vec3 a = mesh.vertices[corners[(at + 1) % 3]] - origin;
    const Vec3 b = mesh.vertices[corners[(at + 2) % 3]] - origin;
    return std::atan2(norm(cross(a, b)), dot(a, b));
}

std::array<float, 3> as_floats(const Vec3& v)
{
    return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)};
}

} // namespace

WallSurfaces::WallSurfaces(const FittedWalls& walls) : walls_(walls), around_(walls.bodies.size())
{
    std::vector<char> has_corners(walls.bodies.size(), 0);
    for (std::size_t i = 0; i < walls.particles.size(); ++i)
        if (walls.particles.kinds[i] == FitKind::Corner) has_corners[walls.particles.bodies[i]] = 1;
    for (std::size_t b = 0; b < walls.bodies.size(); ++b)
    {
        if (!has_corners[b]) continue;
        const SurfaceMesh& mesh = walls.bodies[b].mesh;
        VertexFacets& around = around_[b];
        around.begin.assign(mesh.vertices.size() + 2, 0);
        for (const auto& facet : mesh.facets)
            for (const std::uint32_t v : facet) ++around.begin[v + 2];
        for (std::size_t v = 2; v < around.begin.size(); ++v)
            around.begin[v] += around.begin[v - 1];
        around.facets.resize(3 * mesh.facets.size());
        for (std::uint32_t f = 0; f < mesh.facets.size(); ++f)
            for (const std::uint32_t v : mesh.facets[f]) around.facets[around.begin[v + 1]++] = f;
    }
}

Vec3 WallSurfaces::mean_at_corner(std::size_t body, std::uint32_t facet, const Vec3& p) const
{
    const SurfaceMesh& mesh = walls_.bodies[body].mesh;
    std::uint32_t nearest = mesh.facets[facet][0];
    for (const std::uint32_t v : mesh.facets[facet])
        if (squared(mesh.vertices[v] - p) < squared(mesh.vertices[nearest] - p)) nearest = v;
    const VertexFacets& around = around_[body];
    Vec3 sum;
    for (std::uint64_t i = around.begin[nearest]; i < around.begin[nearest + 1]; ++i)
    {
        const std::uint32_t f = around.facets[i];
        sum = sum + angle_at(mesh, f, nearest) * mesh.normals[f];
    }
    return sum;
}

SurfacePlace WallSurfaces::at(std::size_t particle) const
{
    const WallParticles& particles = walls_.particles;
    const std::size_t b = particles.bodies[particle];
    const std::uint32_t facet = particles.facets[particle];
    const Vec3& p = particles.positions[particle];
    Vec3 normal = exact_normal(walls_.bodies[b], p, facet);
    const FitKind kind = particles.kinds[particle];
    if (kind == FitKind::Corner || kind == FitKind::Edge)
    {
        const Vec3 mean = kind == FitKind::Corner ? mean_at_corner(b, facet, p)
                                                  : mean_at_edge(walls_.bodies[b].mesh, facet, p);
        // Below this length the direction is that of rounding errors.
        if (norm(mean) > 1e-6) normal = mean / norm(mean);
    }
    return {as_floats(normal), static_cast<float>(exact_distance(walls_.bodies[b], p, facet))};
}

} // namespace fppg
