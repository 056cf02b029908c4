#include "batch/layer_counts.h"

#include <algorithm>
#include <cmath>

namespace fppg
{
namespace
{

/// 1 where the surface bends away from its normals at an edge of two facets, else -1.
double bend_sign(const SurfaceMesh& mesh, std::size_t e)
{
    const auto [f, g] = mesh.edge_facets[e];
    const auto middle = [&](std::uint32_t facet)
    {
        Vec3 sum;
        for (const std::uint32_t v : mesh.facets[facet]) sum = sum + mesh.vertices[v];
        return sum / 3;
    };
    return dot(middle(g) - middle(f), mesh.normals[f]) < 0 ? 1 : -1;
}

} // namespace

double layers_of(const std::vector<double>& depths_dp, const MeshReport& report, double dp)
{
    const double radius =
        report.is_watertight && report.area > 0 ? 3 * std::abs(report.volume) / report.area : 0;
    double out = 0;
    for (const double depth_dp : depths_dp)
    {
        if (depth_dp == 0) continue;
        const double left = radius > 0 ? std::max(0.0, 1 - depth_dp * dp / radius) : 1;
        out += left * left;
    }
    return out;
}

double layers_outside(const std::vector<double>& depths_dp, const SurfaceMesh& mesh, double dp)
{
    double area = 0;
    for (const double a : mesh.areas) area += a;
    double bends = 0; // length times bend, inwards or outwards
    for (std::size_t e = 0; e < mesh.edges.size(); ++e)
    {
        const auto [f, g] = mesh.edge_facets[e];
        if (g == no_index || mesh.is_manifold[e] == 0) continue;
        const Vec3& a = mesh.vertices[mesh.edges[e][0]];
        const Vec3& b = mesh.vertices[mesh.edges[e][1]];
        const Vec3 turn = cross(mesh.normals[f], mesh.normals[g]);
        const double cosine = dot(mesh.normals[f], mesh.normals[g]);
        // 2 tan(bend / 2), of a bend of at most 150 degrees.
        const double bend = 2 * norm(turn) / std::max(1 + cosine, 0.13);
        bends += norm(b - a) * bend * bend_sign(mesh, e);
    }
    double out = 0;
    for (const double depth_dp : depths_dp)
        if (depth_dp > 0) out += 1 + depth_dp * dp * std::abs(bends) / area;
    return out;
}

} // namespace fppg
