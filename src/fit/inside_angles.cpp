#include "fit/inside_angles.h"

#include <algorithm>
#include <array>
#include <limits>
#include <numbers>
#include <vector>

namespace fppg
{
namespace
{

constexpr double half_turn = std::numbers::pi;

bool has_two_facets(const SurfaceMesh& mesh, std::uint32_t e)
{
    return mesh.is_manifold[e] != 0 && mesh.edge_facets[e][1] != no_index;
}

/// In the plane of the particles, of unit length.
Vec3 in_plane(Vec3 normal)
{
    normal.y = 0;
    const double length = norm(normal);
    return length > 0 ? normal / length : normal;
}

/// Between the facets at an edge, through the inside, radians.
double angle_at_edge(const SurfaceMesh& mesh, std::uint32_t e, bool is_2d)
{
    if (!has_two_facets(mesh, e)) return half_turn;
    const auto [f, g] = mesh.edge_facets[e];
    const std::array<std::uint32_t, 3>& corners = mesh.facets[g];
    const auto& ends = mesh.edges[e];
    const std::uint32_t apex =
        *std::find_if(corners.begin(), corners.end(),
                      [&](std::uint32_t v) { return v != ends[0] && v != ends[1]; });
    const bool is_convex = dot(mesh.vertices[apex] - mesh.vertices[ends[0]], mesh.normals[f]) < 0;
    const double turn = is_2d ? angle_between(in_plane(mesh.normals[f]), in_plane(mesh.normals[g]))
                              : angle_between(mesh.normals[f], mesh.normals[g]);
    return half_turn + (is_convex ? -turn : turn);
}

/// Per vertex how much of a small ball around it is inside. The area of a polygon on a sphere is
/// the sum of its angles less (n - 2) pi.
std::vector<double> shares_at_vertices(const SurfaceMesh& mesh)
{
    std::vector<double> angles(mesh.vertices.size(), 2 * half_turn);
    std::vector<char> is_open(mesh.vertices.size(), 0);
    for (std::uint32_t e = 0; e < mesh.edges.size(); ++e)
        for (const std::uint32_t v : mesh.edges[e])
        {
            angles[v] += angle_at_edge(mesh, e, false) - half_turn;
            if (!has_two_facets(mesh, e)) is_open[v] = 1;
        }
    for (std::size_t v = 0; v < angles.size(); ++v)
        angles[v] = is_open[v] != 0 ? 0.5 : std::clamp(angles[v] / (4 * half_turn), 0.0, 1.0);
    return angles;
}

/// Between the facets at the edge that a place lies on, of a facet's sides or those of its
/// neighbours; of several that meet there the sharpest. In 2D of those that cross the plane.
double angle_at_place(const SurfaceMesh& mesh, std::uint32_t facet, const Vec3& p, bool is_2d)
{
    constexpr double same_place = 1e-6; // of the length of an edge
    double nearest = std::numeric_limits<double>::infinity();
    double angle = half_turn;
    const auto look_at = [&](std::uint32_t f)
    {
        for (const std::uint32_t e : mesh.facet_edges[f])
        {
            const Vec3& from = mesh.vertices[mesh.edges[e][0]];
            const Vec3 along = mesh.vertices[mesh.edges[e][1]] - from;
            if (is_2d && along.y == 0) continue;
            const double length = norm(along);
            const double t = std::clamp(dot(p - from, along) / (length * length), 0.0, 1.0);
            const double distance = norm(p - from - t * along);
            if (distance > nearest + same_place * length) continue;
            const double here = angle_at_edge(mesh, e, is_2d);
            if (distance < nearest - same_place * length ||
                std::abs(here - half_turn) > std::abs(angle - half_turn))
                angle = here;
            nearest = std::min(nearest, distance);
        }
    };
    look_at(facet);
    for (const std::uint32_t other : mesh.neighbours[facet])
        if (other != no_index) look_at(other);
    return angle;
}

std::uint32_t nearest_corner(const SurfaceMesh& mesh, std::uint32_t facet, const Vec3& p)
{
    return *std::min_element(mesh.facets[facet].begin(), mesh.facets[facet].end(),
                             [&](std::uint32_t a, std::uint32_t b)
                             { return norm(mesh.vertices[a] - p) < norm(mesh.vertices[b] - p); });
}

} // namespace

double mean_share_inside(const SurfaceMesh& mesh, const PlacedOnSurface& particles, bool is_2d)
{
    std::vector<double> at_vertices;
    double sum = 0;
    for (std::size_t i = 0; i < particles.kinds.size(); ++i)
    {
        const FitKind kind = particles.kinds[i];
        const Vec3& p = particles.positions[i];
        if (kind == FitKind::Surface)
            sum += 0.5;
        else if (kind == FitKind::Corner && !is_2d)
        {
            if (at_vertices.empty()) at_vertices = shares_at_vertices(mesh);
            sum += at_vertices[nearest_corner(mesh, particles.facets[i], p)];
        }
        else
            sum += angle_at_place(mesh, particles.facets[i], p, is_2d) / (2 * half_turn);
    }
    return particles.kinds.empty() ? 0.5 : sum / static_cast<double>(particles.kinds.size());
}

} // namespace fppg
