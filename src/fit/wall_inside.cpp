#include "fit/wall_inside.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <unordered_map>

namespace fppg
{
namespace
{

double squared(const Vec3& v)
{
    return dot(v, v);
}

/// The side of a facet that is nearest to a point.
std::size_t nearest_side(const SurfaceMesh& mesh, std::uint32_t facet, const Vec3& p)
{
    const auto& corners = mesh.facets[facet];
    std::size_t nearest = 0;
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t s = 0; s < 3; ++s)
    {
        const Vec3& a = mesh.vertices[corners[s]];
        const Vec3 along = mesh.vertices[corners[(s + 1) % 3]] - a;
        const double length = squared(along);
        const double t = length > 0 ? std::clamp(dot(p - a, along) / length, 0.0, 1.0) : 0;
        const double d = squared(p - (a + t * along));
        if (d >= least) continue;
        least = d;
        nearest = s;
    }
    return nearest;
}

/// How much less than half of the space around an edge is inside: its bend over a whole turn.
double edge_share(const SurfaceMesh& mesh, std::uint32_t edge)
{
    const auto [f, g] = mesh.edge_facets[edge];
    if (g == no_index || mesh.is_manifold[edge] == 0) return 0;
    const Vec3 &n = mesh.normals[f], &m = mesh.normals[g];
    const double bend = std::atan2(norm(cross(n, m)), dot(n, m)) / (2 * std::numbers::pi);
    const auto& ends = mesh.edges[edge];
    const auto& corners = mesh.facets[g];
    const auto* other = std::find_if(corners.begin(), corners.end(),
                                     [&](std::uint32_t v) { return v != ends[0] && v != ends[1]; });
    if (other == corners.end()) return 0;
    return dot(mesh.vertices[*other] - mesh.vertices[ends[0]], n) > 0 ? -bend : bend;
}

double corner_share(double mean_of_edges)
{
    const double inside = 0.5 - mean_of_edges;
    return 0.5 - (inside < 0.5 ? 2 * inside * inside : 1 - 2 * (1 - inside) * (1 - inside));
}

} // namespace

double less_than_half(const SurfaceMesh& mesh, const Features& features,
                      const SurfaceParticles& particles, bool is_2d)
{
    double sum = 0;
    struct Edges
    {
        double sum = 0;
        int count = 0;
    };
    std::unordered_map<std::uint32_t, Edges> at_vertex;
    std::vector<std::uint32_t> vertices; // of the corner particles
    for (std::size_t i = 0; i < particles.positions.size(); ++i)
    {
        const FitKind kind = particles.kinds[i];
        if (kind != FitKind::Corner && kind != FitKind::Edge) continue;
        const std::uint32_t facet = particles.facets[i];
        const Vec3& p = particles.positions[i];
        if (kind == FitKind::Edge || is_2d)
        {
            sum += edge_share(mesh, mesh.facet_edges[facet][nearest_side(mesh, facet, p)]);
            continue;
        }
        const auto& corners = mesh.facets[facet];
        vertices.push_back(*std::min_element(
            corners.begin(), corners.end(),
            [&](std::uint32_t a, std::uint32_t b)
            { return squared(mesh.vertices[a] - p) < squared(mesh.vertices[b] - p); }));
        at_vertex.try_emplace(vertices.back());
    }
    if (vertices.empty()) return sum;
    for (const std::uint32_t e : features.edges)
        for (const std::uint32_t v : mesh.edges[e])
        {
            const auto found = at_vertex.find(v);
            if (found == at_vertex.end()) continue;
            found->second.sum += edge_share(mesh, e);
            ++found->second.count;
        }
    for (const std::uint32_t v : vertices)
    {
        const Edges& edges = at_vertex[v];
        if (edges.count > 0) sum += corner_share(edges.sum / edges.count);
    }
    return sum;
}

} // namespace fppg
