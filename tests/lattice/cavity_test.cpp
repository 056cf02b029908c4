#include "fppg/error.h"

#include "helpers/dense_grid.h"
#include "lattice/cavity.h"
#include "lattice/cavity_fill.h"
#include "lattice/fill_level.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace fppg
{
namespace
{

using test::dense;
using test::DenseMks;
using test::DenseSet;
using test::Dice;
using test::difference;

constexpr double dp = 0.1; // a node holds one litre
constexpr std::uint16_t wall_mk = 10;
constexpr std::uint16_t fluid_mk = 1;

LatticeGrid grid_of(std::array<std::uint32_t, 3> n)
{
    LatticeGrid grid;
    grid.dp = dp;
    grid.n = n;
    grid.is_2d = n[1] == 1;
    return grid;
}

/// A field of walls that is cut out of nothing.
struct Room
{
    explicit Room(std::array<std::uint32_t, 3> n = {40, 30, 30}) : nodes(grid_of(n)) {}

    /// Limits included.
    void paint(const Node& a, const Node& b, std::uint16_t mk)
    {
        for (std::int64_t x = a.x; x <= b.x; ++x)
            for (std::int64_t y = a.y; y <= b.y; ++y)
                for (std::int64_t z = a.z; z <= b.z; ++z) nodes.at(x, y, z) = mk;
    }
    /// A solid block with an empty room in it.
    void block(const Node& a, const Node& b) { paint(a, b, wall_mk); }
    void carve(const Node& a, const Node& b) { paint(a, b, 0); }

    std::uint64_t filled(const CavityFillOp& op, int threads = 1)
    {
        report = {};
        return node_count(fill_cavity(test::runs_of(nodes), op, threads, report));
    }
    std::string error(const CavityFillOp& op)
    {
        try
        {
            filled(op);
        }
        catch (const GeometryError& e)
        {
            return e.what();
        }
        return "no error";
    }

    DenseMks nodes;
    CavityFillReport report;
};

CavityFillOp fill_at(const Node& seed, FillMeasure measure, double amount, int gap_nodes = 1)
{
    CavityFillOp op;
    op.seed = Vec3{static_cast<double>(seed.x), static_cast<double>(seed.y),
                   static_cast<double>(seed.z)} *
              dp;
    op.measure = measure;
    op.amount = amount;
    op.gap_nodes = gap_nodes;
    return op;
}

bool says(const std::string& text, const std::string& part)
{
    return text.find(part) != std::string::npos;
}

/// 10 x 8 nodes inside, 15 layers up to the rim at z = 20.
Room open_tank()
{
    Room room;
    room.block({5, 5, 5}, {16, 14, 20});
    room.carve({6, 6, 6}, {15, 13, 20});
    return room;
}

TEST(FillCavity, TakesTheLayersOfATankWhoseLitresAreNearest)
{
    Room tank = open_tank();
    const Node seed{10, 10, 10};
    EXPECT_EQ(tank.filled(fill_at(seed, FillMeasure::Litres, 160)), 160U);
    EXPECT_EQ(tank.filled(fill_at(seed, FillMeasure::Litres, 170)), 160U);
    EXPECT_EQ(tank.filled(fill_at(seed, FillMeasure::Litres, 210)), 240U);
    EXPECT_EQ(tank.filled(fill_at(seed, FillMeasure::Litres, 200)), 160U) << "a tie goes down";
    EXPECT_EQ(tank.filled(fill_at(seed, FillMeasure::Litres, 1200)), 1200U);
    ASSERT_EQ(tank.report.log.size(), 2U);
    EXPECT_TRUE(
        says(tank.report.log[0], "the cavity holds 1200 litres, 1200 nodes, open from height 2.1"));
    EXPECT_EQ(tank.report.log[1], "filled 1200 nodes, 1200 litres, 100 % of the cavity, level 2");
}

/// Nobody was told that 210 litres were 240.
TEST(FillCavity, WarnsWhereWholeRowsAreFarFromTheLitres)
{
    for (const auto& [litres, said] : {std::pair{210.0, "14.3 % more than the 210 asked for"},
                                       {170.0, "5.9 % less than the 170 asked for"},
                                       {161.0, ""}})
    {
        Room tank = open_tank();
        tank.filled(fill_at({10, 10, 10}, FillMeasure::Litres, litres));
        ASSERT_EQ(tank.report.warnings.size(), *said == 0 ? 0U : 1U);
        if (*said != 0) EXPECT_TRUE(says(tank.report.warnings[0], said)) << tank.report.warnings[0];
    }
}

TEST(FillCavity, FillsAnOpenTankUpToALevelBelowItsRimOnly)
{
    Room tank = open_tank();
    const Node seed{10, 10, 10};
    EXPECT_EQ(tank.filled(fill_at(seed, FillMeasure::Level, 1.0)), 400U);
    EXPECT_EQ(tank.filled(fill_at(seed, FillMeasure::Level, 1.04)), 400U);
    EXPECT_EQ(tank.filled(fill_at(seed, FillMeasure::Level, 2.0)), 1200U);
    EXPECT_TRUE(says(tank.error(fill_at(seed, FillMeasure::Level, 2.1)), "is not closed"));
    EXPECT_TRUE(says(tank.error(fill_at(seed, FillMeasure::Litres, 1300)),
                     "holds 1200 litres up to its lowest way out at height 2.1 near"));
    EXPECT_TRUE(
        says(tank.error(fill_at(seed, FillMeasure::Percent, 50)), "percent needs a closed cavity"));
    EXPECT_TRUE(says(tank.error(fill_at({10, 10, 25}, FillMeasure::Level, 1)), "outside of all"));
}

TEST(FillCavity, WarnsWhereTheLevelIsBelowTheFloor)
{
    Room tank = open_tank();
    EXPECT_EQ(tank.filled(fill_at({10, 10, 10}, FillMeasure::Level, 0.5)), 0U);
    ASSERT_EQ(tank.report.warnings.size(), 1U);
    EXPECT_TRUE(says(tank.report.warnings[0], "added no node"));
}

TEST(FillCavity, FillsBothArmsOfAnLFromASeedInOne)
{
    Room room;
    room.block({5, 5, 5}, {16, 14, 20});
    room.carve({6, 6, 6}, {15, 13, 9});  // 320 nodes
    room.carve({6, 6, 10}, {8, 13, 19}); // 24 a layer
    const Node seed{7, 10, 18};
    EXPECT_EQ(room.filled(fill_at(seed, FillMeasure::Percent, 100)), 560U);
    EXPECT_EQ(room.filled(fill_at(seed, FillMeasure::Percent, 60)), 344U);
    EXPECT_EQ(room.filled(fill_at(seed, FillMeasure::Level, 0.7)), 160U);
    EXPECT_EQ(room.report.warnings.size(), 0U);
}

TEST(FillCavity, FillsAShareOfASphere)
{
    Room room;
    room.block({2, 2, 2}, {26, 26, 26});
    std::vector<std::uint64_t> layers(30, 0);
    test::for_each_node(room.nodes.grid,
                        [&](const Node& n)
                        {
                            const std::int64_t x = n.x - 14;
                            const std::int64_t y = n.y - 14;
                            const std::int64_t z = n.z - 14;
                            if (x * x + y * y + z * z > 100) return;
                            room.nodes.at(n.x, n.y, n.z) = 0;
                            ++layers[static_cast<std::size_t>(n.z)];
                        });
    std::uint64_t all = 0;
    for (const std::uint64_t n : layers) all += n;
    std::uint64_t lower = 0;
    for (std::size_t z = 0; z < 14; ++z) lower += layers[z];
    EXPECT_EQ(room.filled(fill_at({14, 14, 14}, FillMeasure::Percent, 100)), all);
    const double share = 100 * static_cast<double>(lower + 10) / static_cast<double>(all);
    EXPECT_EQ(room.filled(fill_at({14, 14, 14}, FillMeasure::Percent, share)), lower);
}

TEST(FillCavity, LeavesACavityWithoutTheSeedEmpty)
{
    Room room;
    room.block({5, 5, 5}, {25, 15, 15});
    room.carve({6, 6, 6}, {14, 14, 14}); // 729 nodes
    room.carve({16, 6, 6}, {24, 14, 14});
    EXPECT_EQ(room.filled(fill_at({20, 10, 10}, FillMeasure::Percent, 100)), 729U);
    EXPECT_EQ(room.filled(fill_at({10, 10, 10}, FillMeasure::Percent, 100)), 729U);
}

TEST(FillCavity, ClosesAGapOneNodeWideAndListsIt)
{
    Room room;
    room.block({5, 5, 5}, {16, 15, 15});
    room.carve({6, 6, 6}, {14, 14, 14}); // 729 nodes, the wall at x = 15, 16 is two nodes thick
    room.carve({15, 8, 7}, {16, 8, 12}); // a slit of one node by six
    // The half of the slit on this side is filled, the other one is not.
    EXPECT_EQ(room.filled(fill_at({10, 10, 10}, FillMeasure::Percent, 100)), 735U);
    ASSERT_EQ(room.report.warnings.size(), 1U);
    EXPECT_TRUE(says(room.report.warnings[0], "1 gap up to 1 node wide is closed"));
    EXPECT_TRUE(says(room.report.warnings[0], "6 nodes near (1.5, 0.8, 0.95), to the outside"));
    const std::string open = room.error(fill_at({10, 10, 10}, FillMeasure::Percent, 100, 0));
    EXPECT_TRUE(says(open, "the lowest way out is at height 0.7 near (1."));
    EXPECT_TRUE(says(open, "through an opening 1 node wide, gapclose=\"1\" closes: 6 nodes"));
    // Below the gap the room is a tank.
    EXPECT_EQ(room.filled(fill_at({10, 10, 10}, FillMeasure::Level, 0.6, 0)), 81U);
}

TEST(FillCavity, RefusesAWiderOpeningAndSaysWhereItIs)
{
    Room room;
    room.block({5, 5, 5}, {16, 15, 15});
    room.carve({6, 6, 6}, {14, 14, 14});
    room.carve({15, 8, 9}, {16, 10, 11});
    const std::string open = room.error(fill_at({10, 10, 10}, FillMeasure::Percent, 100));
    EXPECT_TRUE(says(open, "is not closed: the lowest way out is at height 0.9"));
    EXPECT_TRUE(says(open,
                     "an opening 3 nodes wide, gapclose=\"3\" closes: 9 nodes near (1.5, "
                     "0.9, 1)"))
        << open;
    EXPECT_EQ(room.filled(fill_at({10, 10, 10}, FillMeasure::Level, 0.8)), 243U);
    EXPECT_GE(room.filled(fill_at({10, 10, 10}, FillMeasure::Percent, 100, 3)), 729U);
}

TEST(FillCavity, FillsNarrowPlacesThatLeadNowhere)
{
    Room room;
    room.block({5, 5, 5}, {20, 15, 15});
    room.carve({6, 6, 6}, {14, 14, 14});
    room.carve({15, 8, 8}, {18, 8, 12}); // a slot of one node by five, four deep
    EXPECT_EQ(room.filled(fill_at({10, 10, 10}, FillMeasure::Percent, 100)), 749U);
    EXPECT_EQ(room.report.warnings.size(), 0U);
}

TEST(FillCavity, FillsAThinSheetUpToTheMiddleOfTheWayOut)
{
    Room room;
    room.block({5, 5, 5}, {20, 25, 15});
    room.carve({6, 6, 6}, {14, 14, 14});
    room.carve({10, 15, 8}, {10, 22, 14});  // a sheet one node thick, eight by seven
    room.carve({11, 22, 14}, {19, 22, 14}); // and from its far corner nine nodes, then out
    room.carve({20, 22, 14}, {20, 22, 14});
    // The sheet is nearer to the room, and so is one node of the passage: nine steps from the room
    // and ten from the outside.
    EXPECT_EQ(room.filled(fill_at({10, 10, 10}, FillMeasure::Percent, 100)), 729U + 56U + 1U);
    EXPECT_TRUE(says(room.report.warnings.at(0), "1 nodes near (1.1, 2.2, 1.4), to the outside"));
}

TEST(FillCavity, TakesAGapToAnotherClosedRoomForAGap)
{
    Room room;
    room.block({5, 5, 5}, {25, 15, 15});
    room.carve({6, 6, 6}, {14, 14, 14});
    room.carve({16, 6, 6}, {24, 14, 14});
    room.carve({15, 8, 8}, {15, 8, 8});
    EXPECT_EQ(room.filled(fill_at({10, 10, 10}, FillMeasure::Percent, 100)), 729U);
    ASSERT_EQ(room.report.warnings.size(), 1U);
    EXPECT_TRUE(says(room.report.warnings[0], "1 nodes near (1.4, 0.8, 0.8), to another closed"));
    EXPECT_TRUE(says(room.error(fill_at({10, 10, 10}, FillMeasure::Litres, 800)),
                     "holds 729 litres, 800 are wanted; 1 gap up to 1 node wide is closed"));
    EXPECT_EQ(room.filled(fill_at({10, 10, 10}, FillMeasure::Percent, 100, 0)), 1459U);
}

TEST(FillCavity, FollowsATiltedUp)
{
    Room room;
    room.block({5, 5, 5}, {16, 14, 20});
    room.carve({6, 6, 6}, {15, 13, 19});
    CavityFillOp op = fill_at({10, 10, 10}, FillMeasure::Level, 1.6);
    op.up = Vec3{1, 0, 2} / std::sqrt(5.0);
    std::uint64_t expected = 0;
    for (int x = 6; x <= 15; ++x)
        for (int z = 6; z <= 19; ++z) expected += x + 2 * z <= 16 * std::sqrt(5.0) ? 8 : 0;
    EXPECT_EQ(room.filled(op), expected);
    // A layer is what has one height: nodes with the same x + 2 z.
    op.measure = FillMeasure::Litres;
    op.amount = 41;
    EXPECT_EQ(room.filled(op), 48U); // x + 2 z = 18, 19, 20, 21: 8, 8, 16, 16 nodes
    op.up = {0, 0, -1};
    op.amount = 80;
    op.measure = FillMeasure::Level;
    op.amount = -1.9;
    EXPECT_EQ(room.filled(op), 80U);
}

TEST(FillCavity, KnowsTheRimOfATankAlongATiltedUp)
{
    Room tank = open_tank();
    CavityFillOp op = fill_at({10, 10, 8}, FillMeasure::Litres, 1);
    op.up = Vec3{1, 0, 2} / std::sqrt(5.0);
    // Over the lower rim, that at x = 5, the way leads through (6, y, 21).
    const double rim = 6 + 2 * 21;
    std::uint64_t expected = 0;
    for (int x = 6; x <= 15; ++x)
        for (int z = 6; z <= 20; ++z) expected += x + 2 * z < rim - 1e-6 ? 8 : 0;
    for (const int gap_nodes : {0, 1, 2})
    {
        op.gap_nodes = gap_nodes;
        tank.filled(op);
        EXPECT_TRUE(says(tank.report.log[0], " " + std::to_string(expected) + " nodes"))
            << gap_nodes << ": " << tank.report.log[0] << ", not " << expected;
    }
}

TEST(FillCavity, FillsALitreAMetreOfWidthIn2D)
{
    Room room({40, 1, 30});
    room.block({5, 0, 5}, {16, 0, 20});
    room.carve({6, 0, 6}, {15, 0, 20});
    // A node holds 10 litres a metre.
    EXPECT_EQ(room.filled(fill_at({10, 0, 10}, FillMeasure::Litres, 300)), 30U);
    EXPECT_EQ(room.filled(fill_at({10, 0, 10}, FillMeasure::Level, 0.8)), 30U);
    EXPECT_TRUE(says(room.report.log[1], "300 litres a metre of width"));
}

TEST(FillCavity, TakesTheBorderOfTheDomainForAnOpening)
{
    Room room({12, 12, 12});
    room.block({0, 0, 0}, {11, 11, 11});
    room.carve({1, 1, 1}, {10, 10, 11}); // open at the top of the domain
    EXPECT_TRUE(says(room.error(fill_at({5, 5, 5}, FillMeasure::Percent, 50)), "not closed"));
    EXPECT_EQ(room.filled(fill_at({5, 5, 5}, FillMeasure::Level, 1.1)), 1100U);
}

TEST(FillCavity, RefusesASeedInAWallOrInAGap)
{
    Room room;
    room.block({5, 5, 5}, {16, 15, 15});
    room.carve({6, 6, 6}, {14, 14, 14});
    room.carve({15, 8, 7}, {16, 8, 12});
    EXPECT_TRUE(
        says(room.error(fill_at({5, 8, 8}, FillMeasure::Percent, 50)), "mk 10 is drawn there"));
    EXPECT_TRUE(says(room.error(fill_at({16, 8, 8}, FillMeasure::Percent, 50)), "lies in a gap"));
    EXPECT_TRUE(
        says(room.error(fill_at({50, 8, 8}, FillMeasure::Percent, 50)), "outside the domain"));
}

/// The lowest height under which nodes connected with a seed get to the border, by trying all.
std::int64_t spill_height(const DenseMks& nodes, const Node& seed, std::int64_t limit,
                          DenseSet& basin)
{
    for (std::int64_t h = seed.z; h <= limit; ++h)
    {
        DenseSet reached(nodes.grid);
        std::vector<Node> stack{seed};
        bool is_out = false;
        while (!stack.empty())
        {
            const Node n = stack.back();
            stack.pop_back();
            if (n.z > h) continue;
            if (!is_inside(n, nodes.grid))
            {
                is_out = true;
                break;
            }
            if (nodes.at(n.x, n.y, n.z) != 0 || reached.at(n.x, n.y, n.z)) continue;
            reached.at(n.x, n.y, n.z) = 1;
            for (const int d : {-1, 1})
            {
                stack.push_back({n.x + d, n.y, n.z});
                stack.push_back({n.x, n.y + d, n.z});
                stack.push_back({n.x, n.y, n.z + d});
            }
        }
        if (is_out) return h;
        basin = reached;
    }
    return limit + 1;
}

TEST(FindCavity, IsTheBasinOfAPlainSearchLevelByLevel)
{
    Dice dice(5);
    int open = 0;
    int closed = 0;
    for (int i = 0; i < 3000; ++i)
    {
        LatticeGrid grid = grid_of({8, 7, 9});
        DenseMks nodes(grid);
        test::for_each_node(
            grid, [&](const Node& n) { nodes.at(n.x, n.y, n.z) = dice.whole(0, 9) < 6 ? 10 : 0; });
        const Node seed = test::any_node(dice, grid, 0);
        nodes.at(seed.x, seed.y, seed.z) = 0;
        const RunField field = test::runs_of(nodes);
        DenseSet basin(grid);
        Node drop = seed;
        while (drop.z > 0 && nodes.at(drop.x, drop.y, drop.z - 1) == 0) --drop.z;
        const std::int64_t spill = spill_height(nodes, drop, grid.n[2], basin);
        CavityOptions options;
        options.seed = seed;
        options.gap_nodes = 0;
        Cavity cavity;
        try
        {
            cavity = find_cavity(field, options, 1);
        }
        catch (const GeometryError&)
        {
            continue; // beyond all that is drawn
        }
        ASSERT_EQ(difference(dense(grid, cavity.nodes), basin), "") << i;
        ASSERT_EQ(cavity.opening.has_value(), spill <= grid.n[2]) << i;
        if (cavity.opening && cavity.node_count > 0)
        {
            ASSERT_NEAR(cavity.opening->height, static_cast<double>(spill), 1e-9);
        }
        ++(cavity.opening ? open : closed);
    }
    EXPECT_GT(open, 300);
    EXPECT_GT(closed, 50);
}

TEST(FindCavity, IsTheSameWithAnyNumberOfThreads)
{
    Dice dice(6);
    int found = 0;
    for (int i = 0; i < 300; ++i)
    {
        const LatticeGrid grid = grid_of({24, 20, 22});
        DenseMks nodes(grid);
        for (int k = 0; k < 60; ++k)
        {
            const Node a = test::any_node(dice, grid, 0);
            const std::int64_t size = dice.whole(1, 9);
            const bool is_wall = dice.whole(0, 2) > 0;
            test::for_each_node(grid,
                                [&](const Node& n)
                                {
                                    if (n.x >= a.x && n.x < a.x + size && n.y >= a.y &&
                                        n.y < a.y + size && n.z >= a.z && n.z < a.z + size)
                                        nodes.at(n.x, n.y, n.z) = is_wall ? wall_mk : 0;
                                });
        }
        const RunField field = test::runs_of(nodes);
        CavityOptions options;
        options.seed = test::any_node(dice, grid, 0);
        options.gap_nodes = static_cast<int>(dice.whole(0, 2));
        options.up = Vec3{dice.real(-1, 1), dice.real(-1, 1), dice.real(-1, 1)};
        options.up = options.up / norm(options.up);
        try
        {
            const Cavity one = find_cavity(field, options, 1);
            const Cavity eight = find_cavity(field, options, 8);
            ASSERT_TRUE(one.nodes == eight.nodes);
            ASSERT_EQ(one.gaps.size(), eight.gaps.size());
            ASSERT_EQ(one.opening.has_value(), eight.opening.has_value());
            // Only empty nodes, and the seed is among them unless the way out leads down.
            const DenseSet filled = dense(grid, one.nodes);
            test::for_each_node(grid,
                                [&](const Node& n)
                                {
                                    const bool is_filled = filled.at(n.x, n.y, n.z) != 0;
                                    ASSERT_FALSE(is_filled && nodes.at(n.x, n.y, n.z) != 0);
                                });
            const bool has_seed = filled.at(options.seed.x, options.seed.y, options.seed.z) != 0;
            ASSERT_TRUE(one.opening || has_seed);
            ++found;
        }
        catch (const GeometryError&)
        {
        }
    }
    EXPECT_GT(found, 50);
}

} // namespace
} // namespace fppg
