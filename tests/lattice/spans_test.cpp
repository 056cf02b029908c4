#include "nodes/spans.h"

#include "helpers/dense_grid.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

namespace fppg
{
namespace
{

using test::Dense;
using test::DenseMks;
using test::DenseSet;

/// One slab of 5 rows of 12 nodes.
LatticeGrid one_slab()
{
    LatticeGrid grid;
    grid.dp = 1;
    grid.n = {1, 5, 12};
    return grid;
}

DenseSet any_set()
{
    DenseSet set(one_slab());
    for (char& v : set.values) v = *rc::gen::inRange(0, 2) != 0;
    return set;
}

Spans spans_of(const DenseSet& set)
{
    Spans out;
    test::for_each_node(set.grid,
                        [&](const Node& n)
                        {
                            if (!set.at(n.x, n.y, n.z)) return;
                            const auto y = static_cast<std::uint32_t>(n.y);
                            const auto z = static_cast<std::uint32_t>(n.z);
                            if (!out.empty() && out.back().y == y && out.back().z_end == z)
                                ++out.back().z_end;
                            else
                                out.push_back({y, z, z + 1});
                        });
    return out;
}

template <typename Rule>
Spans combined(const DenseSet& a, const DenseSet& b, const Rule& rule)
{
    DenseSet out(a.grid);
    for (std::size_t i = 0; i < a.values.size(); ++i)
        out.values[i] = rule(a.values[i] != 0, b.values[i] != 0);
    return spans_of(out);
}

NodeBox any_box()
{
    NodeBox box;
    for (std::size_t axis = 0; axis < 3; ++axis)
    {
        const int size = axis == 0 ? 1 : axis == 1 ? 5 : 12;
        box.begin[axis] = *rc::gen::inRange(0, size + 1);
        box.end[axis] = *rc::gen::inRange(0, size + 1);
    }
    box.begin[0] = 0;
    box.end[0] = 1;
    return box;
}

RC_GTEST_PROP(Spans, UniteIntersectAndSubtractAsSetsOfNodesDo, ())
{
    const DenseSet a = any_set();
    const DenseSet b = any_set();
    RC_ASSERT(unite(spans_of(a), spans_of(b)) ==
              combined(a, b, [](bool p, bool q) { return p || q; }));
    RC_ASSERT(intersect(spans_of(a), spans_of(b)) ==
              combined(a, b, [](bool p, bool q) { return p && q; }));
    RC_ASSERT(subtract(spans_of(a), spans_of(b)) ==
              combined(a, b, [](bool p, bool q) { return p && !q; }));
}

RC_GTEST_PROP(Spans, ComplementAndClipStayInTheirBox, ())
{
    const DenseSet a = any_set();
    const NodeBox box = any_box();
    const DenseSet in_box = test::where(a.grid,
                                        [&](const Node& n) {
                                            return n.y >= box.begin[1] && n.y < box.end[1] &&
                                                   n.z >= box.begin[2] && n.z < box.end[2];
                                        });
    RC_ASSERT(clip_to_box(spans_of(a), box) ==
              combined(a, in_box, [](bool p, bool q) { return p && q; }));
    RC_ASSERT(complement(spans_of(a), box) ==
              combined(a, in_box, [](bool p, bool q) { return !p && q; }));
}

RC_GTEST_PROP(Spans, SortAndJoinTakesAnyOrderAndOverlap, ())
{
    DenseSet expected(one_slab());
    Spans spans;
    const int count = *rc::gen::inRange(0, 20);
    for (int i = 0; i < count; ++i)
    {
        const auto y = static_cast<std::uint32_t>(*rc::gen::inRange(0, 5));
        const auto begin = static_cast<std::uint32_t>(*rc::gen::inRange(0, 12));
        spans.push_back(
            {y, begin,
             static_cast<std::uint32_t>(*rc::gen::inRange<int>(static_cast<int>(begin) + 1, 13))});
    }
    test::add(expected, 0, spans);
    sort_and_join(spans);
    RC_ASSERT(spans == spans_of(expected));
}

RC_GTEST_PROP(Paint, GivesTheNodesTheirMkAndLeavesTheOthers, ())
{
    DenseMks nodes(one_slab());
    std::vector<Run> runs;
    const int strokes = *rc::gen::inRange(1, 8);
    for (int i = 0; i < strokes; ++i)
    {
        const auto mk = static_cast<std::uint16_t>(*rc::gen::inRange(0, 4));
        const DenseSet stroke = any_set();
        for (std::size_t k = 0; k < nodes.values.size(); ++k)
            if (stroke.values[k]) nodes.values[k] = mk;
        paint(runs, spans_of(stroke), mk);
        RC_ASSERT(runs == test::runs_of(nodes).slabs[0]);
    }
}

RC_GTEST_PROP(Select, FindsTheNodesOfTheWantedMks, ())
{
    DenseMks nodes(one_slab());
    for (auto& v : nodes.values) v = static_cast<std::uint16_t>(*rc::gen::inRange(0, 4));
    std::vector<char> wanted(65536, 0);
    for (std::size_t mk = 0; mk < 4; ++mk) wanted[mk] = *rc::gen::inRange(0, 2) != 0;
    DenseSet chosen(nodes.grid);
    DenseSet all(nodes.grid);
    for (std::size_t i = 0; i < nodes.values.size(); ++i)
    {
        all.values[i] = nodes.values[i] != 0;
        chosen.values[i] = nodes.values[i] != 0 && wanted[nodes.values[i]];
    }
    const std::vector<Run> runs = test::runs_of(nodes).slabs[0];
    RC_ASSERT(select(runs, wanted) == spans_of(chosen));
    RC_ASSERT(occupied(runs) == spans_of(all));
}

} // namespace
} // namespace fppg
