#include "offset/slivers.h"

#include "meshes/connect_mesh.h"

#include <algorithm>
#include <array>
#include <iterator>
#include <numeric>
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

/// Facets that lost a side go, and pairs that came to lie on one another.
void drop_flat(SurfaceMesh& mesh)
{
    std::vector<Corners> kept;
    for (const Corners& f : mesh.facets)
        if (f[0] != f[1] && f[1] != f[2] && f[2] != f[0]) kept.push_back(f);
    std::vector<std::size_t> order(kept.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::sort(order.begin(), order.end(),
              [&](std::size_t a, std::size_t b)
              {
                  const Corners x = sorted(kept[a]);
                  const Corners y = sorted(kept[b]);
                  return x < y || (x == y && a < b);
              });
    std::vector<char> is_out(kept.size(), 0);
    for (std::size_t i = 1; i < order.size(); ++i)
        if (is_out[order[i - 1]] == 0 && sorted(kept[order[i]]) == sorted(kept[order[i - 1]]))
            is_out[order[i]] = is_out[order[i - 1]] = 1;
    mesh.facets.clear();
    for (std::size_t i = 0; i < kept.size(); ++i)
        if (is_out[i] == 0) mesh.facets.push_back(kept[i]);
}

/// The vertices at the other ends of the edges of each vertex, ascending.
std::vector<std::vector<std::uint32_t>> neighbours_of_vertices(const SurfaceMesh& mesh)
{
    std::vector<std::vector<std::uint32_t>> out(mesh.vertices.size());
    for (const auto& edge : mesh.edges)
    {
        out[edge[0]].push_back(edge[1]);
        out[edge[1]].push_back(edge[0]);
    }
    for (auto& list : out) std::sort(list.begin(), list.end());
    return out;
}

/// Joins the ends of short edges, each vertex with one other at most and none of its neighbours
/// with any; returns whether any was. Ends that have more neighbours in common than the facets of
/// their edge say would pinch the surface.
bool join_near_vertices(SurfaceMesh& mesh, double cell, const std::vector<char>& on_creases)
{
    const std::vector<std::vector<std::uint32_t>> around = neighbours_of_vertices(mesh);
    std::vector<std::uint32_t> of(mesh.vertices.size());
    std::iota(of.begin(), of.end(), 0u);
    std::vector<char> is_used(of.size(), 0);
    bool found = false;
    for (const auto& edge : mesh.edges)
    {
        if (is_used[edge[0]] != 0 || is_used[edge[1]] != 0) continue;
        if (!(norm(mesh.vertices[edge[0]] - mesh.vertices[edge[1]]) < one_vertex * cell)) continue;
        std::vector<std::uint32_t> common;
        std::set_intersection(around[edge[0]].begin(), around[edge[0]].end(),
                              around[edge[1]].begin(), around[edge[1]].end(),
                              std::back_inserter(common));
        if (common.size() > 2) continue;
        for (const std::uint32_t end : edge)
        {
            is_used[end] = 1;
            for (const std::uint32_t v : around[end]) is_used[v] = 1;
        }
        // The vertex on a crease stays.
        const std::size_t kept = on_creases[edge[1]] > on_creases[edge[0]] ? 1 : 0;
        of[edge[1 - kept]] = edge[kept];
        found = true;
    }
    if (!found) return false;
    for (Corners& f : mesh.facets)
        for (std::uint32_t& v : f) v = of[v];
    drop_flat(mesh);
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
    for (int round = 0; round < rounds; ++round)
    {
        const bool joined = join_near_vertices(mesh, cell, on_creases);
        if (joined) reconnect(mesh, threads, report);
        const bool turned = turn_sides(mesh, cell);
        if (turned) reconnect(mesh, threads, report);
        if (!joined && !turned) break;
    }
}

void reconnect(SurfaceMesh& mesh, int threads, MeshReport& report)
{
    const std::size_t facets_read = report.facets_read;
    report = {};
    report.facets_read = facets_read;
    connect_mesh(mesh, threads, report);
}

} // namespace fppg
