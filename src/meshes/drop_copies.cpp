#include "meshes/drop_copies.h"

#include <algorithm>
#include <cstdint>
#include <vector>

#include "core/parallel_sort.h"
#include "meshes/edge_map.h"
#include "meshes/inner_walls.h"
#include "meshes/mesh_facets.h"

namespace fppg
{

namespace
{

/// Which of the two ways around its corners a facet runs.
bool parity(const Facet& f)
{
    const auto least = static_cast<std::size_t>(std::min_element(f.begin(), f.end()) - f.begin());
    return f[(least + 1) % 3] < f[(least + 2) % 3];
}

Facet sorted(Facet f)
{
    std::sort(f.begin(), f.end());
    return f;
}

/// Groups of facets with the same corners, each in the order of the file.
std::vector<std::vector<std::uint32_t>> find_copies(const std::vector<Facet>& facets, int threads)
{
    struct Key
    {
        Facet corners;
        std::uint32_t facet;
    };
    std::vector<Key> keys(facets.size());
    for (std::size_t i = 0; i < keys.size(); ++i)
        keys[i] = {sorted(facets[i]), static_cast<std::uint32_t>(i)};
    parallel_sort(keys, threads,
                  [](const Key& a, const Key& b)
                  { return a.corners != b.corners ? a.corners < b.corners : a.facet < b.facet; });
    std::vector<std::vector<std::uint32_t>> groups;
    for (std::size_t i = 0; i < keys.size();)
    {
        std::size_t end = i + 1;
        while (end < keys.size() && keys[end].corners == keys[i].corners) ++end;
        if (end > i + 1)
        {
            groups.emplace_back();
            for (; i < end; ++i) groups.back().push_back(keys[i].facet);
        }
        i = end;
    }
    return groups;
}

/// Whether facets with the same corners are possible: they make an edge of more than two facets,
/// or are each other's only neighbours.
bool may_have_copies(const SurfaceMesh& mesh)
{
    if (std::find(mesh.is_manifold.begin(), mesh.is_manifold.end(), 0) != mesh.is_manifold.end())
        return true;
    return std::any_of(mesh.neighbours.begin(), mesh.neighbours.end(),
                       [](const Facet& n)
                       { return n[0] != no_index && n[0] == n[1] && n[1] == n[2]; });
}

} // namespace

std::size_t count_different(const std::vector<Facet>& facets, int threads)
{
    std::size_t count = facets.size();
    for (const std::vector<std::uint32_t>& group : find_copies(facets, threads))
        count -= group.size() - 1;
    return count;
}

void drop_copies(SurfaceMesh& mesh, int threads, MeshReport& report)
{
    if (!may_have_copies(mesh)) return;
    const std::vector<std::vector<std::uint32_t>> groups = find_copies(mesh.facets, threads);
    if (groups.empty()) return;
    std::vector<char> is_dropped(mesh.facets.size(), 0);
    std::vector<char> is_twin(mesh.facets.size(), 0);
    for (const std::vector<std::uint32_t>& group : groups)
    {
        for (std::size_t i = 1; i < group.size(); ++i) is_dropped[group[i]] = 1;
        report.duplicate_facets += group.size() - 1;
        is_twin[group[0]] = static_cast<char>(
            group.size() == 2 && parity(mesh.facets[group[0]]) != parity(mesh.facets[group[1]]));
    }
    erase_facets(is_dropped, mesh);
    std::size_t kept = 0;
    for (std::size_t f = 0; f < is_dropped.size(); ++f)
        if (is_dropped[f] == 0) is_twin[kept++] = is_twin[f];
    is_twin.resize(kept);
    build_edges(mesh, threads);
    keep_inner_walls(mesh, is_twin);
    const auto walls = static_cast<std::size_t>(std::count(is_twin.begin(), is_twin.end(), 1));
    if (walls == 0) return;
    report.duplicate_facets -= walls;
    report.inner_wall_facets += 2 * walls;
    erase_facets(is_twin, mesh);
    build_edges(mesh, threads);
}

} // namespace fppg
