#include "meshes/point_grid.h"
#include "offset/wall_depth.h"
#include "walls/layered_drawing.h"

#include <gtest/gtest.h>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

namespace fppg
{
namespace
{

using test::Drawing;
using test::layered;
using test::normals_of;
using test::relaxed;
using Normals = test::WallNormals;

constexpr double dp = Drawing::dp;
const double kernel = test::kernel_reach;

/// Of a box, positive inside.
double depth_in_box(const Vec3& p, const Vec3& low, const Vec3& size)
{
    double depth = 1e9;
    for (int axis = 0; axis < 3; ++axis)
        depth = std::min({depth, p[axis] - low[axis], low[axis] + size[axis] - p[axis]});
    return depth;
}

TEST(WallLayers, StandAtTheirDepthsAndNoneOnTheSurface)
{
    Drawing drawing = layered();
    const Vec3 low{-0.93, -0.77, -0.85};
    const Vec3 size{1.8, 1.5, 1.6};
    drawing.box(low, size);
    const RunField field = relaxed(drawing);
    std::map<int, int> count;
    for (const Vec3& p : field.walls.particles.positions)
    {
        const double layer = depth_in_box(p, low, size) / dp - 0.5;
        EXPECT_NEAR(layer, std::round(layer), 1e-6);
        ++count[static_cast<int>(std::lround(layer))];
    }
    ASSERT_EQ(count.size(), 3);
    for (const auto& [layer, particles] : count)
    {
        const Vec3 s = size - (2 * layer + 1) * dp * Vec3{1, 1, 1};
        const double area = 2 * (s.x * s.y + s.y * s.z + s.z * s.x) / (dp * dp);
        EXPECT_NEAR(particles / area, 1, 0.04) << "layer " << layer;
    }
}

TEST(WallLayers, AndTheNodesUnderThemHaveTheVolumeOfTheBody)
{
    Drawing drawing = layered();
    const Vec3 low{-0.93, -0.77, -0.85};
    const Vec3 size{1.8, 1.5, 1.6};
    drawing.box(low, size);
    const Normals all = normals_of(drawing, relaxed(drawing));
    EXPECT_NEAR(
        static_cast<double>(all.positions.size()) * std::pow(dp, 3) / (size.x * size.y * size.z), 1,
        0.015);
    for (const Vec3& p : all.positions) EXPECT_GT(depth_in_box(p, low, size), 0.499 * dp);
    PointGrid grid(0.6 * dp, all.positions.size());
    for (const Vec3& p : all.positions)
    {
        EXPECT_FALSE(grid.has_nearer(p, 0.6 * dp));
        grid.add(p);
    }
}

TEST(WallLayers, LookFromEachParticleToTheNearestPlaceOfTheSurface)
{
    Drawing drawing = layered();
    const Vec3 low{-0.93, -0.77, -0.85};
    const Vec3 size{1.8, 1.5, 1.6};
    drawing.box(low, size);
    const Normals all = normals_of(drawing, relaxed(drawing));
    ASSERT_EQ(all.normals.size(), all.positions.size());
    for (std::size_t i = 0; i < all.normals.size(); ++i)
    {
        const double depth = depth_in_box(all.positions[i], low, size);
        if (depth > kernel - 0.5 * dp) continue;
        EXPECT_NEAR(norm(all.normals[i]), depth, 1e-6);
        EXPECT_NEAR(depth_in_box(all.positions[i] + all.normals[i], low, size), 0, 1e-6);
    }
}

/// A plate of one dp has one layer, in its middle, where the number of layers is given; fluid goes
/// through one, so else the plate is thickened to two dp, which have one layer a side.
TEST(WallLayers, OfAThinPlateAreOneThatBothSidesShareOrTheTwoOfAThickerOne)
{
    const Vec3 low{-0.93, -0.77, -0.03};
    const Vec3 size{1.8, 1.5, dp};
    for (const bool is_given : {true, false})
    {
        Drawing drawing = layered();
        if (is_given) drawing.def.fit.all->layers = 3;
        drawing.box(low, size);
        const RunField field = relaxed(drawing);
        const WallParticles& particles = field.walls.particles;
        const double sheets = is_given ? 1 : 2;
        EXPECT_NEAR(static_cast<double>(particles.size()) / (sheets * 18 * 15), 1, 0.1);
        double of_upper = 0;
        for (const Vec3& p : particles.positions)
        {
            EXPECT_NEAR(std::abs(p.z - (low.z + dp / 2)), is_given ? 0 : dp / 2, 1e-9);
            EXPECT_NEAR(p.x, low.x + size.x / 2, size.x / 2 - 0.45 * dp);
            EXPECT_NEAR(p.y, low.y + size.y / 2, size.y / 2 - 0.45 * dp);
            of_upper += p.z > low.z + dp / 2 ? 1 : 0;
        }
        const std::string said =
            fmt::format("walls of {} m with fluid on both sides", is_given ? "0.1" : "0.2");
        drawing.fill({0, 0, 1.5});
        const Normals all = normals_of(drawing, relaxed(drawing));
        EXPECT_NE(
            std::find_if(all.report.warnings.begin(), all.report.warnings.end(),
                         [&](const std::string& w) { return w.find(said) != std::string::npos; }),
            all.report.warnings.end());
        if (is_given) continue;
        EXPECT_NEAR(of_upper / static_cast<double>(particles.size()), 0.5, 0.02);
    }
}

/// Nodes of the lattice filled the gap between layers, where there were any midway; fluid on a wall
/// that lacks particles is pressed against it.
TEST(WallLayers, OfPlatesHaveOneMoreBetweenThemWhereThereIsRoomForOne)
{
    for (const double thickness : {2.7, 3.2, 3.5, 4.7, 5.2})
    {
        const Vec3 low{-0.93, -0.77, -0.13};
        const Vec3 size{1.8, 1.5, thickness * dp};
        Drawing drawing = layered();
        drawing.box(low, size);
        const std::vector<Vec3> all = normals_of(drawing, relaxed(drawing)).positions;
        EXPECT_NEAR(static_cast<double>(all.size()) * std::pow(dp, 3) / (size.x * size.y * size.z),
                    1, 0.06) // three rows in 3.2 dp
            << thickness;
        std::vector<double> heights;
        for (const Vec3& p : all)
            if (std::abs(p.x) < 0.4 && std::abs(p.y) < 0.4) heights.push_back((p.z - low.z) / dp);
        std::sort(heights.begin(), heights.end());
        double widest = 0;
        for (std::size_t i = 1; i < heights.size(); ++i)
            widest = std::max(widest, heights[i] - heights[i - 1]);
        EXPECT_LT(widest, 1.3) << thickness;
        EXPECT_NEAR(heights.front(), 0.5, 1e-6);
        EXPECT_NEAR(heights.back(), thickness - 0.5, 1e-6);
    }
}

/// Nodes half a dp from both the layer that the sides share and the next one stood among them.
TEST(WallLayers, OfPlatesThatShareOneHaveNoNodesBetweenThem)
{
    for (const int thickness : {3, 5})
    {
        Drawing drawing = layered();
        drawing.box({-0.93, -0.77, 0}, {1.8, 1.5, thickness * dp});
        const std::vector<Vec3> all = normals_of(drawing, relaxed(drawing)).positions;
        EXPECT_NEAR(static_cast<double>(all.size()) * dp * dp / (1.8 * 1.5 * thickness), 1, 0.02);
        std::size_t beside_layers = 0;
        for (const Vec3& p : all)
        {
            const double layer = p.z / dp - 0.5;
            beside_layers += std::abs(p.x) < 0.4 && std::abs(p.y) < 0.4 &&
                                     std::abs(layer - std::round(layer)) > 0.01
                                 ? 1
                                 : 0;
        }
        EXPECT_LE(beside_layers, 2u) << thickness; // of 64 nodes a row
    }
}

TEST(WallLayers, OfPlatesIn2DHaveOneMoreBetweenThemToo)
{
    for (const double thickness : {2.6, 3.2, 3.5})
    {
        Drawing drawing = layered(true);
        drawing.box({-0.93, -1, -0.13}, {1.8, 2, thickness * dp});
        const std::vector<Vec3> all = normals_of(drawing, relaxed(drawing)).positions;
        EXPECT_NEAR(static_cast<double>(all.size()) * dp / (1.8 * thickness), 1, 0.05) << thickness;
    }
}

/// Those of DBC begin on the surface and stand for half a dp before it.
TEST(WallLayers, OfPlatesForDbcHaveOneMoreBetweenThemToo)
{
    for (const double thickness : {1.7, 2.2, 3.6, 4.0})
    {
        const Vec3 low{-0.93, -0.77, -0.13};
        Drawing drawing = layered();
        drawing.def.fit.all->boundary = WallBoundary::Dbc;
        drawing.def.fit.all->depths_dp = {0, 1, 2};
        drawing.box(low, {1.8, 1.5, thickness * dp});
        std::vector<double> heights;
        for (const Vec3& p : normals_of(drawing, relaxed(drawing)).positions)
            if (std::abs(p.x) < 0.4 && std::abs(p.y) < 0.4) heights.push_back((p.z - low.z) / dp);
        EXPECT_NEAR(static_cast<double>(heights.size()) * dp * dp / (0.8 * 0.8), thickness + 1, 0.3)
            << thickness;
        std::sort(heights.begin(), heights.end());
        double widest = 0;
        for (std::size_t i = 1; i < heights.size(); ++i)
            widest = std::max(widest, heights[i] - heights[i - 1]);
        EXPECT_LT(widest, 1.3) << thickness;
    }
}

/// However thin they are, and rods, of which nothing was left. Plates with room for two layers stay
/// as they are.
TEST(WallLayers, OfPlatesAndRodsWithRoomForOneAreThickened)
{
    struct Shape
    {
        Vec3 size;
        std::array<double, 2> heights; ///< least and largest of the particles, dp from the middle
    };
    for (const Shape& shape :
         {Shape{{1.8, 1.5, 0}, {-0.5, 0.5}}, Shape{{1.8, 1.5, 0.3 * dp}, {-0.5, 0.5}},
          Shape{{1.8, 1.5, 1.59 * dp}, {-0.5, 0.5}}, Shape{{1.8, 1.5, 1.7 * dp}, {-0.35, 0.35}},
          Shape{{1.8, dp, dp}, {-0.5, 0.5}}})
    {
        Drawing drawing = layered();
        drawing.box({-0.93, -0.77, -0.03}, shape.size);
        const double middle = -0.03 + shape.size.z / 2;
        double least = 1e9;
        double most = -1e9;
        for (const Vec3& p : relaxed(drawing).walls.particles.positions)
        {
            least = std::min(least, (p.z - middle) / dp);
            most = std::max(most, (p.z - middle) / dp);
        }
        EXPECT_NEAR(least, shape.heights[0], 1e-6) << shape.size.z;
        EXPECT_NEAR(most, shape.heights[1], 1e-6) << shape.size.z;
    }
}

/// Fluid in a tank of walls of 4 dp: particles nearer to the outside look to the inside too.
TEST(WallLayers, LookToTheSideThatFluidCanTouch)
{
    Drawing drawing = layered();
    const Vec3 low{-1.05, -1.05, -1.05};
    const Vec3 size{2.1, 2.1, 2.1};
    drawing.box(low, size);
    const Vec3 inner{-0.65, -0.65, -0.65};
    const Vec3 inner_size{1.3, 1.3, 1.3};
    BooleanDef boolean;
    boolean.line = 8;
    boolean.parts = {{0, false}, {1, false}};
    boolean.tree.op = BooleanOp::Difference;
    for (const std::uint32_t part : {0u, 1u})
    {
        BooleanNode leaf;
        leaf.part = part;
        boolean.tree.operands.push_back(leaf);
    }
    drawing.box(inner, inner_size);
    drawing.def.booleans.push_back(boolean);
    drawing.fill({0, 0, 0}, 0.3);
    const Normals all = normals_of(drawing, relaxed(drawing));
    std::size_t within_reach = 0;
    for (std::size_t i = 0; i < all.normals.size(); ++i)
    {
        const double to_inside = -depth_in_box(all.positions[i], inner, inner_size);
        if (to_inside > kernel - 0.5 * dp) continue;
        ++within_reach;
        EXPECT_NEAR(depth_in_box(all.positions[i] + all.normals[i], inner, inner_size), 0, 1e-5);
    }
    EXPECT_GT(within_reach, 3000);
    EXPECT_TRUE(all.report.warnings.empty());
}

std::size_t count_fluid(const RunField& field)
{
    const std::vector<std::uint16_t>& moved = field.walls.volume.mk;
    auto count =
        static_cast<std::size_t>(std::count(moved.begin(), moved.end(), Drawing::fluid_mk));
    for (const std::vector<Run>& slab : field.slabs)
        for (const auto& run : slab)
            if (run.mk == Drawing::fluid_mk && !run.is_covered) count += run.z_end - run.z_begin;
    return count;
}

/// A tank of drawn sides, with and without a lid: no wall is in the room of the fluid, whose volume
/// is that of the tank up to its level.
TEST(WallLayers, OfATankStandOutsideIt)
{
    const Vec3 low{-0.42, -0.43, -0.96};
    const Vec3 size{0.79, 0.97, 1.9};
    constexpr double level = -0.05; // half a step above the last nodes
    for (const bool has_lid : {false, true})
        for (const double first : {0.0, 0.5})
        {
            Drawing drawing = layered();
            drawing.def.fit.all->depths_dp = {first, first + 1, first + 2};
            drawing.draw(
                make_box(low, size, {true, has_lid, true, true, true, true}, false, {}, dp)[0]);
            drawing.fill({0, 0, -0.5}, level);
            drawing.fluid_band();
            const RunField field = relaxed(drawing);
            for (const Vec3& p : field.walls.particles.positions)
                EXPECT_LT(depth_in_box(p, low, size), 1e-6) << has_lid << first;
            if (first == 0) continue;
            const double volume = size.x * size.y * (level - low.z);
            EXPECT_NEAR(static_cast<double>(count_fluid(field)), volume / std::pow(dp, 3),
                        0.005 * volume / std::pow(dp, 3))
                << has_lid;
        }
}

TEST(WallLayers, AreLinesIn2D)
{
    Drawing drawing = layered(true);
    const Vec3 low{-0.93, -1, -0.85};
    const Vec3 size{1.8, 2, 1.6};
    drawing.box(low, size);
    const Normals all = normals_of(drawing, relaxed(drawing));
    EXPECT_NEAR(static_cast<double>(all.positions.size()) * dp * dp / (size.x * size.z), 1, 0.02);
    for (std::size_t i = 0; i < all.positions.size(); ++i)
    {
        Vec3 p = all.positions[i];
        EXPECT_EQ(p.y, 0);
        const double depth = depth_in_box(p, low, size) / dp;
        EXPECT_GT(depth, 0.499);
        if (depth < 2)
        {
            EXPECT_NEAR(depth - 0.5, std::round(depth - 0.5), 1e-6);
        }
    }
}

TEST(WallLayers, OfAPlateIn2DWithoutRoomForNodesHaveNone)
{
    Drawing drawing = layered(true);
    drawing.box({-0.93, -1, -0.04}, {1.8, 2, 0.4});
    const RunField field = relaxed(drawing);
    EXPECT_NEAR(static_cast<double>(field.walls.particles.size()), 1.8 * 0.4 / (dp * dp), 6);
    EXPECT_EQ(field.walls.volume.size(), 0U);
}

/// Under DBC, where the first stands on the surface, with half of its volume outside.
TEST(WallLayers, StandForTheVolumeOfTheBodyHalfAsMuchOnItsSurface)
{
    Drawing drawing = layered();
    drawing.def.fit.all->boundary = WallBoundary::Dbc;
    drawing.def.fit.all->depths_dp = {0, 1, 2};
    drawing.box({-0.93, -0.77, -0.85}, {1.8, 1.5, 1.6});
    const RunField field = relaxed(drawing);
    const FittedBody& body = field.walls.bodies[0];
    EXPECT_NEAR(body.share, 0.5 * body.layer_share, 1e-12);
    double volume = body.measures.node_volume;
    for (const std::uint32_t b : field.walls.particles.bodies)
        volume += (b == 0 ? body.share : body.layer_share) * dp * dp * dp;
    EXPECT_NEAR(volume / (1.8 * 1.5 * 1.6), 1, 1e-9);
}

TEST(WallLayers, HaveTheSameBytesWithAnyNumberOfThreads)
{
    Drawing drawing = layered();
    drawing.box({-0.93, -0.77, -0.85}, {1.8, 1.5, 1.6});
    EXPECT_EQ(relaxed(drawing, 1).walls.particles.positions,
              relaxed(drawing, 4).walls.particles.positions);
}

} // namespace
} // namespace fppg
