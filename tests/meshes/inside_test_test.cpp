#include "meshes/inside_test.h"

#include <random>

#include <gtest/gtest.h>

#include "meshes/test_shapes.h"

namespace fppg
{
namespace
{

using test::box;
using test::octahedron;
using test::sphere;

TEST(InsideTest, IsExactWhereEveryLineMeetsVerticesOrEdges)
{
    const InsideTest test(octahedron(1));
    // Every axis through these points meets a vertex or runs along edges of the octahedron.
    EXPECT_TRUE(test.is_inside({0, 0, 0}));
    EXPECT_TRUE(test.is_inside({0.5, 0, 0}));
    EXPECT_TRUE(test.is_inside({0, -0.25, 0.5}));
    EXPECT_FALSE(test.is_inside({0, 0, 1.0000001}));
    EXPECT_FALSE(test.is_inside({-2, 0, 0}));
    EXPECT_FALSE(test.is_inside({0.75, 0.75, 0}));
}

TEST(InsideTest, AgreesWithTheDistanceOfRandomPointsFromTheMiddleOfASphere)
{
    const InsideTest test(sphere(4));
    std::mt19937 random(7);
    std::uniform_real_distribution<double> coordinate(-1.2, 1.2);
    for (int i = 0; i < 5000; ++i)
    {
        const Vec3 p{coordinate(random), coordinate(random), coordinate(random)};
        const double r = norm(p);
        if (r > 0.99 && r < 1) continue; // between the facets and the sphere
        EXPECT_EQ(test.is_inside(p), r < 1) << p.x << ' ' << p.y << ' ' << p.z;
    }
}

TEST(InsideTest, CountsHowOftenFacetsWindAroundAPoint)
{
    TriangleSoup soup = box({0, 0, 0}, {2, 2, 2});
    const TriangleSoup second = box({1, 0, 0}, {3, 2, 2});
    soup.vertices.insert(soup.vertices.end(), second.vertices.begin(), second.vertices.end());
    TriangleSoup inwards = box({10, 0, 0}, {12, 2, 2});
    for (std::size_t i = 0; i < inwards.vertices.size(); i += 3)
        std::swap(inwards.vertices[i], inwards.vertices[i + 1]);
    soup.vertices.insert(soup.vertices.end(), inwards.vertices.begin(), inwards.vertices.end());
    const InsideTest test(soup);
    EXPECT_EQ(test.winding({0.5, 1, 1}), 1);
    EXPECT_EQ(test.winding({1.5, 1, 1}), 2);
    EXPECT_EQ(test.winding({2.5, 1, 1}), 1);
    EXPECT_EQ(test.winding({5, 1, 1}), 0);
    EXPECT_EQ(test.winding({11, 1, 1}), -1);
}

TEST(InsideTest, AHoleChangesNothingButWhatIsBeforeIt)
{
    TriangleSoup soup = sphere(3);
    // Take out the facets within 0.4 of the top.
    std::vector<Vec3> kept;
    for (std::size_t i = 0; i < soup.vertices.size(); i += 3)
        if (norm(soup.vertices[i] - Vec3{0, 0, 1}) > 0.4)
            kept.insert(kept.end(), {soup.vertices[i], soup.vertices[i + 1], soup.vertices[i + 2]});
    ASSERT_LT(kept.size(), soup.vertices.size());
    soup.vertices = kept;
    const InsideTest test(soup);
    EXPECT_TRUE(test.is_inside({0, 0, 0}));
    EXPECT_TRUE(test.is_inside({0.1, 0.1, 0.6}));
    EXPECT_TRUE(test.is_inside({0, 0, -0.9}));
    EXPECT_FALSE(test.is_inside({0, 0, 1.3}));
    EXPECT_FALSE(test.is_inside({0.1, 0, -1.1}));
    EXPECT_FALSE(test.is_inside({0.9, 0.9, 0.5}));
}

} // namespace
} // namespace fppg
