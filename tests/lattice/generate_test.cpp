#include "fppg/case_def.h"
#include "fppg/scene.h"

#include "helpers/dense_grid.h"
#include "shapes/polyhedra.h"

#include <gtest/gtest.h>

#include <memory>

namespace fppg
{
namespace
{

using test::dense;
using test::DenseMks;
using test::Dice;

/// A case with draws given as data.
class Drawing
{
public:
    explicit Drawing(const LatticeGrid& grid)
    {
        def.grid = grid;
        def.mk_bound_first = 10;
        state.mk = {MkKind::Bound, 10, 0};
    }

    void draw(Command what)
    {
        DrawOp op;
        op.source = {1, "test"};
        op.state = std::make_shared<const DrawState>(state);
        op.what = std::move(what);
        def.ops.push_back(std::move(op));
    }

    /// Paints everything, through the clips.
    void draw_everything()
    {
        const Vec3 far{100, 100, 100};
        draw(make_box(def.grid.origin - far, def.grid.origin + far,
                      {true, true, true, true, true, true}, true, {}, def.grid.dp)[0]);
        draw(SphereOp{def.grid.origin, 400 * def.grid.dp, {}});
    }

    RunField run(int threads) const
    {
        LatticeReport report;
        return draw_scene(make_scene(def), threads, {}, report);
    }

    CaseDef def;
    DrawState state;
};

LatticeGrid small_grid()
{
    LatticeGrid grid;
    grid.origin = {-0.37, 0.2, 0.05};
    grid.dp = 0.1;
    grid.n = {14, 11, 13};
    return grid;
}

bool is_valid(const RunField& field)
{
    return test::runs_of(dense(field)).slabs == field.slabs;
}

TEST(GenerateLattice, KeepsOnlyTheNodesBehindEveryClip)
{
    Dice dice(21);
    for (int i = 0; i < 200; ++i)
    {
        Drawing drawing(test::any_grid(dice));
        const LatticeGrid& grid = drawing.def.grid;
        for (int k = 0; k < 2; ++k)
        {
            ClipPlane clip{position(test::any_node(dice, grid, 0), grid),
                           {dice.real(-1, 1), dice.real(-1, 1), dice.real(-1, 1)}};
            if (i % 3 == 0)
                clip.normal = {dice.one_of({-1.0, 1.0}), dice.one_of({-1.0, 0.0, 1.0}), 0};
            if (i % 3 == 1)
                clip.normal = {1, -2, dice.one_of({-1.0, 1.0})}; // many nodes lie on the plane
            drawing.state.clips.push_back(clip);
        }
        drawing.draw_everything();
        DenseMks expected(grid);
        test::for_each_node(grid,
                            [&](const Node& n)
                            {
                                bool is_kept = true;
                                for (const ClipPlane& c : drawing.state.clips)
                                {
                                    // Of nodes on the plane, rounding decides as in GenCase.
                                    const Vec3 unit = c.normal / norm(c.normal);
                                    is_kept = is_kept &&
                                              dot(unit, position(n, grid)) <= dot(unit, c.point);
                                }
                                expected.at(n.x, n.y, n.z) = is_kept ? 10 : 0;
                            });
        ASSERT_TRUE(dense(drawing.run(1)) == expected) << "case " << i;
    }
}

/// Some of everything, one over the other.
Drawing busy_drawing(std::uint32_t seed)
{
    Dice dice(seed);
    LatticeGrid grid = small_grid();
    grid.n = {25, 20, 22};
    Drawing drawing(grid);
    const auto place = [&] { return position(test::any_node(dice, grid, 2), grid); };
    for (int i = 0; i < 25; ++i)
    {
        const auto mk = static_cast<std::uint16_t>(dice.whole(0, 3));
        drawing.state.mk = {mk == 0   ? MkKind::Void
                            : mk == 3 ? MkKind::Fluid
                                      : MkKind::Bound,
                            static_cast<std::uint16_t>(mk == 0   ? 0
                                                       : mk == 3 ? 1
                                                                 : 9 + mk),
                            0};
        drawing.state.mode =
            dice.one_of({DrawMode::Wire, DrawMode::Face, DrawMode::Solid, DrawMode::Full});
        drawing.state.clips.clear();
        if (dice.whole(0, 3) == 0) drawing.state.clips.push_back({place(), {1, -1, 0.5}});
        const double radius = dice.real(0.2, 0.8);
        const bool round = drawing.state.mode != DrawMode::Wire;
        switch (dice.whole(0, 6))
        {
            case 0:
                drawing.draw(make_prism({place(), place(), place(), place(), place(), place()}));
                break;
            case 1:
                drawing.draw(make_pyramid({place(), place(), place(), place()}));
                break;
            case 2:
                if (round) drawing.draw(SphereOp{place(), radius, {}});
                break;
            case 3:
                if (round)
                    drawing.draw(CylinderOp{place(), place(), radius, {true, true, true}, {}});
                break;
            case 4:
            {
                FillOp fill;
                fill.seed = place();
                fill.filter.names = {true, false, false};
                drawing.draw(fill);
                break;
            }
            case 5:
                drawing.draw(RedrawNearOp{{MkKind::Void, {}}, {MkKind::Bound, {}}, 1, {}, {}});
                break;
            default:
                drawing.draw(LinesOp{{{place(), place()}, {place(), place()}}});
        }
    }
    return drawing;
}

TEST(GenerateLattice, GivesTheSameRunsWithOneAndEightThreads)
{
    for (std::uint32_t seed = 0; seed < 30; ++seed)
    {
        const Drawing drawing = busy_drawing(seed);
        const RunField one = drawing.run(1);
        ASSERT_TRUE(is_valid(one)) << "seed " << seed;
        ASSERT_EQ(one.slabs, drawing.run(8).slabs) << "seed " << seed;
    }
}

TEST(GenerateLattice, PaintsTheLaterDrawOverTheEarlier)
{
    Drawing drawing(small_grid());
    drawing.draw_everything();
    drawing.state.mk = {MkKind::Fluid, 1, 0};
    drawing.draw(PointsOp{{position({3, 4, 5}, drawing.def.grid)}});
    const DenseMks nodes = dense(drawing.run(1));
    EXPECT_EQ(nodes.at(3, 4, 5), 1);
    EXPECT_EQ(nodes.at(3, 4, 6), 10);
}

TEST(GenerateLattice, ErasesWithVoid)
{
    Drawing drawing(small_grid());
    drawing.draw_everything();
    drawing.state.mk = {};
    drawing.draw_everything();
    for (const auto& slab : drawing.run(1).slabs) EXPECT_TRUE(slab.empty());
}

TEST(GenerateLattice, DrawsNothingWhilePointsAreSwitchedOff)
{
    Drawing drawing(small_grid());
    drawing.state.draw_points = false;
    drawing.draw_everything();
    for (const auto& slab : drawing.run(1).slabs) EXPECT_TRUE(slab.empty());
}

TEST(GenerateLattice, WarnsOfAFillWithoutANode)
{
    Drawing drawing(small_grid());
    drawing.draw_everything();
    FillOp fill;
    fill.seed = drawing.def.grid.origin;
    fill.filter.names = {true, false, false};
    drawing.draw(fill);
    LatticeReport report;
    draw_scene(make_scene(drawing.def), 1, {}, report);
    // The drawing itself has a warning of its own: a shape of it is thinner than dp.
    ASSERT_FALSE(report.warnings.empty());
    EXPECT_NE(report.warnings.back().find("the fill added no node"), std::string::npos);
}

TEST(GenerateLattice, StopsWhenProgressThrows)
{
    Drawing drawing(small_grid());
    drawing.draw_everything();
    LatticeReport report;
    const auto stop = [](std::size_t, std::size_t) { throw std::runtime_error("enough"); };
    EXPECT_THROW(draw_scene(make_scene(drawing.def), 2, stop, report), std::runtime_error);
}

} // namespace
} // namespace fppg
