#include "meshes/measure_facets.h"

#include <algorithm>
#include <cstdint>
#include <numeric>
#include <vector>

#include "core/parallel.h"
#include "meshes/mesh_facets.h"

namespace fppg
{

namespace
{

constexpr char without_side = 2;

} // namespace

void measure_facets(SurfaceMesh& mesh, int threads, double own_above)
{
    const std::size_t n = mesh.facets.size();
    mesh.normals.resize(n);
    mesh.areas.resize(n);
    std::vector<char> is_thin(n, 0);
    std::vector<char> longest(n, 0);
    parallel_for(
        n, threads,
        [&](std::size_t f)
        {
            const Measures m = measure(mesh, mesh.facets[f]);
            mesh.normals[f] = m.normal;
            mesh.areas[f] = m.area;
            double size = 0;
            for (const std::uint32_t v : mesh.facets[f])
                size = std::max(size, largest_coordinate(mesh.vertices[v]));
            // A height of 16 roundings keeps the normal within about four degrees.
            is_thin[f] = m.height < std::min(16 * float_step * size, own_above) ? 1 : 0;
            // Below half a rounding nothing says which way the facet looks.
            if (m.height < std::min(0.5 * float_step * size, own_above)) is_thin[f] = without_side;
            longest[f] = static_cast<char>(m.longest);
        },
        4096);
    for (std::size_t f = 0; f < n; ++f)
    {
        if (is_thin[f] == 0) continue;
        std::uint32_t at = static_cast<std::uint32_t>(f);
        for (int step = 0; step < 8 && at != no_index && is_thin[at] != 0; ++step)
            at = mesh.neighbours[at][static_cast<std::size_t>(longest[at])];
        if (at == no_index || is_thin[at] != 0) continue;
        // A thin facet that is the edge of a thin plate keeps its own side.
        if (is_thin[f] == without_side || dot(mesh.normals[at], mesh.normals[f]) > 0)
            mesh.normals[f] = mesh.normals[at];
    }
}

double turn_per_metre(const SurfaceMesh& mesh)
{
    double turns = 0;
    for (std::size_t e = 0; e < mesh.edges.size(); ++e)
    {
        const auto [f, g] = mesh.edge_facets[e];
        if (g == no_index || mesh.is_manifold[e] == 0) continue;
        const auto [a, b] = mesh.edges[e];
        turns +=
            norm(mesh.normals[f] - mesh.normals[g]) * norm(mesh.vertices[b] - mesh.vertices[a]);
    }
    const double area = std::accumulate(mesh.areas.begin(), mesh.areas.end(), 0.0);
    return area > 0 ? turns / area : 0;
}

} // namespace fppg
