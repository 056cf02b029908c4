#include "meshes/connect_mesh.h"

#include "meshes/edge_map.h"
#include "meshes/judge_edges.h"
#include "meshes/measure_facets.h"
#include "meshes/mesh_facets.h"
#include "meshes/orient_shells.h"

namespace fppg
{

void connect_mesh(SurfaceMesh& mesh, double own_above, int threads, MeshReport& report)
{
    build_edges(mesh, threads);
    finish_mesh(mesh, own_above, threads, report);
}

void finish_mesh(SurfaceMesh& mesh, double own_above, int threads, MeshReport& report)
{
    report = {};
    report.facets_read = mesh.facets.size();
    orient_shells(mesh, report.shells);
    measure_facets(mesh, threads, own_above);
    for (const Facet& facet : mesh.facets)
        for (const std::uint32_t v : facet) report.bounds.add(mesh.vertices[v]);
    const Vec3 middle = report.bounds.min + 0.5 * (report.bounds.max - report.bounds.min);
    for (std::size_t f = 0; f < mesh.facets.size(); ++f)
    {
        report.volume += volume_times_six(mesh, f, middle) / 6;
        report.area += mesh.areas[f];
    }
    judge_edges(mesh, report);
}

void connect_facets(SurfaceMesh& mesh, double own_above, int threads)
{
    build_edges(mesh, threads);
    measure_facets(mesh, threads, own_above);
}

} // namespace fppg
