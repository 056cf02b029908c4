#include "layered_drawing.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace fppg::test
{
namespace
{

constexpr double dp = Drawing::dp;
const Vec3 low{-1.5, -1.4, -1.5};
const Vec3 size{3.0, 2.8, 2.5};
const Vec3 cavity_low{-0.83, -0.74, -0.95};
const Vec3 cavity_size{1.63, 1.46, 3.0}; // open at the top of the block

enum class By
{
    Void,
    Fluid,
    Boolean,
};

/// A block with a cavity; what is left of it has layers, or particles on its surface.
Drawing hollowed(By by, bool has_layers)
{
    Drawing drawing = layered();
    if (!has_layers) drawing.def.fit.all->depths_dp.clear();
    drawing.box(low, size);
    if (by == By::Void) drawing.empty();
    if (by == By::Fluid) drawing.fluid();
    drawing.box(cavity_low, cavity_size);
    if (by != By::Boolean) return drawing;
    BooleanDef boolean;
    boolean.line = 7;
    boolean.tree.op = BooleanOp::Difference;
    boolean.tree.operands = {{BooleanOp::Part, 0, {}}, {BooleanOp::Part, 1, {}}};
    boolean.parts = {{0, false}, {1, false}};
    drawing.def.booleans.push_back(boolean);
    return drawing;
}

class Hollowed : public testing::TestWithParam<bool>
{
};

/// A void, or fluid, that is drawn into a solid makes the walls that a Boolean difference makes.
TEST_P(Hollowed, ByAVoidOrByFluidHasTheWallsOfADifference)
{
    const std::vector<Vec3> wanted =
        hollowed(By::Boolean, GetParam()).run().walls.particles.positions;
    EXPECT_GT(wanted.size(), 3000u);
    for (const By by : {By::Void, By::Fluid})
        EXPECT_EQ(hollowed(by, GetParam()).run().walls.particles.positions, wanted);
}

INSTANTIATE_TEST_SUITE_P(Layers, Hollowed, testing::Bool());

std::size_t fluid_particles(const RunField& field)
{
    std::size_t count = 0;
    for (const auto& slab : field.slabs)
        for (const Run& run : slab)
            if (run.mk == Drawing::fluid_mk && !run.is_covered) count += run.z_end - run.z_begin;
    for (const std::uint16_t mk : field.walls.volume.mk) count += mk == Drawing::fluid_mk ? 1 : 0;
    return count;
}

TEST(HollowedSolid, HoldsTheFluidOfItsCavityAndLooksAtIt)
{
    constexpr double level = -0.05; // half a step above the last nodes
    Drawing drawing = hollowed(By::Void, true);
    drawing.fill({0, 0, -0.5}, level);
    drawing.fluid_band();
    const RunField field = relaxed(drawing);
    const double volume = cavity_size.x * cavity_size.y * (level - cavity_low.z);
    EXPECT_NEAR(static_cast<double>(fluid_particles(field)) * std::pow(dp, 3), volume,
                0.005 * volume);
    const WallNormals walls = normals_of(drawing, field);
    EXPECT_TRUE(walls.report.warnings.empty());
    std::size_t near = 0;
    for (std::size_t i = 0; i < walls.positions.size(); ++i)
    {
        const Vec3& p = walls.positions[i];
        const double outside =
            std::max({cavity_low.x - p.x, p.x - cavity_low.x - cavity_size.x, cavity_low.y - p.y,
                      p.y - cavity_low.y - cavity_size.y, cavity_low.z - p.z});
        if (p.z < low.z + size.z)
        {
            EXPECT_GT(outside, 0.49 * dp) << p.x << " " << p.y << " " << p.z;
        }
        // Beside the cavity's faces, below the level.
        const bool is_beside = p.z > cavity_low.z && p.z < level && outside < 2.6 * dp &&
                               std::abs(p.x) < 0.75 && std::abs(p.y) > 0.5;
        if (!is_beside) continue;
        ++near;
        EXPECT_NEAR(norm(walls.normals[i]), outside, 1e-4 * dp);
    }
    EXPECT_GT(near, 500u);
}

/// GenCase draws nothing then, and says nothing.
TEST(HollowedSolid, OfWhichNothingIsLeftDrawsNothing)
{
    Drawing drawing = layered();
    drawing.box(low, size);
    drawing.empty();
    drawing.box(low - Vec3{0.1, 0.1, 0.1}, size + Vec3{0.2, 0.2, 0.2});
    EXPECT_EQ(drawing.run().walls.particles.size(), 0u);
}

/// As on the lattice, fluid that is drawn up to a solid, or a little into it, leaves it whole.
TEST(HollowedSolid, IsLeftWholeByFluidUpToItsFace)
{
    std::vector<std::size_t> counts;
    for (const double into : {-0.2, 0.0, 0.4})
    {
        Drawing drawing = layered();
        drawing.box(low, size);
        drawing.fluid();
        drawing.box({-0.5, -0.5, low.z + size.z - into * dp}, {1, 1, 0.6});
        counts.push_back(drawing.run().walls.bodies.front().mesh.facets.size());
    }
    EXPECT_EQ(counts, (std::vector<std::size_t>{12, 12, 12}));
}

/// A void that ends where a solid begins empties the nodes there, but the solid keeps its surface,
/// and its edges and corners.
TEST(TouchedSolid, KeepsTheFaceThatAVoidEndsAt)
{
    for (const double face : {0.4, 0.43})
    {
        Drawing drawing = layered();
        drawing.def.fit.all->depths_dp.clear();
        drawing.box({-1.5, -1.5, -1.5}, {2.1, 3, 1});
        drawing.bound(1);
        drawing.box({face, -0.5, -0.5}, {0.9, 1, 1});
        const std::vector<Vec3> whole = drawing.run().walls.particles.positions;
        EXPECT_GT(std::count_if(whole.begin(), whole.end(),
                                [&](const Vec3& p)
                                { return std::abs(p.x - face) < 1e-9 && p.z > -0.45; }),
                  100);
        drawing.empty();
        drawing.box({-0.5, -0.8, -0.5}, {0.5 + face, 1.6, 2});
        const RunField touched = drawing.run();
        EXPECT_EQ(touched.walls.particles.positions, whole);
        drawing.fill({0, 0, 0}, 0.3);
        const RunField filled = drawing.run();
        EXPECT_EQ(filled.walls.particles.positions, whole);
        for (std::size_t x = 0; x < filled.slabs.size(); ++x)
            for (const fppg::Run& run : filled.slabs[x])
            {
                const Vec3 at =
                    filled.grid.place({static_cast<double>(x), static_cast<double>(run.y),
                                       static_cast<double>(run.z_begin)});
                if (run.mk != Drawing::fluid_mk || run.is_covered || std::abs(at.y) > 0.45 ||
                    at.z < -0.45)
                    continue;
                EXPECT_GT(std::abs(at.x - face), 0.45 * dp);
            }
    }
}

/// The lid of a tank in 2D, through which water is drawn.
TEST(HollowedSheet, LosesItsParticlesIn2D)
{
    for (const double half_depth : {0.3, 1.4})
    {
        std::vector<std::size_t> counts;
        const Vec3 corner{low.x, -half_depth, low.z};
        const Vec3 extent{size.x, 2 * half_depth, size.z};
        for (const double over : {0.0, 0.4 * dp, 2 * dp})
        {
            Drawing drawing = layered(true);
            drawing.draw(
                make_box(corner, extent, {true, true, true, true, true, true}, false, {}, dp)[0]);
            drawing.fluid();
            drawing.box(corner, extent + Vec3{0, 0, over});
            std::size_t count = 0;
            for (const Vec3& p : drawing.run().walls.particles.positions)
                count += p.z > low.z + size.z && std::abs(p.x) < size.x / 2 - dp ? 1 : 0;
            counts.push_back(count);
        }
        EXPECT_GT(counts[0], 50u) << half_depth;
        EXPECT_EQ(counts[1], counts[0]) << half_depth;
        EXPECT_EQ(counts[2], 0u) << half_depth;
    }
}

/// A tank of sheets with a lid, and water up to its walls and through its lid: on the lattice its
/// nodes take those of the lid. Water up to the lid leaves all of it.
TEST(HollowedSheet, LosesWhatFluidIsDrawnThroughAndNotWhatItTouches)
{
    const auto wall_areas = [](double over_the_lid)
    {
        Drawing drawing = layered();
        drawing.draw(make_box(low, size, {true, true, true, true, true, true}, false, {}, dp)[0]);
        drawing.fluid();
        drawing.box(low, size + Vec3{0, 0, over_the_lid});
        double lid = 0, others = 0;
        const RunField field = drawing.run();
        const SurfaceMesh& mesh = field.walls.bodies.front().mesh;
        for (std::size_t f = 0; f < mesh.facets.size(); ++f)
            (mesh.normals[f].z > 0.9 ? lid : others) += mesh.areas[f];
        return std::pair(lid, others);
    };
    const double lid = size.x * size.y;
    const double others = lid + 2 * size.z * (size.x + size.y);
    for (const double over : {0.0, 0.4 * dp})
    {
        EXPECT_NEAR(wall_areas(over).first, lid, 1e-9) << over;
        EXPECT_NEAR(wall_areas(over).second, others, 1e-9) << over;
    }
    EXPECT_EQ(wall_areas(2 * dp).first, 0);
    EXPECT_NEAR(wall_areas(2 * dp).second, others, 1e-9);
}

} // namespace
} // namespace fppg::test
