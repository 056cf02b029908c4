#include "offset/slivers.h"

#include "core/parallel.h"
#include "core/row_lists.h"
#include "meshes/edge_map.h"
#include "meshes/measure_facets.h"

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
RowLists<std::uint32_t> vertices_around(const SurfaceMesh& mesh, int threads)
{
    return make_row_lists<std::uint32_t>(mesh.vertices.size(), mesh.edges.size(), threads,
                                         [&](std::size_t e, const auto& add)
                                         {
                                             const auto& [a, b] = mesh.edges[e];
                                             add(a, b);
                                             add(b, a);
                                         });
}

/// The numbers of the items that are chosen, ascending.
template <typename Choose>
std::vector<std::uint32_t> chosen(std::size_t items, int threads, const Choose& choose)
{
    std::vector<char> is_chosen(items);
    parallel_for(
        items, threads, [&](std::size_t i) { is_chosen[i] = choose(i) ? 1 : 0; }, 4096);
    std::vector<std::uint32_t> out;
    for (std::uint32_t i = 0; i < items; ++i)
        if (is_chosen[i] != 0) out.push_back(i);
    return out;
}

/// Joins the ends of short edges, each vertex with one other at most and none of its neighbours
/// with any; returns whether any was. Ends that have more neighbours in common than the facets of
/// their edge say would pinch the surface.
bool join_near_vertices(SurfaceMesh& mesh, double cell, const std::vector<char>& on_creases,
                        int threads)
{
    const std::vector<std::uint32_t> near =
        chosen(mesh.edges.size(), threads,
               [&](std::size_t e)
               {
                   const auto& [a, b] = mesh.edges[e];
                   return norm(mesh.vertices[a] - mesh.vertices[b]) < one_vertex * cell;
               });
    if (near.empty()) return false;
    const RowLists<std::uint32_t> around = vertices_around(mesh, threads);
    std::vector<std::uint32_t> of(mesh.vertices.size());
    std::iota(of.begin(), of.end(), 0u);
    std::vector<char> is_used(of.size(), 0);
    std::vector<char> is_joined(of.size(), 0);
    bool found = false;
    for (const std::uint32_t e : near)
    {
        const auto& edge = mesh.edges[e];
        if (is_used[edge[0]] != 0 || is_used[edge[1]] != 0) continue;
        std::vector<std::uint32_t> common;
        std::ranges::set_intersection(around.row(edge[0]), around.row(edge[1]),
                                      std::back_inserter(common));
        if (common.size() > 2) continue;
        for (const std::uint32_t end : edge)
        {
            is_used[end] = 1;
            for (const std::uint32_t v : around.row(end)) is_used[v] = 1;
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
bool turn_sides(SurfaceMesh& mesh, double cell, int threads)
{
    const std::vector<std::uint32_t> low_facets =
        chosen(mesh.facets.size(), threads,
               [&](std::size_t f) { return height(mesh, mesh.facets[f]) < low_facet * cell; });
    if (low_facets.empty()) return false;
    std::vector<char> is_used(mesh.facets.size(), 0);
    bool found = false;
    for (const std::uint32_t f : low_facets)
    {
        if (is_used[f] != 0) continue;
        const double low = height(mesh, mesh.facets[f]);
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
                    int threads)
{
    bool is_changed = false;
    for (int round = 0; round < rounds; ++round)
    {
        const bool joined = join_near_vertices(mesh, cell, on_creases, threads);
        if (joined) build_edges(mesh, threads);
        const bool turned = turn_sides(mesh, cell, threads);
        if (turned) build_edges(mesh, threads);
        if (!joined && !turned) break;
        is_changed = true;
    }
    if (is_changed) measure_facets(mesh, threads, high_where_exact * cell);
}

} // namespace fppg
