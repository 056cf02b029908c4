#include "fppg/case_def.h"
#include "fppg/lattice.h"

#include "helpers/dense_grid.h"
#include "helpers/drawing.h"

#include <gtest/gtest.h>

#include <cmath>

namespace fppg
{
namespace
{

using test::Drawing;

constexpr double dp = Drawing::dp;
constexpr std::uint16_t fluid_mk = Drawing::fluid_mk;
constexpr std::uint16_t wall_mk = Drawing::wall_mk;

/// Calls visit(position, mk with the bit of the zone) for every node that has a run.
template <typename Visit>
void for_each_node(const RunField& field, const Visit& visit)
{
    for (std::size_t x = 0; x < field.slabs.size(); ++x)
        for (const Run& r : field.slabs[x])
            for (std::uint32_t z = r.z_begin; z < r.z_end; ++z)
                visit(field.grid.origin + Vec3{static_cast<double>(x), static_cast<double>(r.y),
                                               static_cast<double>(z)} *
                                              field.grid.dp,
                      test::dense_mk(r));
}

TEST(FittedWalls, StopAFillAsTheirShapeDoes)
{
    for (const double radius : {0.93, 1.0, 1.234})
    {
        Drawing drawing;
        drawing.state.mode = DrawMode::Face;
        const Vec3 center{0.03, -0.02, 0.01};
        drawing.draw(SphereOp{center, radius, {}});
        drawing.fill(center);
        std::size_t n = 0;
        for_each_node(drawing.run(),
                      [&](const Vec3& p, std::uint16_t mk)
                      {
                          if (mk != fluid_mk) return;
                          ++n;
                          EXPECT_LE(norm(p - center), radius - 0.49 * dp);
                      });
        EXPECT_GT(static_cast<double>(n) * dp * dp * dp, 0.75 * 4.18879 * std::pow(radius, 3));
    }
}

TEST(FittedWalls, ASolidHasItsVolumeInNodesAndHalfOfItsWall)
{
    Drawing drawing;
    const Vec3 center{0.03, -0.02, 0.01};
    drawing.draw(SphereOp{center, 1.1, {}});
    const RunField field = drawing.run();
    double nodes = 0;
    for_each_node(field,
                  [&](const Vec3& p, std::uint16_t mk)
                  {
                      if (mk != wall_mk) return;
                      ++nodes;
                      EXPECT_LE(norm(p - center), 1.1 - 0.49 * dp);
                  });
    nodes += 0.5 * static_cast<double>(field.walls.particles.size());
    EXPECT_NEAR(nodes * dp * dp * dp / (4.18879 * 1.1 * 1.1 * 1.1), 1, 0.005);
}

TEST(FittedWalls, ParticlesOfARoundShapeStandOnTheExactRoundSurface)
{
    Drawing drawing;
    drawing.draw(SphereOp{{0, 0, 0}, 1.05, {}});
    const RunField field = drawing.run();
    ASSERT_GT(field.walls.particles.size(), 1200U);
    for (const Vec3& p : field.walls.particles.positions) EXPECT_NEAR(norm(p), 1.05, 1e-12);
}

/// A ball, and a void that takes half of it by its nodes: one with a clip hollows no body.
Drawing half_a_ball()
{
    Drawing drawing;
    drawing.draw(SphereOp{{0, 0, 0}, 1.1, {}});
    drawing.empty();
    drawing.state.clips = {{{5, 0, 0}, {1, 0, 0}}};
    drawing.box({0, -2, -2}, {2, 4, 4});
    return drawing;
}

TEST(FittedWalls, ALaterVoidBoxWithAClipCutsThem)
{
    Drawing drawing;
    drawing.draw(SphereOp{{0, 0, 0}, 1.1, {}});
    const std::size_t whole = drawing.run().walls.particles.size();
    drawing = half_a_ball();
    const RunField field = drawing.run();
    std::size_t left = 0;
    for (const Vec3& p : field.walls.particles.positions)
    {
        EXPECT_LE(p.x, dp);
        left += p.x <= 0;
    }
    EXPECT_NEAR(static_cast<double>(left), 0.5 * static_cast<double>(whole),
                0.08 * static_cast<double>(whole));
    for_each_node(field, [&](const Vec3& p, std::uint16_t) { EXPECT_LT(p.x, 0.5 * dp); });
}

TEST(FittedWalls, ThoseNextToACutAreHeld)
{
    const RunField field = half_a_ball().run();
    const WallParticles& particles = field.walls.particles;
    for (std::size_t i = 0; i < particles.size(); ++i)
    {
        if (particles.positions[i].x < -4 * dp)
        {
            EXPECT_EQ(particles.held[i], 0);
        }
        if (particles.positions[i].x > -dp)
        {
            EXPECT_EQ(particles.held[i], 1);
        }
    }
}

TEST(FittedWalls, ALaterBodyTakesThePlaceOfAnEarlierOne)
{
    Drawing drawing;
    drawing.draw(SphereOp{{-0.3, 0, 0}, 1, {}});
    const std::size_t first = drawing.run().walls.particles.size();
    drawing.bound(1);
    drawing.draw(SphereOp{{0.4, 0, 0}, 1.1, {}});
    const RunField field = drawing.run();
    const WallParticles& particles = field.walls.particles;
    std::size_t of_first = 0;
    for (std::size_t i = 0; i < particles.size(); ++i)
    {
        const Vec3& p = particles.positions[i];
        if (particles.bodies[i] == 1) continue;
        ++of_first;
        EXPECT_EQ(particles.mk[i], wall_mk);
        EXPECT_GT(norm(p - Vec3{0.4, 0, 0}), 1.1 + 0.49 * dp);
    }
    // Three fifths of the first sphere lie outside the second.
    EXPECT_LT(static_cast<double>(of_first), 0.6 * static_cast<double>(first));
    EXPECT_GT(static_cast<double>(of_first), 0.54 * static_cast<double>(first));
    // The later one is whole.
    Drawing alone;
    alone.bound(1);
    alone.draw(SphereOp{{0.4, 0, 0}, 1.1, {}});
    EXPECT_EQ(particles.size() - of_first, alone.run().walls.particles.size());
}

TEST(FittedWalls, ARedrawWithAnotherBoundaryMkMovesNothing)
{
    Drawing drawing;
    drawing.draw(SphereOp{{0, 0, 0}, 1.1, {}});
    const RunField before = drawing.run();
    drawing.bound(3);
    RedrawOp op;
    op.filters.push_back({MkKind::Bound, wall_mk});
    drawing.draw(op);
    const RunField after = drawing.run();
    EXPECT_EQ(after.walls.particles.size(), before.walls.particles.size());
    for (const std::uint16_t mk : after.walls.particles.mk) EXPECT_EQ(mk, wall_mk + 3);
    for_each_node(
        after, [&](const Vec3&, std::uint16_t mk) { EXPECT_EQ(mk & ~test::covered, wall_mk + 3); });
}

TEST(FittedWalls, ARedrawToFluidPutsThemBackOnTheLattice)
{
    Drawing drawing;
    drawing.draw(SphereOp{{0, 0, 0}, 1.1, {}});
    drawing.fluid();
    RedrawOp op;
    op.filters.push_back({MkKind::Bound, std::nullopt});
    drawing.draw(op);
    const RunField after = drawing.run();
    EXPECT_EQ(after.walls.particles.size(), 0U);
    for_each_node(after, [&](const Vec3&, std::uint16_t mk) { EXPECT_EQ(mk, fluid_mk); });
}

TEST(FittedWalls, ClipsAreTestedAtTheTruePlace)
{
    Drawing drawing;
    drawing.state.clips.push_back({{0.037, 0, 0}, {1, 0, 0}});
    drawing.draw(SphereOp{{0, 0, 0}, 1.1, {}});
    double farthest = -2;
    const RunField field = drawing.run();
    for (const Vec3& p : field.walls.particles.positions) farthest = std::max(farthest, p.x);
    EXPECT_LE(farthest, 0.037);
    EXPECT_GT(farthest, 0.037 - dp);
}

TEST(FittedWalls, ThoseOutsideTheDomainAreLeftOut)
{
    Drawing drawing;
    drawing.draw(SphereOp{{2, 0, 0}, 1.1, {}});
    const RunField field = drawing.run();
    ASSERT_GT(field.walls.particles.size(), 500U);
    for (const Vec3& p : field.walls.particles.positions) EXPECT_LE(p.x, 2 + 1e-6);
}

TEST(FittedWalls, OtherMksStayOnTheLattice)
{
    Drawing drawing;
    drawing.def.fit.all.reset();
    drawing.def.fit.of_mk.insert_or_assign(wall_mk + 1, FitSettings{});
    drawing.draw(SphereOp{{0, 0, 0}, 1.1, {}});
    EXPECT_EQ(drawing.run().walls.bodies.size(), 0U);
    drawing.bound(1);
    drawing.draw(SphereOp{{0, 0, 0}, 0.6, {}});
    EXPECT_EQ(drawing.run().walls.bodies.size(), 1U);
}

TEST(FittedWalls, OfABoxHaveAParticleOnEveryCorner)
{
    Drawing drawing;
    drawing.box({-0.73, -0.52, -0.31}, {1.1, 0.9, 0.7});
    const RunField field = drawing.run();
    for (int corner = 0; corner < 8; ++corner)
    {
        const Vec3 at{-0.73 + 1.1 * (corner >> 2), -0.52 + 0.9 * (corner >> 1 & 1),
                      -0.31 + 0.7 * (corner & 1)};
        double nearest = 1;
        for (const Vec3& p : field.walls.particles.positions)
            nearest = std::min(nearest, norm(p - at));
        EXPECT_LT(nearest, 1e-12);
    }
}

TEST(FittedWalls, AreTheSameForAnyNumberOfThreads)
{
    Drawing drawing;
    drawing.draw(SphereOp{{-0.3, 0, 0}, 1, {}});
    drawing.bound(1);
    drawing.draw(CylinderOp{{0, -1.3, 0.1}, {0.2, 1.3, 0.2}, 0.6, {true, true, true}, {}});
    drawing.empty();
    drawing.box({0.3, -2, -2}, {2, 4, 4});
    drawing.fill({-1.9, -1.9, -1.9});
    const RunField one = drawing.run(1);
    const RunField eight = drawing.run(8);
    EXPECT_EQ(one.slabs, eight.slabs);
    ASSERT_EQ(one.walls.particles.size(), eight.walls.particles.size());
    for (std::size_t i = 0; i < one.walls.particles.size(); ++i)
        EXPECT_EQ(norm(one.walls.particles.positions[i] - eight.walls.particles.positions[i]), 0);
    EXPECT_EQ(one.walls.particles.held, eight.walls.particles.held);
    EXPECT_EQ(one.walls.particles.mk, eight.walls.particles.mk);
}

} // namespace
} // namespace fppg
