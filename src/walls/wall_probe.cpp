#include "walls/wall_probe.h"

#include "meshes/facing_distance.h"
#include "offset/middle.h"
#include "offset/wall_depth.h"
#include "walls/merged_sheet.h"

#include <cmath>
#include <ctime>

namespace fppg
{
namespace
{

constexpr std::size_t places = 256;
/// Directions of the depth whose cosine is less turn by more than 8 degrees, as in
/// offset/creases.cpp, over this length, dp.
constexpr double rough_turn = 0.99;
constexpr double rough_step_dp = 0.5;
/// A layer is where the depth is right to this, dp.
constexpr double at_depth_dp = 1e-3;

/// Of the processor, which other programs take no part of.
double seconds_since(std::clock_t start)
{
    return static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
}

} // namespace

WallProbe probe_wall(const SurfaceMesh& mesh, const MeshReport& report,
                     const WallProbeOptions& options, int threads)
{
    WallProbe out;
    std::vector<double> depths;
    for (const double depth_dp : options.depths_dp)
        if (depth_dp > 0) depths.push_back(depth_dp * options.dp);
    if (depths.empty() || mesh.facets.empty()) return out;
    const WallDepth wall(mesh, report, options.is_closed, WallSide::Behind,
                         options.feature_angle_deg, threads);
    const std::vector<FacetSpot> points = even_places(mesh, places);
    wall.at(points[0].place); // makes the tree
    std::size_t in_layer = 0, turned = 0;
    std::clock_t start = std::clock();
    for (std::size_t i = 0; i < points.size(); ++i)
    {
        const Vec3& normal = mesh.normals[points[i].facet];
        const double depth = depths[i % depths.size()];
        const Vec3 p = points[i].place - depth * normal;
        const Vec3& a = mesh.vertices[mesh.facets[points[i].facet][0]];
        const Vec3 along = mesh.vertices[mesh.facets[points[i].facet][1]] - a;
        const DepthPlace here = wall.at(p);
        const DepthPlace there =
            wall.at(p + (rough_step_dp * options.dp / std::max(norm(along), 1e-300)) * along);
        if (std::fabs(here.depth - depth) > at_depth_dp * options.dp) continue;
        ++in_layer;
        turned += dot(here.direction, there.direction) < rough_turn ? 1 : 0;
    }
    out.seconds_a_depth = seconds_since(start) / static_cast<double>(2 * points.size());
    if (in_layer > 0) out.rough = static_cast<double>(turned) / static_cast<double>(in_layer);
    if (!options.is_closed) return out;
    start = std::clock();
    for (const FacetSpot& point : points)
        touching_ball(wall, point.place, mesh.normals[point.facet], depths.back());
    out.seconds_a_ball = seconds_since(start) / static_cast<double>(points.size());
    out.balls = samples_of_thin_parts(mesh, options.dp, threads);
    return out;
}

} // namespace fppg
