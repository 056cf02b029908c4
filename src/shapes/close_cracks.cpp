#include "shapes/close_cracks.h"

#include <algorithm>
#include <utility>

#include "shapes/drop_degenerate.h"
#include "shapes/edge_map.h"
#include "shapes/weld_corners.h"

namespace fppg
{

namespace
{

std::size_t count_open(const SurfaceMesh& mesh)
{
    std::size_t count = 0;
    for (std::size_t e = 0; e < mesh.edges.size(); ++e) count += is_open(mesh, e) ? 1 : 0;
    return count;
}

} // namespace

void close_cracks(SurfaceMesh& mesh, int threads, MeshReport& report)
{
    const std::size_t open = count_open(mesh);
    if (4 * open <= mesh.edges.size()) return;
    Box3 bounds;
    for (const Vec3& p : mesh.vertices) bounds.add(p);
    const Vec3 size = bounds.max - bounds.min;
    double sides = 0;
    for (const auto& [a, b] : mesh.edges) sides += norm(mesh.vertices[b] - mesh.vertices[a]);
    for (const double share : {1e-6, 1e-5, 1e-4})
    {
        const double distance = share * std::max({size.x, size.y, size.z});
        if (!(distance < 0.1 * sides / static_cast<double>(mesh.edges.size()))) return;
        SurfaceMesh joined;
        joined.vertices = mesh.vertices;
        joined.facets = mesh.facets;
        weld_near(distance, joined);
        MeshReport dropped;
        drop_degenerate(joined, dropped);
        if (joined.facets.empty()) return;
        build_edges(joined, threads);
        if (10 * count_open(joined) > open) continue;
        report.joined_corners = mesh.vertices.size() - joined.vertices.size();
        report.degenerate_facets += dropped.degenerate_facets;
        report.joined_within = distance;
        mesh = std::move(joined);
        return;
    }
}

} // namespace fppg
