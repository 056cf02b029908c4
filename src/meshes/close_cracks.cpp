#include "meshes/close_cracks.h"

#include <algorithm>
#include <utility>
#include <vector>

#include "meshes/drop_degenerate.h"
#include "meshes/edge_map.h"
#include "meshes/mesh_facets.h"
#include "meshes/weld_corners.h"

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

/// Joins corners within a distance, drops facets that lose their area, and takes the outcome over
/// if at most `open_left` edges are open then. Returns whether it did.
bool join_within(double distance, const std::vector<char>& may_move, std::size_t open_left,
                 int threads, SurfaceMesh& mesh, MeshReport& report)
{
    SurfaceMesh joined;
    joined.vertices = mesh.vertices;
    joined.facets = mesh.facets;
    weld_near(distance, may_move, joined);
    MeshReport dropped;
    drop_degenerate(joined, dropped);
    if (joined.facets.empty()) return false;
    build_edges(joined, threads);
    if (count_open(joined) > open_left) return false;
    report.joined_corners += mesh.vertices.size() - joined.vertices.size();
    report.degenerate_facets += dropped.degenerate_facets;
    report.joined_within = std::max(report.joined_within, distance);
    mesh = std::move(joined);
    return true;
}

} // namespace

void join_rounded_corners(SurfaceMesh& mesh, int threads, MeshReport& report)
{
    std::vector<char> is_end(mesh.vertices.size(), 0);
    std::size_t open = 0;
    for (std::size_t e = 0; e < mesh.edges.size(); ++e)
    {
        if (!is_open(mesh, e)) continue;
        ++open;
        for (const std::uint32_t v : mesh.edges[e]) is_end[v] = 1;
    }
    if (open == 0) return;
    double size = 0;
    for (const Vec3& p : mesh.vertices) size = std::max(size, largest_coordinate(p));
    join_within(float_step * size, is_end, open - 1, threads, mesh, report);
}

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
        if (join_within(distance, {}, open / 10, threads, mesh, report)) return;
    }
}

} // namespace fppg
