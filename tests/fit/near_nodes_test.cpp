#include "fit/near_nodes.h"

#include "meshes/test_shapes.h"

#include <gtest/gtest.h>

namespace fppg
{
namespace
{

using namespace test;

/// Every facet as `n` times `n` of the same plane.
TriangleSoup cut_up(const TriangleSoup& soup, int n)
{
    TriangleSoup out;
    for (std::size_t f = 0; f < soup.size(); ++f)
    {
        const Vec3* p = &soup.vertices[3 * f];
        const auto at = [&](int i, int k)
        {
            return p[0] + (static_cast<double>(i) / n) * (p[1] - p[0]) +
                   (static_cast<double>(k) / n) * (p[2] - p[0]);
        };
        for (int i = 0; i < n; ++i)
            for (int k = 0; i + k < n; ++k)
            {
                add_facet(out, at(i, k), at(i + 1, k), at(i, k + 1));
                if (i + k + 1 < n) add_facet(out, at(i + 1, k), at(i + 1, k + 1), at(i, k + 1));
            }
    }
    return out;
}

TEST(NearNodes, AreTheSameOfLargeAndOfSmallFacets)
{
    const LatticeGrid grid{.origin = {-0.31, -0.27, -0.29},
                           .dp = 0.1,
                           .n = {16, 17, 18},
                           .stretch = {1.03, 0.98, 0.99}};
    const TriangleSoup large = hexahedron({Vec3{0, 0, 0},
                                           {0.8, 0.1, 0},
                                           {0.9, 0.9, 0.2},
                                           {0, 0.8, 0.1},
                                           {0.1, 0, 0.9},
                                           {0.7, 0, 0.8},
                                           {0.8, 0.8, 0.9},
                                           {0, 0.7, 0.7}});
    const auto expected = find_near_nodes(large, grid, 1);
    // About 1 and 100 facets a dp^2.
    for (const int n : {6, 60})
    {
        const auto found = find_near_nodes(cut_up(large, n), grid, 2);
        ASSERT_EQ(found.size(), expected.size());
        std::size_t count = 0;
        for (std::size_t x = 0; x < found.size(); ++x)
        {
            ASSERT_EQ(found[x].size(), expected[x].size());
            for (std::size_t i = 0; i < found[x].size(); ++i)
            {
                EXPECT_EQ(found[x][i].y, expected[x][i].y);
                EXPECT_EQ(found[x][i].z, expected[x][i].z);
                EXPECT_NEAR(found[x][i].distance, expected[x][i].distance, 1);
            }
            count += found[x].size();
        }
        EXPECT_GT(count, 500u);
    }
}

} // namespace
} // namespace fppg
