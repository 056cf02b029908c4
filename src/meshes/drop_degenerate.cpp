#include "meshes/drop_degenerate.h"

#include <algorithm>
#include <vector>

#include "meshes/edge_map.h"
#include "meshes/mesh_facets.h"

namespace fppg
{

void drop_degenerate(SurfaceMesh& mesh, MeshReport& report)
{
    const std::size_t before = mesh.facets.size();
    std::erase_if(mesh.facets,
                  [&](const Facet& f)
                  {
                      if (f[0] == f[1] || f[1] == f[2] || f[2] == f[0]) return true;
                      const Measures m = measure(mesh, f);
                      const auto s = static_cast<std::size_t>(m.longest);
                      const double longest =
                          norm(mesh.vertices[f[(s + 1) % 3]] - mesh.vertices[f[s]]);
                      return !(m.height > 1e-12 * longest);
                  });
    report.degenerate_facets += before - mesh.facets.size();
}

void drop_loose_slivers(double dp, SurfaceMesh& mesh, int threads, MeshReport& report)
{
    std::vector<char> is_dropped(mesh.facets.size(), 0);
    std::size_t dropped = 0;
    for (std::size_t f = 0; f < mesh.facets.size(); ++f)
    {
        const Facet& corners = mesh.facets[f];
        if (std::none_of(mesh.neighbours[f].begin(), mesh.neighbours[f].end(),
                         [](std::uint32_t other) { return other == no_index; }))
            continue;
        const Measures m = measure(mesh, corners);
        const auto s = static_cast<std::size_t>(m.longest);
        const Vec3 &a = mesh.vertices[corners[s]], &b = mesh.vertices[corners[(s + 1) % 3]];
        const double size = std::max(largest_coordinate(a), largest_coordinate(b));
        if (m.height > std::min({float_step * size, widest_crack(dp), 1e-3 * norm(b - a)}))
            continue;
        is_dropped[f] = 1;
        ++dropped;
    }
    if (dropped == 0 || dropped == mesh.facets.size()) return;
    erase_facets(is_dropped, mesh);
    report.degenerate_facets += dropped;
    build_edges(mesh, threads);
}

} // namespace fppg
