#pragma once

#include <cstdint>
#include <vector>

#include <gtest/gtest.h>

#include "fppg/lattice.h"
#include "fppg/shapes.h"

namespace fppg::test
{

inline Vec3 node(const LatticeGrid& grid, std::uint32_t i, std::uint32_t j, std::uint32_t k)
{
    return grid.place(static_cast<double>(i), static_cast<double>(j), static_cast<double>(k));
}

/// A cube of n x n x n nodes.
inline LatticeGrid cube_grid(const Vec3& origin, double dp, std::uint32_t n)
{
    LatticeGrid grid;
    grid.origin = origin;
    grid.dp = dp;
    grid.n = {n, n, n};
    return grid;
}

/// One entry a node, x slowest, z fastest; checks on the way that spans are sorted and apart.
inline std::vector<bool> nodes_of(const SpanSet& set, const LatticeGrid& grid)
{
    std::vector<bool> nodes(std::size_t{grid.n[0]} * grid.n[1] * grid.n[2], false);
    EXPECT_LE(set.x_begin + set.slabs.size(), grid.n[0]);
    for (std::size_t slab = 0; slab < set.slabs.size(); ++slab)
    {
        const Span* last = nullptr;
        for (const Span& span : set.slabs[slab])
        {
            EXPECT_LT(span.y, grid.n[1]);
            EXPECT_LT(span.z_begin, span.z_end);
            EXPECT_LE(span.z_end, grid.n[2]);
            if (last != nullptr)
            {
                EXPECT_TRUE(last->y < span.y || (last->y == span.y && last->z_end < span.z_begin));
            }
            last = &span;
            for (std::uint32_t k = span.z_begin; k < span.z_end; ++k)
                nodes[((set.x_begin + slab) * grid.n[1] + span.y) * grid.n[2] + k] = true;
        }
    }
    return nodes;
}

/// Asserts that exactly those nodes are inside for which the predicate holds.
template <typename IsInside>
void expect_nodes(const TriangleSoup& soup, const LatticeGrid& grid, const IsInside& is_inside)
{
    const std::vector<bool> nodes = nodes_of(inside_spans(soup, grid, 1), grid);
    std::size_t at = 0;
    for (std::uint32_t i = 0; i < grid.n[0]; ++i)
        for (std::uint32_t j = 0; j < grid.n[1]; ++j)
            for (std::uint32_t k = 0; k < grid.n[2]; ++k, ++at)
            {
                const Vec3 p = node(grid, i, j, k);
                ASSERT_EQ(nodes[at], is_inside(p))
                    << "(" << p.x << ", " << p.y << ", " << p.z << ")";
            }
}

inline std::size_t count_nodes(const SpanSet& set)
{
    std::size_t count = 0;
    for (const auto& slab : set.slabs)
        for (const Span& span : slab) count += span.z_end - span.z_begin;
    return count;
}

} // namespace fppg::test
