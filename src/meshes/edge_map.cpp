#include "meshes/edge_map.h"

#include <algorithm>
#include <compare>
#include <cstdint>
#include <vector>

#include "core/parallel.h"
#include "core/row_lists.h"

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

    auto operator<=>(const EdgeSide&) const = default;
};

/// The sides of all facets by their smaller vertex, then their larger one, then by facet.
RowLists<EdgeSide> sort_sides(const SurfaceMesh& mesh, int threads)
{
    return make_row_lists<EdgeSide>(
        mesh.vertices.size(), mesh.facets.size(), threads,
        [&](std::size_t f, const auto& add)
        {
            for (std::size_t s = 0; s < 3; ++s)
            {
                const std::uint32_t a = mesh.facets[f][s], b = mesh.facets[f][(s + 1) % 3];
                add(std::min(a, b),
                    EdgeSide{std::max(a, b), static_cast<std::uint32_t>(3 * f + s)});
            }
        });
}

} // namespace

void build_edges(SurfaceMesh& mesh, int threads)
{
    const RowLists<EdgeSide> of = sort_sides(mesh, threads);
    const std::vector<EdgeSide>& sides = of.values;
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
