#include "meshes/edge_map.h"

#include <algorithm>
#include <cstdint>
#include <vector>

#include "core/parallel.h"

namespace fppg
{

namespace
{

constexpr std::size_t vertices_per_block = 4096;

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
    const std::size_t blocks = (mesh.vertices.size() + vertices_per_block - 1) / vertices_per_block;
    // Calls visit(vertex, begin, end) for the sides of each edge of a block's vertices.
    const auto for_each_edge = [&](std::size_t block, const auto& visit)
    {
        const std::size_t last = std::min(mesh.vertices.size(), (block + 1) * vertices_per_block);
        for (std::size_t v = block * vertices_per_block; v < last; ++v)
            for (std::size_t i = of.first[v]; i < of.first[v + 1];)
            {
                std::size_t end = i + 1;
                while (end < of.first[v + 1] && sides[end].larger == sides[i].larger) ++end;
                visit(static_cast<std::uint32_t>(v), i, end);
                i = end;
            }
    };
    std::vector<std::size_t> first(blocks + 1, 0); // edge of each block
    parallel_for(
        blocks, threads,
        [&](std::size_t b)
        { for_each_edge(b, [&](std::uint32_t, std::size_t, std::size_t) { ++first[b + 1]; }); });
    for (std::size_t b = 0; b < blocks; ++b) first[b + 1] += first[b];
    mesh.edges.resize(first.back());
    mesh.edge_facets.resize(first.back());
    mesh.is_manifold.resize(first.back());
    mesh.neighbours.assign(mesh.facets.size(), {no_index, no_index, no_index});
    mesh.facet_edges.resize(mesh.facets.size());
    parallel_for(
        blocks, threads,
        [&](std::size_t b)
        {
            std::size_t edge = first[b];
            for_each_edge(
                b,
                [&](std::uint32_t v, std::size_t begin, std::size_t end)
                {
                    const std::uint32_t one = sides[begin].side;
                    const std::uint32_t two = end > begin + 1 ? sides[begin + 1].side : no_index;
                    mesh.edges[edge] = {v, sides[begin].larger};
                    mesh.edge_facets[edge] = {one / 3, two == no_index ? no_index : two / 3};
                    mesh.is_manifold[edge] = end - begin <= 2 ? 1 : 0;
                    if (end - begin == 2)
                    {
                        mesh.neighbours[one / 3][one % 3] = two / 3;
                        mesh.neighbours[two / 3][two % 3] = one / 3;
                    }
                    for (std::size_t i = begin; i < end; ++i)
                        mesh.facet_edges[sides[i].side / 3][sides[i].side % 3] =
                            static_cast<std::uint32_t>(edge);
                    ++edge;
                });
        });
}

} // namespace fppg
