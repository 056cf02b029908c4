#include "fit/inside_angles.h"

#include "fit/fit_shapes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace fppg
{
namespace
{

using namespace test;

/// Of one particle on each vertex, or in the middle of each edge of a mesh.
double share_of(const SurfaceMesh& mesh, FitKind kind, bool is_2d = false)
{
    std::vector<Vec3> places;
    std::vector<std::uint32_t> facets;
    if (kind == FitKind::Corner)
        for (std::uint32_t f = 0; f < mesh.facets.size(); ++f)
        {
            places.push_back(mesh.vertices[mesh.facets[f][0]]);
            facets.push_back(f);
        }
    else
        for (std::size_t e = 0; e < mesh.edges.size(); ++e)
        {
            const auto& ends = mesh.edges[e];
            // In 2D those that the plane of particles crosses.
            if (is_2d && mesh.vertices[ends[0]].y == mesh.vertices[ends[1]].y) continue;
            places.push_back(0.5 * (mesh.vertices[ends[0]] + mesh.vertices[ends[1]]));
            facets.push_back(mesh.edge_facets[e][0]);
        }
    const std::vector<FitKind> kinds(places.size(), kind);
    return mean_share_inside(mesh, {places, kinds, facets}, is_2d);
}

SurfaceMesh repaired(const TriangleSoup& soup)
{
    MeshReport report;
    return repair_mesh(soup, {}, 1, report);
}

TEST(InsideAngles, AreThoseOfRegularSolids)
{
    EXPECT_NEAR(share_of(repaired(octahedron(1)), FitKind::Corner),
                std::asin(1.0 / 3) / std::numbers::pi, 1e-12);
    EXPECT_NEAR(share_of(repaired(octahedron(1)), FitKind::Edge),
                std::acos(-1.0 / 3) / (2 * std::numbers::pi), 1e-12);
    EXPECT_NEAR(share_of(repaired(box({0, 0, 0}, {1, 2, 3})), FitKind::Corner), 0.125, 1e-12);
}

TEST(InsideAngles, OfAnInnerFaceAreTheRest)
{
    TriangleSoup hollow = box({0, 0, 0}, {1, 1, 1});
    for (std::size_t i = 0; i < hollow.vertices.size(); i += 3)
        std::swap(hollow.vertices[i], hollow.vertices[i + 1]);
    const TriangleSoup both = joined(box({-1, -1, -1}, {2, 2, 2}), hollow);
    // Eight corners of an eighth, eight of seven eighths.
    EXPECT_NEAR(share_of(repaired(both), FitKind::Corner), 0.5, 1e-12);
}

TEST(InsideAngles, OfGearsAreBothConvexAndConcave)
{
    // Each tooth has two convex edges along its height and two concave ones: a whole turn of 2 pi
    // comes from all of them.
    constexpr int teeth = 9;
    const SurfaceMesh mesh = repaired(gear(teeth, 0.8, 1.0, 0.5));
    std::vector<Vec3> places;
    std::vector<std::uint32_t> facets;
    for (std::size_t e = 0; e < mesh.edges.size(); ++e)
    {
        const Vec3 a = mesh.vertices[mesh.edges[e][0]], b = mesh.vertices[mesh.edges[e][1]];
        if (std::hypot(a.x - b.x, a.y - b.y) > 1e-9) continue;
        places.push_back(0.5 * (a + b));
        facets.push_back(mesh.edge_facets[e][0]);
    }
    ASSERT_EQ(places.size(), 4u * teeth);
    const std::vector<FitKind> kinds(places.size(), FitKind::Edge);
    EXPECT_NEAR(mean_share_inside(mesh, {places, kinds, facets}, false), 0.5 - 1.0 / (4 * teeth),
                1e-12);
}

TEST(InsideAngles, AreThoseInThePlaneOfASection)
{
    // A tetrahedron's edges, cut by a plane, meet it under an angle: a triangle has half a turn.
    TriangleSoup soup;
    const Vec3 a{1, -1, -1}, b{-1, -1, -1}, c{0, -1, 1}, top{0.3, 2, 0.2};
    add_facet(soup, a, b, c);
    add_facet(soup, b, a, top);
    add_facet(soup, c, b, top);
    add_facet(soup, a, c, top);
    MeshReport report;
    const SurfaceMesh mesh = repair_mesh(soup, {}, 1, report);
    ASSERT_GT(report.volume, 0);
    EXPECT_NEAR(share_of(mesh, FitKind::Edge, true), 1.0 / 6, 1e-12);
}

TEST(InsideAngles, OfOpenEdgesAreHalves)
{
    TriangleSoup soup;
    add_quad(soup, {0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0});
    EXPECT_EQ(share_of(repaired(soup), FitKind::Corner), 0.5);
}

} // namespace
} // namespace fppg
