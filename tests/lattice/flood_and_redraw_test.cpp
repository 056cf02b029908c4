#include "helpers/dense_grid.h"
#include "lattice/flood.h"
#include "lattice/redraw.h"

#include <gtest/gtest.h>
#include <array>
#include <set>

#include <algorithm>

namespace fppg
{
namespace
{

using test::any_node;
using test::dense;
using test::DenseMks;
using test::DenseSet;
using test::Dice;
using test::difference;

constexpr std::uint16_t bound_first = 3; // mk 1, 2 are fluid, 3, 4 are bound

LatticeGrid grid_of(Dice& dice)
{
    LatticeGrid grid = test::any_grid(dice);
    for (auto& n : grid.n) n = static_cast<std::uint32_t>(dice.whole(1, 10));
    return grid;
}

/// Nodes with values that come in clumps, so that floods get somewhere.
DenseMks any_field(Dice& dice, const LatticeGrid& grid)
{
    DenseMks nodes(grid);
    for (int i = 0; i < 14; ++i)
    {
        const Node a = any_node(dice, grid, 1);
        const Node b = any_node(dice, grid, 1);
        const auto mk = static_cast<std::uint16_t>(dice.whole(0, 4));
        test::for_each_node(grid,
                            [&](const Node& n)
                            {
                                bool inside = true;
                                for (int axis = 0; axis < 3; ++axis)
                                    inside = inside && n[axis] >= std::min(a[axis], b[axis]) &&
                                             n[axis] <= std::max(a[axis], b[axis]);
                                if (inside && dice.whole(0, 3) > 0) nodes.at(n.x, n.y, n.z) = mk;
                            });
    }
    return nodes;
}

NodeBox any_box(Dice& dice, const LatticeGrid& grid)
{
    if (dice.coin()) return whole_lattice(grid);
    const Node a = any_node(dice, grid, 2);
    const Node b = any_node(dice, grid, 2);
    NodeBox box;
    for (int axis = 0; axis < 3; ++axis)
    {
        box.begin[static_cast<std::size_t>(axis)] = std::min(a[axis], b[axis]);
        box.end[static_cast<std::size_t>(axis)] = std::max(a[axis], b[axis]) + 1;
    }
    return intersect(box, whole_lattice(grid));
}

bool is_in(const NodeBox& box, const Node& n)
{
    for (int axis = 0; axis < 3; ++axis)
        if (n[axis] < box.begin[static_cast<std::size_t>(axis)] ||
            n[axis] >= box.end[static_cast<std::size_t>(axis)])
            return false;
    return true;
}

DenseSet plain_flood(const DenseSet& allowed, const Node& seed)
{
    DenseSet reached(allowed.grid);
    std::vector<Node> open{seed};
    while (!open.empty())
    {
        const Node n = open.back();
        open.pop_back();
        if (!is_inside(n, allowed.grid) || !allowed.at(n.x, n.y, n.z) || reached.at(n.x, n.y, n.z))
            continue;
        reached.at(n.x, n.y, n.z) = 1;
        for (const int d : {-1, 1})
        {
            open.push_back({n.x + d, n.y, n.z});
            open.push_back({n.x, n.y + d, n.z});
            open.push_back({n.x, n.y, n.z + d});
        }
    }
    return reached;
}

TEST(Flood, ReachesWhatAPlainSearchOverSixNeighboursReaches)
{
    Dice dice(11);
    for (int i = 0; i < 800; ++i)
    {
        const LatticeGrid grid = grid_of(dice);
        const DenseMks nodes = any_field(dice, grid);
        std::vector<char> fillable(65536, 0);
        for (std::size_t mk = 0; mk < 5; ++mk) fillable[mk] = dice.coin();
        const NodeBox box = any_box(dice, grid);
        const Node seed = any_node(dice, grid, 1);
        SpanSet mask;
        const bool is_masked = dice.coin();
        DenseSet allowed(grid);
        DenseSet in_mask(grid);
        test::for_each_node(
            grid, [&](const Node& n) { in_mask.at(n.x, n.y, n.z) = dice.whole(0, 4) > 0; });
        if (is_masked)
        {
            mask.x_begin = static_cast<std::uint32_t>(dice.whole(0, grid.n[0] - 1));
            for (std::int64_t x = mask.x_begin; x < grid.n[0]; ++x)
            {
                Spans spans;
                for (std::uint32_t y = 0; y < grid.n[1]; ++y)
                    for (std::uint32_t z = 0; z < grid.n[2]; ++z)
                        if (in_mask.at(x, y, z)) spans.push_back({y, z, z + 1});
                sort_and_join(spans);
                mask.slabs.push_back(spans);
            }
        }
        test::for_each_node(
            grid,
            [&](const Node& n)
            {
                allowed.at(n.x, n.y, n.z) =
                    is_in(box, n) && fillable[nodes.at(n.x, n.y, n.z)] &&
                    (!is_masked || (n.x >= mask.x_begin && in_mask.at(n.x, n.y, n.z)));
            });
        const RunField field = test::runs_of(nodes);
        for (const int threads : {1, 8})
            ASSERT_EQ(difference(dense(grid, flood(field, seed, fillable, box,
                                                   is_masked ? &mask : nullptr, threads)),
                                 plain_flood(allowed, seed)),
                      "")
                << "case " << i << ", " << threads << " threads";
    }
}

TEST(FillableMks, AreTheNamedOnesOrWithBorderTheOthers)
{
    FillFilter filter;
    filter.names = {true, false, true}; // void and fluid
    filter.mkfluid = 2;
    const std::vector<char> named = fillable_mks(filter, bound_first);
    EXPECT_EQ(std::vector<char>(named.begin(), named.begin() + 5),
              (std::vector<char>{1, 0, 1, 0, 0}));
    filter.border = true;
    const std::vector<char> others = fillable_mks(filter, bound_first);
    EXPECT_EQ(std::vector<char>(others.begin(), others.begin() + 5),
              (std::vector<char>{0, 1, 0, 1, 1}));
}

MkFilter any_filter(Dice& dice)
{
    MkFilter filter;
    filter.kind = dice.one_of({MkKind::Void, MkKind::Bound, MkKind::Fluid});
    if (filter.kind != MkKind::Void && dice.coin())
        filter.mk = static_cast<std::uint16_t>(
            dice.whole(filter.kind == MkKind::Bound ? 3 : 1, filter.kind == MkKind::Bound ? 4 : 2));
    return filter;
}

bool passes(const MkFilter& filter, std::uint16_t mk)
{
    const MkKind kind = mk == 0 ? MkKind::Void : mk >= bound_first ? MkKind::Bound : MkKind::Fluid;
    return kind == filter.kind && (!filter.mk || *filter.mk == mk);
}

TEST(RedrawNearNodes, AreTargetsWithANeighbourOfTheBorderType)
{
    Dice dice(12);
    for (int i = 0; i < 800; ++i)
    {
        const LatticeGrid grid = grid_of(dice);
        const DenseMks nodes = any_field(dice, grid);
        const NodeBox box = any_box(dice, grid);
        RedrawNearOp op;
        op.target = any_filter(dice);
        op.border = any_filter(dice);
        if (dice.coin())
            for (bool& d : op.directions) d = dice.coin();
        const bool all =
            std::none_of(op.directions.begin(), op.directions.end(), [](bool d) { return d; });
        // A target lies in the direction that is named, seen from the border node: top is above it.
        const std::array<Node, 6> steps{Node{0, 0, 1}, {0, 0, -1}, {1, 0, 0},
                                        {-1, 0, 0},    {0, 1, 0},  {0, -1, 0}};
        const auto is_border = [&](const Node& n)
        { return is_inside(n, grid) && passes(op.border, nodes.at(n.x, n.y, n.z)); };
        std::set<std::array<std::int64_t, 3>> marked;
        for (std::int64_t x = 0; x < grid.n[0]; ++x)
            for (std::int64_t y = 0; y < grid.n[1]; ++y)
                for (std::int64_t z = 0; z < grid.n[2]; ++z)
                {
                    // A border node that has been marked before its turn acts no more.
                    if (marked.contains({x, y, z}) || !is_border({x, y, z})) continue;
                    for (std::size_t d = 0; d < 6; ++d)
                    {
                        const Node n{x + steps[d].x, y + steps[d].y, z + steps[d].z};
                        if (op.directions[d] && is_inside(n, grid) && is_in(box, n) &&
                            passes(op.target, nodes.at(n.x, n.y, n.z)))
                            marked.insert({n.x, n.y, n.z});
                    }
                }
        const auto holds = [&](const Node& n)
        {
            if (!all) return marked.contains({n.x, n.y, n.z});
            if (!is_in(box, n) || !passes(op.target, nodes.at(n.x, n.y, n.z))) return false;
            for (std::int64_t x = -1; x <= 1; ++x)
                for (std::int64_t y = -1; y <= 1; ++y)
                    for (std::int64_t z = -1; z <= 1; ++z)
                        if (is_border({n.x + x, n.y + y, n.z + z})) return true;
            return false;
        };
        const RunField field = test::runs_of(nodes);
        for (const int threads : {1, 8})
            ASSERT_EQ(difference(dense(grid, redraw_near_nodes(field, op, box, nullptr, bound_first,
                                                               threads)),
                                 test::where(grid, holds)),
                      "")
                << "case " << i << ", " << threads << " threads";
    }
}

TEST(RedrawNodes, AreThoseThatPassAFilterOrAllWithoutOne)
{
    Dice dice(13);
    for (int i = 0; i < 300; ++i)
    {
        const LatticeGrid grid = grid_of(dice);
        const DenseMks nodes = any_field(dice, grid);
        RedrawOp op;
        if (dice.coin()) op.filters.push_back(any_filter(dice));
        if (dice.coin()) op.filters.push_back(any_filter(dice));
        // Without a filter every node is meant, and there is no box.
        const NodeBox box = op.filters.empty() ? whole_lattice(grid) : any_box(dice, grid);
        const auto holds = [&](const Node& n)
        {
            return is_in(box, n) && (op.filters.empty() ||
                                     std::any_of(op.filters.begin(), op.filters.end(),
                                                 [&](const MkFilter& f)
                                                 { return passes(f, nodes.at(n.x, n.y, n.z)); }));
        };
        ASSERT_EQ(
            difference(dense(grid, redraw_nodes(test::runs_of(nodes), op, box, bound_first, 2)),
                       test::where(grid, holds)),
            "")
            << "case " << i;
    }
}

} // namespace
} // namespace fppg
