// What laying layers will cost, tried at a few places of a wall.

#include "walls/wall_probe.h"

#include "meshes/small_pieces.h"
#include "meshes/test_shapes.h"

#include <gtest/gtest.h>

#include <array>
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
    // 16 to 64 times as many facets.
    EXPECT_LT(many, 12 * few);
}

TEST(PointsOn, AreSpreadByArea)
{
    MeshReport report;
    const SurfaceMesh box = repair_mesh(test::box({0, 0, 0}, {4, 2, 1}), {}, 1, report);
    std::array<int, 3> across{};
    for (const SurfacePoint& point : points_on(box, 2800))
    {
        const Vec3& normal = box.normals[point.facet];
        for (int axis = 0; axis < 3; ++axis)
            if (std::fabs(normal[axis]) > 0.5)
            {
                ++across[static_cast<std::size_t>(axis)];
                EXPECT_NEAR(dot(point.position - box.vertices[box.facets[point.facet][0]], normal),
                            0, 1e-12);
            }
    }
    EXPECT_NEAR(across[0], 400, 4);
    EXPECT_NEAR(across[1], 800, 4);
    EXPECT_NEAR(across[2], 1600, 4);
}

} // namespace
} // namespace fppg
