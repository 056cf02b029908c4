#include "meshes/edge_map.h"

#include <algorithm>
#include <cstdint>
#include <vector>

#include "core/parallel.h"

namespace fppg
{

namespace
{

/// A side of a facet, at its vertex of smaller index.
struct EdgeSide
{
    std::uint32_t larger; ///< the other vertex
    std::uint32_t side;   ///< 3 * facet + side
};

/// The sides of all facets by their smaller vertex, then their larger one, then by facet.
struct SidesOfVertices
{
    std::vector<std::size_t> first; ///< per vertex, and one past the end
    std::vector<EdgeSide> sides;
};

SidesOfVertices sort_sides(const SurfaceMesh& mesh, int threads)
{
    SidesOfVertices out;
    out.first.assign(mesh.vertices.size() + 1, 0);
    const auto for_each_side = [&](const auto& visit)
    {
        for (std::size_t f = 0; f < mesh.facets.size(); ++f)
            for (std::size_t s = 0; s < 3; ++s)
            {
                const std::uint32_t a = mesh.facets[f][s], b = mesh.facets[f][(s + 1) % 3];
                visit(std::min(a, b),
                      EdgeSide{std::max(a, b), static_cast<std::uint32_t>(3 * f + s)});
            }
    };
    for_each_side([&](std::uint32_t vertex, const EdgeSide&) { ++out.first[vertex + 1]; });
    for (std::size_t v = 0; v < mesh.vertices.size(); ++v) out.first[v + 1] += out.first[v];
    std::vector<std::size_t> next(out.first.begin(), out.first.end() - 1);
    out.sides.resize(3 * mesh.facets.size());
    for_each_side([&](std::uint32_t vertex, const EdgeSide& side)
                  { out.sides[next[vertex]++] = side; });
    parallel_for(
        mesh.vertices.size(), threads,
        [&](std::size_t v)
        {
            const auto at = [&](std::size_t i)
            { return out.sides.begin() + static_cast<std::ptrdiff_t>(i); };
            std::sort(at(out.first[v]), at(out.first[v + 1]),
                      [](const EdgeSide& a, const EdgeSide& b)
                      { return a.larger != b.larger ? a.larger < b.larger : a.side < b.side; });
        },
        4096);
    return out;
}

} // namespace

void build_edges(SurfaceMesh& mesh, int threads)
{
    const SidesOfVertices of = sort_sides(mesh, threads);
    const std::vector<EdgeSide>& sides = of.sides;
    const std::size_t n = mesh.facets.size();
    mesh.edges.clear();
    mesh.edge_facets.clear();
    mesh.is_manifold.clear();
    mesh.edges.reserve(sides.size() / 2 + 1);
    mesh.edge_facets.reserve(sides.size() / 2 + 1);
    mesh.is_manifold.reserve(sides.size() / 2 + 1);
    mesh.neighbours.assign(n, {no_index, no_index, no_index});
    mesh.facet_edges.assign(n, {no_index, no_index, no_index});
    for (std::uint32_t v = 0; v < mesh.vertices.size(); ++v)
        for (std::size_t i = of.first[v]; i < of.first[v + 1];)
        {
            std::size_t end = i + 1;
            while (end < of.first[v + 1] && sides[end].larger == sides[i].larger) ++end;
            const auto edge = static_cast<std::uint32_t>(mesh.edges.size());
            const std::uint32_t first = sides[i].side;
            const std::uint32_t second = end > i + 1 ? sides[i + 1].side : no_index;
            mesh.edges.push_back({v, sides[i].larger});
            mesh.edge_facets.push_back({first / 3, second == no_index ? no_index : second / 3});
            mesh.is_manifold.push_back(end - i <= 2 ? 1 : 0);
            if (end - i == 2)
            {
                mesh.neighbours[first / 3][first % 3] = second / 3;
                mesh.neighbours[second / 3][second % 3] = first / 3;
            }
            for (; i < end; ++i) mesh.facet_edges[sides[i].side / 3][sides[i].side % 3] = edge;
        }
}

} // namespace fppg
