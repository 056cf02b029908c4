#include "meshes/close_cracks.h"

#include <algorithm>
#include <utility>
#include <vector>

#include "meshes/drop_copies.h"
#include "meshes/drop_degenerate.h"
#include "meshes/edge_map.h"
#include "meshes/mesh_facets.h"
#include "meshes/t_junctions.h"
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

std::size_t count_non_manifold(const SurfaceMesh& mesh)
{
    return static_cast<std::size_t>(
        std::count(mesh.is_manifold.begin(), mesh.is_manifold.end(), 0));
}

/// Per vertex whether it is the end of an open edge.
std::vector<char> find_open_ends(const SurfaceMesh& mesh)
{
    std::vector<char> is_end(mesh.vertices.size(), 0);
    for (std::size_t e = 0; e < mesh.edges.size(); ++e)
        if (is_open(mesh, e))
            for (const std::uint32_t v : mesh.edges[e]) is_end[v] = 1;
    return is_end;
}

double longest_extent(const SurfaceMesh& mesh)
{
    Box3 bounds;
    for (const Facet& facet : mesh.facets)
        for (const std::uint32_t v : facet) bounds.add(mesh.vertices[v]);
    const Vec3 size = bounds.max - bounds.min;
    return std::max({size.x, size.y, size.z});
}

/// Joins corners within a distance, drops facets that lose their area, and takes the outcome over
/// if at most `open_left` edges are open then and nine tenths of the facets are left: what loses
/// more had no cracks, but thin parts. Returns whether it did.
bool join_within(double distance, const std::vector<char>& may_move, std::size_t open_left,
                 int threads, SurfaceMesh& mesh, MeshReport& report)
{
    SurfaceMesh joined;
    joined.vertices = mesh.vertices;
    joined.facets = mesh.facets;
    weld_near(distance, may_move, joined);
    if (joined.vertices.size() == mesh.vertices.size()) return false;
    MeshReport dropped;
    drop_degenerate(joined, dropped);
    const std::size_t kept = count_different(joined.facets, threads);
    if (10 * kept < 9 * count_different(mesh.facets, threads)) return false;
    build_edges(joined, threads);
    if (count_open(joined) > open_left) return false;
    if (!may_move.empty() && count_non_manifold(joined) > count_non_manifold(mesh)) return false;
    report.joined_corners += mesh.vertices.size() - joined.vertices.size();
    report.degenerate_facets += dropped.degenerate_facets;
    report.joined_within = std::max(report.joined_within, distance);
    mesh = std::move(joined);
    return true;
}

/// Splits open edges at the ends of others within a distance, if fewer edges are open then.
void split_within(double distance, double dp, int threads, SurfaceMesh& mesh, MeshReport& report)
{
    const std::vector<Junction> junctions =
        find_t_junctions(mesh, distance, widest_crack(dp), threads);
    if (junctions.empty()) return;
    SurfaceMesh split;
    split.vertices = mesh.vertices;
    split.facets = mesh.facets;
    split.facet_edges = mesh.facet_edges;
    split.edge_facets = mesh.edge_facets;
    split.edges = mesh.edges;
    split_at(junctions, split);
    build_edges(split, threads);
    if (count_open(split) >= count_open(mesh) ||
        count_non_manifold(split) > count_non_manifold(mesh))
        return;
    if (report.t_junctions == 0) report.first_junction = mesh.vertices[junctions.front().vertex];
    report.t_junctions += junctions.size();
    report.joined_within = std::max(report.joined_within, distance);
    mesh = std::move(split);
}

} // namespace

void join_rounded_corners(double dp, SurfaceMesh& mesh, int threads, MeshReport& report)
{
    const std::size_t open = count_open(mesh);
    if (open == 0) return;
    double size = 0;
    for (const Vec3& p : mesh.vertices) size = std::max(size, largest_coordinate(p));
    join_within(std::min(float_step * size, widest_crack(dp)), find_open_ends(mesh), open - 1,
                threads, mesh, report);
}

void close_cracks(double dp, SurfaceMesh& mesh, int threads, MeshReport& report)
{
    const std::size_t open = count_open(mesh);
    if (4 * open <= mesh.edges.size()) return;
    const double size = longest_extent(mesh);
    double sides = 0;
    for (const auto& [a, b] : mesh.edges) sides += norm(mesh.vertices[b] - mesh.vertices[a]);
    for (const double share : {1e-6, 1e-5, 1e-4})
    {
        const double distance = share * size;
        if (distance > widest_crack(dp)) return;
        if (!(distance < 0.1 * sides / static_cast<double>(mesh.edges.size()))) return;
        if (join_within(distance, {}, open / 10, threads, mesh, report)) return;
    }
}

void close_open_ends(double dp, SurfaceMesh& mesh, int threads, MeshReport& report)
{
    std::size_t open = count_open(mesh);
    if (open == 0) return;
    const double size = longest_extent(mesh);
    const double widest = widest_crack(dp);
    std::vector<double> distances{1e-6 * size,  1e-5 * size, 1e-4 * size,
                                  0.1 * widest, widest / 3,  widest};
    std::sort(distances.begin(), distances.end());
    for (const double distance : distances)
    {
        double length = 0;
        for (std::size_t e = 0; e < mesh.edges.size(); ++e)
            if (is_open(mesh, e))
                length += norm(mesh.vertices[mesh.edges[e][1]] - mesh.vertices[mesh.edges[e][0]]);
        if (distance > widest || !(distance < 0.1 * length / static_cast<double>(open))) return;
        join_within(distance, find_open_ends(mesh), open - 1, threads, mesh, report);
        split_within(distance, dp, threads, mesh, report);
        open = count_open(mesh);
        if (open == 0) return;
    }
}

} // namespace fppg
