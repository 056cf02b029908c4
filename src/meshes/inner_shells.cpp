#include "meshes/inner_shells.h"

#include <algorithm>
#include <cstdint>

#include "core/parallel.h"
#include "meshes/inside_test.h"
#include "meshes/mesh_facets.h"

namespace fppg
{

namespace
{

/// How many times the other closed shells wind around a point.
int winding_of_others(const MeshQuery& query, const SurfaceMesh& mesh,
                      const std::vector<char>& is_closed, std::uint32_t own, const Vec3& p)
{
    return winding_by_lines(query, p,
                            [&](std::uint32_t facet)
                            {
                                const std::uint32_t shell = mesh.shells[facet];
                                return shell != own && is_closed[shell] != 0;
                            })
        .value_or(0);
}

} // namespace

std::size_t find_inner_shells(const SurfaceMesh& mesh, std::size_t shells, int threads,
                              std::vector<char>& is_inner)
{
    is_inner.assign(mesh.facets.size(), 0);
    if (shells < 2) return 0;
    std::vector<char> is_closed(shells, 1);
    std::vector<double> volume(shells, 0);
    std::vector<Vec3> first(shells);
    std::vector<char> has_first(shells, 0);
    for (std::size_t f = 0; f < mesh.facets.size(); ++f)
    {
        const std::uint32_t s = mesh.shells[f];
        if (has_first[s] == 0) first[s] = mesh.vertices[mesh.facets[f][0]];
        has_first[s] = 1;
        volume[s] += volume_times_six(mesh, f, first[s]);
        for (const std::uint32_t other : mesh.neighbours[f])
            if (other == no_index) is_closed[s] = 0;
    }
    if (std::count(is_closed.begin(), is_closed.end(), 1) < 2) return 0;
    const MeshQuery query(soup_of(mesh), threads);
    std::vector<char> is_candidate(shells, 0);
    for (std::uint32_t s = 0; s < shells; ++s)
        is_candidate[s] =
            static_cast<char>(is_closed[s] != 0 && volume[s] > 0 &&
                              winding_of_others(query, mesh, is_closed, s, first[s]) > 0);
    std::vector<char> is_outside(mesh.facets.size(), 0);
    parallel_for(
        mesh.facets.size(), threads,
        [&](std::size_t f)
        {
            const std::uint32_t s = mesh.shells[f];
            if (is_candidate[s] == 0) return;
            for (const std::uint32_t v : mesh.facets[f])
                if (winding_of_others(query, mesh, is_closed, s, mesh.vertices[v]) <= 0)
                    is_outside[f] = 1;
        },
        64);
    for (std::size_t f = 0; f < mesh.facets.size(); ++f)
        if (is_outside[f] != 0) is_candidate[mesh.shells[f]] = 0;
    std::size_t count = 0;
    for (std::size_t f = 0; f < mesh.facets.size(); ++f)
        count += static_cast<std::size_t>(is_inner[f] = is_candidate[mesh.shells[f]]);
    return count;
}

} // namespace fppg
