// What laying layers will cost, tried at a few places of a wall.

#include "walls/wall_probe.h"

#include "meshes/test_shapes.h"

#include <gtest/gtest.h>

#include <cmath>

namespace fppg
{
namespace
{

WallProbe probe(const TriangleSoup& soup)
{
    MeshReport report;
    const SurfaceMesh mesh = repair_mesh(soup, {}, 1, report);
    WallProbeOptions options;
    options.depths_dp = {0.5, 1.5};
    options.dp = 0.05;
    options.is_closed = true;
    return probe_wall(mesh, report, options, 1);
}

TEST(WallProbe, TellsRoughWallsFromSmoothOnes)
{
    const TriangleSoup smooth = test::sphere(5);
    TriangleSoup bumpy = smooth;
    for (Vec3& v : bumpy.vertices)
        v = (1 + 0.02 * std::sin(40 * v.x) * std::sin(40 * v.y) * std::sin(40 * v.z)) * v;
    EXPECT_LT(probe(smooth).rough, 0.02);
    EXPECT_GT(probe(bumpy).rough, 0.2);
}

TEST(WallProbe, CountsTheBallsThatAreAskedForByAreaNotByFacets)
{
    const double few = probe(test::sphere(4)).balls;
    const double many = probe(test::sphere(7)).balls;
    EXPECT_GT(few, 0);
    // 64 times as many facets.
    EXPECT_LT(many, 12 * few);
}

} // namespace
} // namespace fppg
