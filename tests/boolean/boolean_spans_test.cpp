// Node sets of combinations.
#include "boolean/boolean_parts.h"

#include <gtest/gtest.h>

namespace fppg
{
namespace
{

using namespace test;

LatticeGrid grid_of(double dp)
{
    LatticeGrid grid;
    // Off the raster of aligned parts.
    grid.origin = {-2.313, -2.207, -2.119};
    grid.dp = dp;
    const auto n = static_cast<std::uint32_t>(4.6 / dp);
    grid.n = {n, n, n};
    return grid;
}

/// One entry a node, x slowest.
std::vector<char> dense(const SpanSet& set, const LatticeGrid& grid)
{
    std::vector<char> out(static_cast<std::size_t>(grid.n[0]) * grid.n[1] * grid.n[2], 0);
    for (std::size_t i = 0; i < set.slabs.size(); ++i)
        for (const Span& s : set.slabs[i])
            for (std::uint32_t z = s.z_begin; z < s.z_end; ++z)
                ++out[((set.x_begin + i) * grid.n[1] + s.y) * grid.n[2] + z];
    return out;
}

BooleanNode tree_of(unsigned seed, std::uint32_t n)
{
    const auto op = static_cast<BooleanOp>(1 + seed % 3);
    if (n == 2) return of_two(op);
    return combined(op, {of_two(static_cast<BooleanOp>(1 + seed / 3 % 3)), leaf(2)});
}

TEST(BooleanSpans, AreTheSetOperationOfThePartsNodes)
{
    const LatticeGrid grid = grid_of(0.1);
    for (unsigned seed = 1; seed <= 200; ++seed)
    {
        std::mt19937 random(seed);
        const std::uint32_t n = 2 + seed % 2;
        PartList list;
        std::vector<SpanSet> sets;
        std::vector<std::vector<char>> is_in;
        for (std::uint32_t i = 0; i < n; ++i)
        {
            list.add(any_part(random, Placing::Random));
            sets.push_back(solid_nodes(list.meshes.back(), grid, 1));
            is_in.push_back(dense(sets.back(), grid));
        }
        const BooleanNode tree = tree_of(seed, n);
        const SpanSet nodes = boolean_spans(sets, tree, 1);
        const std::vector<char> result = dense(nodes, grid);
        std::vector<char> expected(result.size());
        std::vector<char> at(n);
        for (std::size_t k = 0; k < result.size(); ++k)
        {
            for (std::uint32_t i = 0; i < n; ++i) at[i] = is_in[i][k];
            expected[k] = evaluate(tree, at);
        }
        EXPECT_EQ(result, expected) << "seed " << seed;
        // The surface of the combination bounds the same nodes.
        const BooleanMesh surface = list.run(tree);
        if (surface.mesh.facets.empty()) continue;
        EXPECT_EQ(dense(solid_nodes(surface.mesh, grid, 1), grid), expected) << "seed " << seed;
    }
}

TEST(BooleanSpans, EachNodeBelongsToTheFirstPartThatStays)
{
    const LatticeGrid grid = grid_of(0.05);
    PartList list;
    list.add(box({-1, -1, -1}, {1, 1, 1}));
    list.add(box({0, 0, 0}, {2, 2, 2}));
    list.add(box({0.5, 0.5, 0.5}, {1.5, 1.5, 1.5}));
    std::vector<SpanSet> sets;
    for (const SurfaceMesh& m : list.meshes) sets.push_back(solid_nodes(m, grid, 1));
    const BooleanNode tree = combined(BooleanOp::Difference, {of_two(BooleanOp::Union), leaf(2)});
    const SpanSet nodes = boolean_spans(sets, tree, 1);
    const std::vector<SpanSet> shares = share_out(nodes, sets, tree, 1);
    EXPECT_TRUE(shares[2].slabs.empty());
    const std::vector<char> all = dense(nodes, grid), first = dense(shares[0], grid),
                            second = dense(shares[1], grid), own = dense(sets[0], grid);
    for (std::size_t k = 0; k < all.size(); ++k)
    {
        ASSERT_EQ(first[k] + second[k], all[k]);
        ASSERT_EQ(first[k], all[k] != 0 && own[k] != 0 ? 1 : 0);
    }
}

TEST(BooleanSpans, CountTheVolumeWithinTheErrorOfTheLattice)
{
    const LatticeGrid grid = grid_of(0.05);
    PartList list;
    list.add(moved(sphere(4), placed({10, 20, 30}, 1, {-0.3, 0.1, 0})));
    list.add(moved(sphere(4), placed({40, 50, 60}, 1, {0.4, 0, 0.2})));
    for (const BooleanOp op : {BooleanOp::Union, BooleanOp::Intersection, BooleanOp::Difference})
    {
        std::vector<SpanSet> sets;
        for (const SurfaceMesh& m : list.meshes) sets.push_back(solid_nodes(m, grid, 1));
        double count = 0;
        for (const auto& slab : boolean_spans(sets, of_two(op), 1).slabs)
            for (const Span& s : slab) count += s.z_end - s.z_begin;
        const MeshReport report = list.run(of_two(op)).report;
        const double cell = grid.dp * grid.dp * grid.dp;
        // Nodes near the surface fall to either side at random.
        EXPECT_NEAR(count * cell, report.volume, 0.1 * report.area * grid.dp);
    }
}

} // namespace
} // namespace fppg
