#include "offset/offset_surface.h"

#include "meshes/test_shapes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace fppg
{
namespace
{

constexpr double dp = 0.1;

struct Wall
{
    SurfaceMesh mesh;
    MeshReport report;

    explicit Wall(const TriangleSoup& soup) { mesh = repair_mesh(soup, {}, 1, report); }
    WallDepth depth(bool is_solid, WallSide side = WallSide::Behind) const
    {
        return WallDepth(mesh, report, is_solid, side, 30, 1);
    }
};

OffsetSurface at_depth(const WallDepth& wall, double depth, int threads = 1,
                       OffsetOptions options = {})
{
    options.depth = depth;
    options.dp = dp;
    options.cell = 0.5 * dp;
    return offset_surface(wall, options, threads);
}

double crease_length(const OffsetSurface& surface)
{
    double length = 0;
    for (const FeatureLine& line : offset_features(surface, {.dp = dp}).lines)
        length += line.length;
    return length;
}

TriangleSoup cube(double half)
{
    return test::box({-half, -half, -half}, {half, half, half});
}

TEST(OffsetSurface, OfABoxIsASmallerBoxWithItsEdgesAndCorners)
{
    const Wall wall(cube(1));
    const WallDepth depth = wall.depth(true);
    for (const double d : {0.05, 0.15, 0.25})
    {
        const OffsetSurface surface = at_depth(depth, d);
        const double side = 2 - 2 * d;
        EXPECT_NEAR(surface.report.area, 6 * side * side, 1e-9);
        EXPECT_NEAR(surface.report.volume, side * side * side, 1e-9);
        EXPECT_EQ(surface.report.open_edges, 0);
        const Features features = offset_features(surface, {.dp = dp});
        EXPECT_EQ(features.lines.size(), 12);
        EXPECT_EQ(features.singular.size(), 8);
        EXPECT_NEAR(crease_length(surface), 12 * side, 1e-9);
    }
}

/// What is made of them costs by facets.
TEST(OffsetSurface, OfLargeFlatSidesHasFewFacetsWithoutCracks)
{
    const TriangleSoup upright = test::box({0, 0, 0}, {8, 6, 4});
    TriangleSoup turned = upright;
    for (Vec3& v : turned.vertices)
        v = {0.8 * v.x - 0.6 * v.y, 0.48 * v.x + 0.64 * v.y - 0.6 * v.z,
             0.36 * v.x + 0.48 * v.y + 0.8 * v.z};
    const double all = 2 * (7.7 * 5.7 + 5.7 * 3.7 + 3.7 * 7.7);
    for (const TriangleSoup& soup : {upright, turned})
    {
        const Wall wall(soup);
        const WallDepth depth = wall.depth(true);
        const OffsetSurface surface = at_depth(depth, 0.15);
        EXPECT_EQ(surface.report.open_edges, 0);
        EXPECT_NEAR(surface.report.area / all, 1, 1e-3);
        EXPECT_NEAR(surface.report.volume / (7.7 * 5.7 * 3.7), 1, 1e-3);
        OffsetOptions fine;
        fine.keeps_facets = true;
        const OffsetSurface cut = at_depth(depth, 0.15, 1, fine);
        EXPECT_LT(3 * surface.mesh.facets.size(), cut.mesh.facets.size());
        EXPECT_NEAR(crease_length(surface), crease_length(cut), 1e-9);
        for (const Vec3& normal : surface.mesh.normals) EXPECT_NEAR(norm(normal), 1, 1e-9);
    }
}

/// Behind an edge that runs into the wall the surfaces of one depth keep it.
TEST(OffsetSurface, OfACavityIsALargerBoxWithItsEdgesAndCorners)
{
    const Wall wall(test::joined(cube(2), test::inverted(cube(1))));
    const WallDepth depth = wall.depth(true);
    for (const double d : {0.05, 0.15, 0.25})
    {
        const OffsetSurface surface = at_depth(depth, d);
        const double outer = 4 - 2 * d;
        const double inner = 2 + 2 * d;
        EXPECT_EQ(surface.report.open_edges, 0);
        EXPECT_NEAR(surface.report.area / (6 * (outer * outer + inner * inner)), 1, 1e-4);
        EXPECT_NEAR(crease_length(surface) / (12 * (outer + inner)), 1, 1e-3);
    }
}

/// Turned against the grid that they are cut from, creases and their corners stick out into cells
/// none of whose edges they meet.
TEST(OffsetSurface, OfTurnedBoxesHasTheirEdgesAndCorners)
{
    for (const double angle : {0.4, 0.9, 2.1})
    {
        const auto turned = [&](const Vec3& p)
        {
            const Vec3 q{std::cos(angle) * p.x - std::sin(angle) * p.y,
                         std::sin(angle) * p.x + std::cos(angle) * p.y, p.z};
            return Vec3{q.x, std::cos(2 * angle) * q.y - std::sin(2 * angle) * q.z,
                        std::sin(2 * angle) * q.y + std::cos(2 * angle) * q.z};
        };
        for (const bool is_cavity : {false, true})
        {
            TriangleSoup soup =
                is_cavity ? test::joined(cube(1), test::inverted(cube(0.5))) : cube(0.6);
            for (Vec3& v : soup.vertices) v = turned(v);
            const Wall wall(soup);
            const WallDepth depth = wall.depth(true);
            for (const double d : {0.05, 0.15})
            {
                const OffsetSurface surface = at_depth(depth, d);
                const double outer = is_cavity ? 2 - 2 * d : 1.2 - 2 * d;
                const double inner = is_cavity ? 1 + 2 * d : 0;
                EXPECT_EQ(surface.report.open_edges, 0);
                EXPECT_NEAR(surface.report.area / (6 * (outer * outer + inner * inner)), 1, 1.5e-3);
                EXPECT_NEAR(crease_length(surface) / (12 * (outer + inner)), 1, 0.08);
            }
        }
    }
}

/// Facets folded back onto their neighbours, as slivers of CAD programs are, look the other way.
TEST(OffsetSurface, OfABoxWithAFoldInItsFloorIsThatOfABox)
{
    const std::array<Vec3, 6> outline{
        {{0.6, 0, 0}, {0.5, 0, 0}, {1, 0, 0}, {1, 0, 0.9}, {0, 0, 0.9}, {0, 0, 0}}};
    const Vec3 width{0, 1, 0};
    TriangleSoup soup;
    const auto add = [&](const Vec3& a, const Vec3& b, const Vec3& c) {
        soup.vertices.insert(soup.vertices.end(), {a, b, c});
    };
    for (std::size_t i = 0; i < outline.size(); ++i)
    {
        const Vec3& a = outline[i];
        const Vec3& b = outline[(i + 1) % outline.size()];
        add(a, a + width, b);
        add(b, a + width, b + width);
        if (i == 3 || i == 4) continue;
        add(outline[4], a, b);
        add(outline[4] + width, b + width, a + width);
    }
    const Wall wall(soup);
    ASSERT_TRUE(wall.report.is_watertight);
    const WallDepth depth = wall.depth(true);
    for (double x = 0.41; x < 0.7; x += 0.02)
        for (const double z : {-0.1, -0.05, 0.05, 0.1})
            EXPECT_DOUBLE_EQ(depth.at({x, 0.53, z}).depth, z);
    for (const double d : {0.05, 0.15, 0.25, 0.35})
    {
        const OffsetSurface surface = at_depth(depth, d);
        EXPECT_EQ(surface.report.open_edges, 0) << d;
        EXPECT_NEAR(surface.report.volume, (1 - 2 * d) * (1 - 2 * d) * (0.9 - 2 * d), 1e-3) << d;
        for (const Vec3& v : surface.mesh.vertices)
            EXPECT_GT(std::min({v.x, 1 - v.x, v.y, 1 - v.y, v.z, 0.9 - v.z}), d - 0.01) << d;
    }
}

TEST(OffsetSurface, OfASphereIsASmoothSphere)
{
    const Wall wall(test::sphere(5));
    const WallDepth depth = wall.depth(true);
    const OffsetSurface surface = at_depth(depth, 0.15);
    const double radius = 0.85;
    EXPECT_NEAR(surface.report.area / (4 * std::numbers::pi * radius * radius), 1, 0.01);
    EXPECT_TRUE(surface.creases.empty());
    for (const Vec3& v : surface.mesh.vertices)
    {
        EXPECT_NEAR(depth.at(v).depth, 0.15, 0.02 * dp);
        EXPECT_NEAR(depth.at(project_to_depth(depth, v, 0.15)).depth, 0.15, 1e-9);
    }
}

TEST(OffsetSurface, EndsWhereABodyIsNoDeeper)
{
    const Wall wall(test::box({0, 0, 0}, {2, 2, 0.3}));
    const WallDepth depth = wall.depth(true);
    EXPECT_FALSE(at_depth(depth, 0.05).mesh.facets.empty());
    EXPECT_TRUE(at_depth(depth, 0.16).mesh.facets.empty());
}

TEST(OffsetSurface, OfASheetStandsOnTheSideAskedForAndEndsWithIt)
{
    TriangleSoup soup;
    test::add_quad(soup, {0, 0, 0}, {1, 0, 0.5}, {1, 1, 0.5}, {0, 1, 0});
    const Wall wall(soup);
    const Vec3 up = wall.mesh.normals[0];
    const double area = std::hypot(1, 0.5);
    for (const WallSide side : {WallSide::Behind, WallSide::Front})
    {
        const WallDepth depth = wall.depth(false, side);
        const OffsetSurface surface = at_depth(depth, 0.15);
        const double way = side == WallSide::Behind ? -0.15 : 0.15;
        for (const Vec3& v : surface.mesh.vertices) EXPECT_NEAR(dot(v, up), way, 1e-6);
        EXPECT_NEAR(surface.report.area, area, 0.02 * area);
    }
}

TEST(OffsetSurface, HasTheSameBytesWithAnyNumberOfThreads)
{
    const Wall wall(cube(1));
    const WallDepth depth = wall.depth(true);
    const OffsetSurface one = at_depth(depth, 0.05, 1);
    const OffsetSurface four = at_depth(depth, 0.05, 4);
    EXPECT_EQ(one.mesh.vertices, four.mesh.vertices);
    EXPECT_EQ(one.mesh.facets, four.mesh.facets);
    EXPECT_EQ(one.creases, four.creases);
}

TEST(WallDepth, IsTheLargestDistanceToThePlanesAtAnEdgeThatRunsIntoTheWall)
{
    const Wall wall(test::joined(cube(2), test::inverted(cube(1))));
    const WallDepth depth = wall.depth(true);
    const DepthPlace at_edge = depth.at({1.1, 1.2, 0});
    EXPECT_NEAR(at_edge.depth, 0.2, 1e-12);
    EXPECT_EQ(at_edge.nearest, (Vec3{1, 1, 0}));
    EXPECT_NEAR(depth.at({1.1, 1.2, 1.3}).depth, 0.3, 1e-12);
    EXPECT_NEAR(depth.at({0.9, 0, 0}).depth, -0.1, 1e-12);
}

TEST(ProjectToCrease, FindsTheLineUnderTwoFaces)
{
    const Wall wall(cube(1));
    const WallDepth depth = wall.depth(true);
    const Vec3 on =
        project_to_crease(depth, {0.86, 0.83, 0.1}, 0.15, dp, {{0.85, 0.7, 0.1}, {0.7, 0.85, 0.1}});
    EXPECT_NEAR(on.x, 0.85, 1e-9);
    EXPECT_NEAR(on.y, 0.85, 1e-9);
    EXPECT_NEAR(on.z, 0.1, 1e-9);
}

} // namespace
} // namespace fppg
