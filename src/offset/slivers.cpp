#include "offset/slivers.h"

#include "meshes/connect_mesh.h"
#include "meshes/edge_map.h"

#include <algorithm>
#include <array>
#include <iterator>
#include <numeric>
#include <span>
#include <utility>
#include <vector>

namespace fppg
{
namespace
{

constexpr double one_vertex = 0.2; ///< cells
constexpr double low_facet = 0.1;  ///< cells
constexpr int rounds = 3;

using Corners = std::array<std::uint32_t, 3>;

Corners sorted(Corners c)
{
    std::sort(c.begin(), c.end());
    return c;
}

/// Facets that lost a side go, and pairs that came to lie on one another; these have a vertex that
/// others were joined with.
void drop_flat(SurfaceMesh& mesh, const std::vector<char>& is_joined)
{
    std::vector<Corners>& facets = mesh.facets;
    const auto is_flat = [](const Corners& f)
    { return f[0] == f[1] || f[1] == f[2] || f[2] == f[0]; };
    facets.erase(std::remove_if(facets.begin(), facets.end(), is_flat), facets.end());
    std::vector<std::pair<Corners, std::size_t>> changed;
    for (std::size_t f = 0; f < facets.size(); ++f)
        if (std::any_of(facets[f].begin(), facets[f].end(),
                        [&](std::uint32_t v) { return is_joined[v] != 0; }))
            changed.emplace_back(sorted(facets[f]), f);
    std::sort(changed.begin(), changed.end());
    std::vector<char> is_out(facets.size(), 0);
    bool has_pairs = false;
    for (std::size_t i = 1; i < changed.size(); ++i)
    {
        char& is_one_out = is_out[changed[i - 1].second];
        if (is_one_out != 0 || changed[i].first != changed[i - 1].first) continue;
        is_one_out = 1;
        is_out[changed[i].second] = 1;
        has_pairs = true;
    }
    if (!has_pairs) return;
    std::size_t kept = 0;
    for (std::size_t f = 0; f < facets.size(); ++f)
        if (is_out[f] == 0) facets[kept++] = facets[f];
    facets.resize(kept);
}

/// The vertices at the other ends of the edges of each vertex, ascending.
class VertexNeighbours
{
public:
    explicit VertexNeighbours(const SurfaceMesh& mesh) : first_(mesh.vertices.size() + 1, 0)
    {
        for (const auto& edge : mesh.edges)
            for (const std::uint32_t v : edge) ++first_[v + 1];
        std::partial_sum(first_.begin(), first_.end(), first_.begin());
        std::vector<std::size_t> next(first_.begin(), first_.end() - 1);
        vertices_.resize(first_.back());
        // Edges are sorted, so that a vertex meets the smaller ones first.
        for (const auto& [a, b] : mesh.edges)
        {
            vertices_[next[a]++] = b;
            vertices_[next[b]++] = a;
        }
    }

    std::span<const std::uint32_t> of(std::uint32_t v) const
    {
        return {vertices_.data() + first_[v], vertices_.data() + first_[v + 1]};
    }

private:
    std::vector<std::size_t> first_;
    std::vector<std::uint32_t> vertices_;
};

/// Joins the ends of short edges, each vertex with one other at most and none of its neighbours
/// with any; returns whether any was. Ends that have more neighbours in common than the facets of
/// their edge say would pinch the surface.
bool join_near_vertices(SurfaceMesh& mesh, double cell, const std::vector<char>& on_creases)
{
    const VertexNeighbours around(mesh);
    std::vector<std::uint32_t> of(mesh.vertices.size());
    std::iota(of.begin(), of.end(), 0u);
    std::vector<char> is_used(of.size(), 0);
    std::vector<char> is_joined(of.size(), 0);
    bool found = false;
    for (const auto& edge : mesh.edges)
    {
        if (is_used[edge[0]] != 0 || is_used[edge[1]] != 0) continue;
        if (!(norm(mesh.vertices[edge[0]] - mesh.vertices[edge[1]]) < one_vertex * cell)) continue;
        std::vector<std::uint32_t> common;
        std::ranges::set_intersection(around.of(edge[0]), around.of(edge[1]),
                                      std::back_inserter(common));
        if (common.size() > 2) continue;
        for (const std::uint32_t end : edge)
        {
            is_used[end] = 1;
            for (const std::uint32_t v : around.of(end)) is_used[v] = 1;
        }
        // The vertex on a crease stays.
        const std::size_t kept = on_creases[edge[1]] > on_creases[edge[0]] ? 1 : 0;
        of[edge[1 - kept]] = edge[kept];
        is_joined[edge[kept]] = 1;
        found = true;
    }
    if (!found) return false;
    for (Corners& f : mesh.facets)
        for (std::uint32_t& v : f) v = of[v];
    drop_flat(mesh, is_joined);
    return true;
}

double height(const SurfaceMesh& mesh, const Corners& f)
{
    const Vec3& a = mesh.vertices[f[0]];
    const Vec3& b = mesh.vertices[f[1]];
    const Vec3& c = mesh.vertices[f[2]];
    const double longest = std::max({norm(b - a), norm(c - b), norm(a - c)});
    return longest > 0 ? norm(cross(b - a, c - a)) / longest : 0;
}

/// Turns the longest sides of low facets where that makes the lower of both facets higher.
bool turn_sides(SurfaceMesh& mesh, double cell)
{
    std::vector<char> is_used(mesh.facets.size(), 0);
    bool found = false;
    for (std::uint32_t f = 0; f < mesh.facets.size(); ++f)
    {
        const double low = height(mesh, mesh.facets[f]);
        if (is_used[f] != 0 || !(low < low_facet * cell)) continue;
        std::size_t side = 0;
        double longest = 0;
        for (std::size_t s = 0; s < 3; ++s)
        {
            const double l =
                norm(mesh.vertices[mesh.facets[f][(s + 1) % 3]] - mesh.vertices[mesh.facets[f][s]]);
            if (l <= longest) continue;
            longest = l;
            side = s;
        }
        const std::uint32_t g = mesh.neighbours[f][side];
        if (g == no_index || is_used[g] != 0) continue;
        const std::uint32_t a = mesh.facets[f][side];
        const std::uint32_t b = mesh.facets[f][(side + 1) % 3];
        const std::uint32_t c = mesh.facets[f][(side + 2) % 3];
        std::uint32_t d = no_index;
        for (const std::uint32_t v : mesh.facets[g])
            if (v != a && v != b) d = v;
        if (d == no_index || d == c) continue;
        const Corners one{c, a, d};
        const Corners two{c, d, b};
        if (!(std::min(height(mesh, one), height(mesh, two)) >
              std::min(low, height(mesh, mesh.facets[g]))))
            continue;
        // Never a second edge between two vertices.
        const std::array<std::uint32_t, 2> diagonal{std::min(c, d), std::max(c, d)};
        if (std::binary_search(mesh.edges.begin(), mesh.edges.end(), diagonal)) continue;
        is_used[f] = is_used[g] = 1;
        for (const std::uint32_t n : mesh.neighbours[f])
            if (n != no_index) is_used[n] = 1;
        for (const std::uint32_t n : mesh.neighbours[g])
            if (n != no_index) is_used[n] = 1;
        mesh.facets[f] = one;
        mesh.facets[g] = two;
        found = true;
    }
    return found;
}

} // namespace

void remove_slivers(SurfaceMesh& mesh, double cell, const std::vector<char>& on_creases,
                    int threads, MeshReport& report)
{
    bool is_changed = false;
    for (int round = 0; round < rounds; ++round)
    {
        const bool joined = join_near_vertices(mesh, cell, on_creases);
        if (joined) build_edges(mesh, threads);
        const bool turned = turn_sides(mesh, cell);
        if (turned) build_edges(mesh, threads);
        if (!joined && !turned) break;
        is_changed = true;
    }
    if (is_changed) reconnect(mesh, threads, report);
}

void reconnect(SurfaceMesh& mesh, int threads, MeshReport& report)
{
    const std::size_t facets_read = report.facets_read;
    report = {};
    report.facets_read = facets_read;
    connect_mesh(mesh, threads, report);
}

} // namespace fppg
