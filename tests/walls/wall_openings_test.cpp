#include "helpers/drawing.h"
#include "layered_drawing.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace fppg::test
{
namespace
{

constexpr double dp = Drawing::dp;
const Vec3 low{-1.0, -1.0, -1.0};
const Vec3 size{2.0, 2.0, 1.5};

/// A tank without a lid, of sheets with layers from a depth on; 0: of DBC.
Drawing tank(double first)
{
    Drawing drawing = layered();
    drawing.def.fit.all->depths_dp = {first, first + 1, first + 2};
    drawing.draw(make_box(low, size, {true, false, true, true, true, true}, false, {}, dp)[0]);
    return drawing;
}

/// Particles of the floor, in the middle of the tank and not below it.
std::vector<Vec3> floor_of(const RunField& field, double half_width)
{
    std::vector<Vec3> out;
    for (const Vec3& p : field.walls.particles.positions)
        if (std::abs(p.x) < half_width && std::abs(p.y) < half_width && p.z < low.z + 0.01 * dp)
            out.push_back(p);
    return out;
}

class Openings : public testing::TestWithParam<double>
{
};

/// The hole of an outlet, drawn as a face in the floor or as a box through it.
TEST_P(Openings, OfAVoidGoThroughAllLayersOfAFloor)
{
    constexpr double half = 0.4;
    for (const bool is_face : {true, false})
    {
        Drawing drawing = tank(GetParam());
        drawing.fill({0, 0, -0.5}, 0.0);
        drawing.empty();
        const Vec3 corner{-half, -half, is_face ? low.z : low.z - 0.5};
        drawing.draw(make_box(corner, {2 * half, 2 * half, 1},
                              {true, !is_face, !is_face, !is_face, !is_face, !is_face}, !is_face,
                              {}, dp)[0]);
        const RunField field = relaxed(drawing);
        EXPECT_TRUE(floor_of(field, half).empty()) << is_face;
        // A row of particles around it in each layer.
        std::vector<int> beside(3, 0);
        for (const Vec3& p : floor_of(field, half + 1.1 * dp))
            ++beside[static_cast<std::size_t>(std::lround((low.z - p.z) / dp - GetParam()))];
        for (const int count : beside) EXPECT_GT(count, 28) << is_face;
    }
}

/// As in public cases: the ground under a building is taken out, and its walls are drawn there. The
/// fluid along them needs the ground's layers.
TEST_P(Openings, UnderABuildingKeepTheLayersAlongItsWalls)
{
    constexpr double half = 0.4;
    std::array<std::size_t, 2> counts{};
    for (const bool has_void : {false, true})
    {
        Drawing drawing = tank(GetParam());
        drawing.fill({-0.8, 0, -0.5}, 0.0);
        const Vec3 corner{-half, -half, low.z};
        if (has_void)
        {
            drawing.empty();
            drawing.box(corner, {2 * half, 2 * half, 1.2});
        }
        drawing.bound(1);
        drawing.draw(make_box(corner, {2 * half, 2 * half, 1.2},
                              {false, true, true, true, true, true}, false, {}, dp)[0]);
        for (const Vec3& p : floor_of(drawing.run(), half - 0.05 * dp))
            if (std::max(std::abs(p.x), std::abs(p.y)) > half - kernel_reach)
                ++counts[has_void ? 1 : 0];
    }
    EXPECT_GT(counts[0], 100u);
    EXPECT_EQ(counts[0], counts[1]);
}

/// The solver lets fluid in through the points of an inlet that lie in the wall, and refuses walls
/// nearer than 0.7 dp to them and to those behind. It is the only fluid, so its way decides on
/// which side the layers are.
TEST_P(Openings, OfAnInletAreWideEnoughForTheSolver)
{
    const double half = 0.4;
    Drawing drawing = tank(GetParam());
    drawing.def.solver.inout.fluids[Drawing::fluid_mk] = {{1, 0, 0}};
    drawing.fluid();
    drawing.box({low.x, -half, -half - 0.2}, {0, 2 * half, 2 * half});
    const RunField field = relaxed(drawing);
    std::size_t in_wall = 0;
    for (const Vec3& p : field.walls.particles.positions)
    {
        EXPECT_LT(p.z, 0.51);
        EXPECT_LE(p.x, low.x + size.x + 3 * dp);
        const bool is_in_tank = p.x > low.x + 1e-6 && p.x < low.x + size.x - 1e-6 &&
                                std::abs(p.y) < 1 - 1e-6 && p.z > low.z + 1e-6;
        EXPECT_FALSE(is_in_tank) << p.x << " " << p.y << " " << p.z;
        if (p.x > low.x + 0.5 * dp) continue;
        ++in_wall;
        const double across = std::max(std::abs(p.y) - half, 0.0);
        const double along = std::max(std::abs(p.z + 0.2) - half, 0.0);
        EXPECT_GT(std::hypot(across, along), 0.7 * dp);
    }
    EXPECT_GT(in_wall, 500u);
}

INSTANTIATE_TEST_SUITE_P(FirstDepth, Openings, testing::Values(0.0, 0.5));

} // namespace
} // namespace fppg::test
