#include "meshes/mesh_query.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include <gtest/gtest.h>

#include "core/parallel.h"
#include "fppg/error.h"
#include "meshes/test_shapes.h"

namespace fppg
{

namespace
{

using test::box;
using test::sphere;

/// The nearest point of a triangle by the regions of its corners, edges and inside.
/// Source: C. Ericson, Real-Time Collision Detection, 2005, section 5.1.5.
Vec3 nearest_on_triangle(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c)
{
    const Vec3 ab = b - a, ac = c - a, ap = p - a, bp = p - b, cp = p - c;
    const double d1 = dot(ab, ap), d2 = dot(ac, ap);
    if (d1 <= 0 && d2 <= 0) return a;
    const double d3 = dot(ab, bp), d4 = dot(ac, bp);
    if (d3 >= 0 && d4 <= d3) return b;
    const double d5 = dot(ab, cp), d6 = dot(ac, cp);
    if (d6 >= 0 && d5 <= d6) return c;
    const double vc = d1 * d4 - d3 * d2;
    if (vc <= 0 && d1 >= 0 && d3 <= 0) return a + ab * (d1 / (d1 - d3));
    const double vb = d5 * d2 - d1 * d6;
    if (vb <= 0 && d2 >= 0 && d6 <= 0) return a + ac * (d2 / (d2 - d6));
    const double va = d3 * d6 - d5 * d4;
    if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0)
        return b + (c - b) * ((d4 - d3) / ((d4 - d3) + (d5 - d6)));
    return a + (ab * vb + ac * vc) / (va + vb + vc);
}

double distance_to_all(const TriangleSoup& soup, const Vec3& p)
{
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < soup.size(); ++i)
    {
        const Vec3* const v = &soup.vertices[3 * i];
        least = std::min(least, norm(p - nearest_on_triangle(p, v[0], v[1], v[2])));
    }
    return least;
}

std::vector<Vec3> random_points(std::size_t n, double size)
{
    std::mt19937 generator(1);
    std::uniform_real_distribution<double> coordinate(-size, size);
    std::vector<Vec3> points(n);
    for (Vec3& p : points)
        p = {coordinate(generator), coordinate(generator), coordinate(generator)};
    return points;
}

void expect_nearest(const TriangleSoup& soup, const std::vector<Vec3>& points, double tolerance_m)
{
    const MeshQuery query(soup);
    for (const Vec3& p : points)
    {
        const ClosestPoint found = query.closest_point(p);
        const Vec3* const v = &soup.vertices[3 * std::size_t{found.facet}];
        EXPECT_NEAR(found.distance, distance_to_all(soup, p), tolerance_m);
        EXPECT_NEAR(found.distance, norm(p - found.point), tolerance_m);
        EXPECT_NEAR(norm(found.point - nearest_on_triangle(found.point, v[0], v[1], v[2])), 0,
                    tolerance_m);
    }
}

} // namespace

TEST(ClosestPoint, AgreesWithAPlainSearch)
{
    expect_nearest(sphere(3), random_points(500, 2), 1e-14);
    expect_nearest(sphere(2), random_points(100, 100), 1e-12);
}

/// From inside, many facets of a ball are about as near as the nearest one.
TEST(ClosestPoint, AgreesWithAPlainSearchInsideABallOfSmallFacets)
{
    std::vector<Vec3> points = random_points(60, 0.55);
    points.push_back({0, 0, 0});
    expect_nearest(sphere(5), points, 1e-13);
}

TEST(ClosestPoint, AgreesWithAPlainSearchFarFromTheOrigin)
{
    const Vec3 offset{1e6, -1e6, 1e5};
    const Transform shift{{Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}}, offset};
    std::vector<Vec3> points = random_points(200, 2);
    for (Vec3& p : points) p = p + offset;
    expect_nearest(test::moved(sphere(3), shift), points, 1e-9);
}

TEST(ClosestPoint, AgreesWithAPlainSearchBesideAHugeFacet)
{
    TriangleSoup soup = sphere(1);
    test::add_facet(soup, {1e30, 0, 3}, {0, 1e30, 3}, {-1e30, -1e30, 3});
    expect_nearest(soup, random_points(50, 2), 1e-12);
}

/// Long oblique facets are cut into parts for their boxes, each with its apex anywhere along it.
TEST(ClosestPoint, AgreesWithAPlainSearchAmongLongObliqueFacets)
{
    TriangleSoup soup;
    for (int k = 0; k < 60; ++k)
    {
        const double t = 0.1 * k;
        const Vec3 across{0.02 * std::cos(t), 0.02 * std::sin(t), 0.01};
        const Vec3 a{std::sin(t) - 1, std::cos(t) - 1, -1};
        const Vec3 b{std::sin(t) + 1, std::cos(t) + 0.8, 1.3};
        test::add_facet(soup, a, b, a + (k % 7) / 6.0 * (b - a) + across);
        test::add_facet(soup, a + across, b, a);
    }
    test::add_facet(soup, {0, 0, 0}, {0, 0, 0}, {0, 0, 0});
    expect_nearest(soup, random_points(1000, 2), 1e-10);
}

/// Lines of a plane section and of edges are facets without an area.
TEST(ClosestPoint, AgreesWithAPlainSearchAmongLines)
{
    TriangleSoup soup;
    const std::vector<Vec3> ends = random_points(300, 1);
    for (std::size_t k = 0; k + 1 < ends.size(); k += 2)
        test::add_facet(soup, ends[k], ends[k + 1], ends[k + 1]);
    const MeshQuery query(soup);
    for (const Vec3& p : random_points(500, 1.5))
    {
        double least = std::numeric_limits<double>::infinity();
        for (std::size_t k = 0; k + 1 < ends.size(); k += 2)
        {
            const Vec3 along = ends[k + 1] - ends[k];
            const double t = std::clamp(dot(p - ends[k], along) / dot(along, along), 0.0, 1.0);
            least = std::min(least, norm(p - ends[k] - t * along));
        }
        EXPECT_NEAR(query.closest_point(p).distance, least, 1e-14);
    }
}

TEST(ClosestPoint, IsTheSameWithinALimitAndNoneBeyondIt)
{
    const MeshQuery query(sphere(3));
    for (const Vec3& p : random_points(500, 2))
    {
        const ClosestPoint all = query.closest_point(p);
        const ClosestPoint near = query.closest_point(p, all.distance);
        EXPECT_EQ(near.facet, all.facet);
        EXPECT_EQ(near.point, all.point);
        EXPECT_EQ(query.closest_point(p, 0.99 * all.distance).distance,
                  std::numeric_limits<double>::infinity());
    }
}

TEST(ClosestPoint, GivesTheSmallestFacetOfATie)
{
    const MeshQuery query(box({-1, -1, -1}, {1, 1, 1}));
    EXPECT_EQ(query.closest_point({0, 0, 0}).facet, 0u);
    EXPECT_EQ(query.closest_point({0, 0, 0}).distance, 1.0);
    EXPECT_EQ(query.closest_point({0, 0, 5}).facet, 2u);
    EXPECT_EQ(query.closest_point({2, 2, 2}).point, (Vec3{1, 1, 1}));
}

TEST(ClosestPoint, IsExactOnAnEdge)
{
    const ClosestPoint found = MeshQuery(box({0, 0, 0}, {1, 1, 1})).closest_point({0.3, -1, -1});
    EXPECT_EQ(found.point, (Vec3{0.3, 0, 0}));
    EXPECT_EQ(found.facet, 1u);
}

TEST(ClosestPoint, IsTheSameFromManyThreads)
{
    const MeshQuery query(sphere(4), 2);
    const std::vector<Vec3> points = random_points(5000, 2);
    std::vector<ClosestPoint> one(points.size());
    std::vector<ClosestPoint> eight(points.size());
    parallel_for(points.size(), 1, [&](std::size_t i) { one[i] = query.closest_point(points[i]); });
    parallel_for(points.size(), 8,
                 [&](std::size_t i) { eight[i] = query.closest_point(points[i]); });
    for (std::size_t i = 0; i < points.size(); ++i)
    {
        EXPECT_EQ(one[i].point, eight[i].point);
        EXPECT_EQ(one[i].facet, eight[i].facet);
    }
}

TEST(Crossings, AreTwoThroughABoxAlongEveryAxis)
{
    const MeshQuery query(box({-1, -2, -3}, {1, 2, 3}));
    for (int axis = 0; axis < 3; ++axis)
    {
        Vec3 origin{0.125, 0.25, 0.5};
        origin[axis] = -10;
        const auto found = query.crossings(origin, axis);
        ASSERT_EQ(found.size(), 2u);
        EXPECT_EQ(found[0].position, -1.0 - axis);
        EXPECT_EQ(found[0].step, 1);
        EXPECT_EQ(found[1].position, 1.0 + axis);
        EXPECT_EQ(found[1].step, -1);
    }
}

TEST(Crossings, CountAnEdgeOnce)
{
    const MeshQuery query(box({-1, -1, -1}, {1, 1, 1}));
    for (int axis = 0; axis < 3; ++axis)
    {
        Vec3 origin{0, 0, 0}; // on the diagonals of all six sides
        EXPECT_EQ(query.crossings(origin, axis).size(), 1u);
        origin[axis] = -5;
        EXPECT_EQ(query.crossings(origin, axis).size(), 2u);
    }
    EXPECT_EQ(query.crossings({-1, -1, -5}, 2).size(), 2u);
    EXPECT_EQ(query.crossings({1, 1, -5}, 2).size(), 0u);
}

TEST(Crossings, FindEveryOneOfManyLayers)
{
    TriangleSoup soup;
    for (int layer = 0; layer < 100; ++layer)
        soup = test::joined(soup, box({-1, -1, 3.0 * layer}, {1, 1, 3.0 * layer + 1}));
    const auto found = MeshQuery(soup).crossings({0.3, 0.1, -1}, 2);
    ASSERT_EQ(found.size(), 200u);
    for (std::size_t i = 0; i < 200; ++i)
    {
        const std::size_t position = 3 * (i / 2) + i % 2;
        EXPECT_EQ(found[i].position, static_cast<double>(position));
        EXPECT_EQ(found[i].step, i % 2 == 0 ? 1 : -1);
    }
}

TEST(Crossings, BeginAtTheOriginOfTheRay)
{
    const MeshQuery query(sphere(3));
    EXPECT_EQ(query.crossings({0.1, 0.2, 0}, 2).size(), 1u);
    EXPECT_EQ(query.crossings({0.1, 0.2, 3}, 2).size(), 0u);
    EXPECT_EQ(query.crossings({5, 0.2, -3}, 2).size(), 0u);
}

TEST(MeshQuery, RefusesAMeshWithoutFacets)
{
    EXPECT_THROW(MeshQuery(TriangleSoup{}), GeometryError);
}

} // namespace fppg
