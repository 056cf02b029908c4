#include "meshes/edge_map.h"

#include <algorithm>
#include <cstdint>
#include <vector>

#include "core/parallel.h"
#include "core/parallel_sort.h"

namespace fppg
{

void build_edges(SurfaceMesh& mesh, int threads)
{
    struct Side
    {
        std::uint64_t edge; ///< smaller vertex, then larger one
        std::uint32_t side; ///< 3 * facet + side
    };
    const std::size_t n = mesh.facets.size();
    std::vector<Side> sides(3 * n);
    parallel_for(
        n, threads,
        [&](std::size_t f)
        {
            for (std::size_t s = 0; s < 3; ++s)
            {
                const std::uint64_t a = mesh.facets[f][s], b = mesh.facets[f][(s + 1) % 3];
                sides[3 * f + s] = {std::min(a, b) << 32 | std::max(a, b),
                                    static_cast<std::uint32_t>(3 * f + s)};
            }
        },
        4096);
    parallel_sort(sides, threads,
                  [](const Side& a, const Side& b)
                  { return a.edge != b.edge ? a.edge < b.edge : a.side < b.side; });

    mesh.edges.clear();
    mesh.edge_facets.clear();
    mesh.is_manifold.clear();
    mesh.neighbours.assign(n, {no_index, no_index, no_index});
    mesh.facet_edges.assign(n, {no_index, no_index, no_index});
    for (std::size_t i = 0; i < sides.size();)
    {
        std::size_t end = i + 1;
        while (end < sides.size() && sides[end].edge == sides[i].edge) ++end;
        const auto edge = static_cast<std::uint32_t>(mesh.edges.size());
        const std::uint32_t first = sides[i].side;
        const std::uint32_t second = end > i + 1 ? sides[i + 1].side : no_index;
        mesh.edges.push_back({static_cast<std::uint32_t>(sides[i].edge >> 32),
                              static_cast<std::uint32_t>(sides[i].edge)});
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
