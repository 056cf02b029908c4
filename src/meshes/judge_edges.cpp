#include "meshes/judge_edges.h"

#include <vector>

#include <fmt/format.h>

#include "core/text.h"
#include "meshes/edge_map.h"
#include "meshes/warning_words.h"

namespace fppg
{

namespace
{

Vec3 middle_of_edge(const SurfaceMesh& mesh, std::size_t e)
{
    return 0.5 * (mesh.vertices[mesh.edges[e][0]] + mesh.vertices[mesh.edges[e][1]]);
}

} // namespace

void judge_edges(const SurfaceMesh& mesh, MeshReport& report)
{
    std::vector<int> balance(mesh.edges.size(), 0);
    for (std::size_t f = 0; f < mesh.facets.size(); ++f)
        for (std::size_t s = 0; s < 3; ++s)
            balance[mesh.facet_edges[f][s]] += runs_upwards(mesh, f, s) ? 1 : -1;
    Vec3 open_at, many_at, clash_at;
    report.is_watertight = true;
    for (std::size_t e = mesh.edges.size(); e-- > 0;)
    {
        if (balance[e] != 0) report.is_watertight = false;
        if (is_open(mesh, e))
        {
            ++report.open_edges;
            open_at = middle_of_edge(mesh, e);
        }
        else if (mesh.is_manifold[e] == 0)
        {
            ++report.non_manifold_edges;
            many_at = middle_of_edge(mesh, e);
        }
        else if (balance[e] != 0)
        {
            ++report.clashing_edges;
            clash_at = middle_of_edge(mesh, e);
        }
    }
    if (report.open_edges > 0)
        report.warnings.push_back(fmt::format(
            "The surface is open: {}, the first {}.",
            counted(report.open_edges, "edge has one facet only", "edges have one facet only"),
            near(open_at)));
    if (report.non_manifold_edges > 0)
        report.warnings.push_back(fmt::format("More than two facets meet at {}, the first {}.",
                                              counted(report.non_manifold_edges, "edge", "edges"),
                                              near(many_at)));
    if (report.clashing_edges > 0)
        report.warnings.push_back(
            fmt::format("A part has one side only, as a Moebius strip: {}, the first {}.",
                        counted(report.clashing_edges, "edge has facets that face opposite ways",
                                "edges have facets that face opposite ways"),
                        near(clash_at)));
}

} // namespace fppg
