// Which facets are asked for those around them.

#include "meshes/small_pieces.h"

#include "meshes/test_shapes.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace fppg
{
namespace
{

/// Two sheets that face away from each other, nearer than a cell is wide, in facets of 0.02.
SurfaceMesh thin_plate()
{
    constexpr int n = 50;
    TriangleSoup soup;
    for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j)
            for (const double z : {0.0, 0.01})
            {
                const auto at = [&](int x, int y) { return Vec3{0.02 * x, 0.02 * y, z}; };
                if (z > 0)
                    test::add_quad(soup, at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1));
                else
                    test::add_quad(soup, at(i, j), at(i, j + 1), at(i + 1, j + 1), at(i + 1, j));
            }
    MeshReport report;
    return repair_mesh(soup, {}, 1, report);
}

TEST(SmallPieces, OneInACellIsAskedForThoseThatFaceItsWay)
{
    const SurfaceMesh plate = thin_plate();
    ASSERT_EQ(plate.facets.size(), 10000);
    const double size = 0.1;
    const std::vector<AskedFacet> asked = facets_to_ask(plate, size, 1);
    // 10 x 10 cells on each side.
    EXPECT_EQ(asked.size(), 200);
    double up = 0, down = 0;
    for (const AskedFacet& a : asked) (plate.normals[a.facet].z > 0 ? up : down) += a.area;
    EXPECT_NEAR(up, 1, 1e-6);
    EXPECT_NEAR(down, 1, 1e-6);
    for (const int threads : {2, 5})
    {
        const std::vector<AskedFacet> again = facets_to_ask(plate, size, threads);
        ASSERT_EQ(again.size(), asked.size());
        for (std::size_t i = 0; i < asked.size(); ++i) EXPECT_EQ(again[i].facet, asked[i].facet);
    }
}

TEST(SmallPieces, LargeOnesAreAllAsked)
{
    const SurfaceMesh plate = thin_plate();
    EXPECT_EQ(facets_to_ask(plate, 0.02, 1).size(), plate.facets.size());
}

TEST(SmallPieces, ThoseOfTwoKindsDoNotStandForOneAnother)
{
    const std::vector<SmallPiece> pieces{{{0.1, 0.1, 0.1}, {0, 0, 1}, 1, true},
                                         {{0.5, 0.5, 0.5}, {0, 0, 1}, 2, true},
                                         {{0.6, 0.5, 0.5}, {0, 0, 1}, 1, true},
                                         {{0.5, 0.5, 0.5}, {0, 0, 1}, 1, false},
                                         {{0.5, 0.5, 0.5}, {0, 0, -1}, 1, true}};
    const PiecesToAsk asked = pieces_to_ask(pieces, 1, 1);
    EXPECT_EQ(asked.for_each, (std::vector<std::uint32_t>{2, 1, 2, 3, 4}));
    std::vector<std::uint32_t> order = asked.order;
    std::sort(order.begin(), order.end());
    EXPECT_EQ(order, (std::vector<std::uint32_t>{1, 2, 3, 4}));
}

} // namespace
} // namespace fppg
