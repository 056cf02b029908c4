#include "helpers/round_meshes.h"
#include "meshes/round_surface.h"

#include "fppg/error.h"
#include "fppg/section.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace fppg
{
namespace
{

using test::cylinder_mesh;
using test::ellipsoid_mesh;
using test::sphere_mesh;

constexpr double pi = std::numbers::pi;
constexpr double dp = 0.01;
constexpr std::array<bool, 3> all{true, true, true};

FittedBody body_of(const ShapeMesh& shape)
{
    FittedBody body;
    body.round = shape.round;
    body.mesh = repair_mesh(shape.soup, {}, 1, body.report);
    body.features = find_features(body.mesh, {});
    return body;
}

/// A closed body that the intake takes as it is and whose volume is no more than the chord error
/// below the exact one.
void expect_closed(const FittedBody& body, double volume, double area)
{
    const MeshReport& r = body.report;
    EXPECT_TRUE(r.is_watertight);
    EXPECT_EQ(r.open_edges + r.non_manifold_edges + r.flipped_facets + r.degenerate_facets, 0U);
    EXPECT_EQ(r.facets_read, body.mesh.facets.size());
    EXPECT_LT(r.volume, volume);
    EXPECT_GT(r.volume, volume - area * chord_error_dp * dp);
    EXPECT_LT(r.area, area);
    EXPECT_NEAR(r.area, area, 0.015 * area);
}

/// The greatest depth of facets below the surface, found on a grid of points of every facet.
double depth_of(const FittedBody& body)
{
    double depth = 0;
    for (std::uint32_t f = 0; f < body.mesh.facets.size(); ++f)
        for (int i = 0; i <= 6; ++i)
            for (int j = 0; i + j <= 6; ++j)
            {
                const auto& corners = body.mesh.facets[f];
                const auto& v = body.mesh.vertices;
                const Vec3 p = v[corners[0]] * (i / 6.0) + v[corners[1]] * (j / 6.0) +
                               v[corners[2]] * ((6 - i - j) / 6.0);
                Vec3 exact = p;
                project_to_exact(body, exact, f);
                depth = std::max(depth, norm(exact - p));
            }
    return depth;
}

double distance_to_line(const Vec3& from, const Vec3& to, const Vec3& p)
{
    return norm(cross(p - from, to - from)) / norm(to - from);
}

TEST(SphereMesh, IsClosedAndWithinTheChordErrorForAnyRadius)
{
    for (const double radius_dp : {0.2, 1.0, 3.3, 10.0, 40.0})
    {
        const double r = radius_dp * dp;
        const FittedBody body = body_of(sphere_mesh({0.3, -0.2, 5}, r, dp));
        expect_closed(body, 4 * pi / 3 * r * r * r, 4 * pi * r * r);
        EXPECT_LE(depth_of(body), 1.0001 * chord_error_dp * dp) << radius_dp;
        EXPECT_TRUE(body.features.edges.empty());
    }
}

TEST(SphereMesh, HasItsCornersOnTheSphere)
{
    const FittedBody body = body_of(sphere_mesh({1, 2, 3}, 0.07, dp));
    for (const Vec3& v : body.mesh.vertices) EXPECT_NEAR(norm(v - Vec3{1, 2, 3}), 0.07, 1e-15);
}

TEST(SphereMesh, RefusesARadiusThatIsNotPositive)
{
    EXPECT_THROW(sphere_mesh({}, 0, dp), GeometryError);
    EXPECT_THROW(sphere_mesh({}, -1, dp), GeometryError);
    EXPECT_THROW(sphere_mesh({}, 1, 1e-12), GeometryError);
}

TEST(CylinderMesh, IsClosedAndWithinTheChordErrorForAnyRadius)
{
    for (const double radius_dp : {0.5, 1.0, 7.0, 30.0})
        for (const Vec3& end : {Vec3{0, 0, 0.5}, Vec3{0.1, -0.4, 0.3}, Vec3{-0.02, 0, 0}})
        {
            const double r = radius_dp * dp;
            const double length = norm(end);
            const FittedBody body = body_of(cylinder_mesh({}, end, r, all, dp));
            expect_closed(body, pi * r * r * length, 2 * pi * r * (r + length));
            EXPECT_LE(depth_of(body), 1.0001 * chord_error_dp * dp);
        }
}

TEST(CylinderMesh, HasItsTwoRimsAsSharpEdgesAndNoOther)
{
    const FittedBody body = body_of(cylinder_mesh({1, 1, 1}, {1, 2, 3}, 0.1, all, dp));
    ASSERT_EQ(body.features.lines.size(), 2U);
    EXPECT_TRUE(body.features.singular.empty());
    for (const FeatureLine& line : body.features.lines)
    {
        EXPECT_TRUE(line.is_closed);
        EXPECT_NEAR(line.length, 2 * pi * 0.1, 1e-3);
    }
}

TEST(CylinderMesh, LeavesOutWhatIsHidden)
{
    const auto area = [](const std::array<bool, 3>& is_visible) {
        return body_of(cylinder_mesh({}, {0, 0, 0.3}, 0.1, is_visible, dp)).report.area;
    };
    EXPECT_NEAR(area({true, false, false}), pi * 0.01, 1e-4);
    EXPECT_NEAR(area({false, true, true}), pi * (0.01 + 0.06), 1e-4);
    EXPECT_NEAR(area({false, false, true}), pi * 0.06, 1e-4);
}

TEST(CylinderMesh, OfNoLengthHasNoFacet)
{
    EXPECT_EQ(cylinder_mesh({1, 1, 1}, {1, 1, 1}, 0.1, all, dp).soup.size(), 0U);
}

TEST(EllipsoidMesh, IsClosedAndWithinTheChordError)
{
    // Half axes 0.1 along and 0.06 across, foci 0.08 from the centre.
    const Vec3 center{1, -1, 0.5};
    const Vec3 focus = Vec3{1, 2, -2} / 3 * 0.08;
    const FittedBody body = body_of(ellipsoid_mesh(center - focus, center + focus, 0.2, dp));
    const double e = 0.8;
    expect_closed(body, 4 * pi / 3 * 0.1 * 0.06 * 0.06,
                  2 * pi * 0.06 * 0.06 * (1 + 0.1 / (0.06 * e) * std::asin(e)));
    EXPECT_LE(depth_of(body), 1.01 * chord_error_dp * dp);
    EXPECT_TRUE(body.features.edges.empty());
}

TEST(EllipsoidMesh, HasNoSharpEdgeAtASlenderTip)
{
    const FittedBody body = body_of(ellipsoid_mesh({-0.995, 0, 0}, {0.995, 0, 0}, 2, dp));
    EXPECT_TRUE(body.features.edges.empty());
    EXPECT_TRUE(body.report.is_watertight);
}

TEST(EllipsoidMesh, WithOneFocusIsASphereAndWithoutAnInsideNothing)
{
    const FittedBody body = body_of(ellipsoid_mesh({}, {}, 0.2, dp));
    for (const Vec3& v : body.mesh.vertices) EXPECT_NEAR(norm(v), 0.1, 1e-15);
    EXPECT_EQ(ellipsoid_mesh({0, 0, 0}, {1, 0, 0}, 1, dp).soup.size(), 0U);
}

TEST(ProjectToRound, MovesEveryFacetOntoTheExactSurface)
{
    const FittedBody sphere = body_of(sphere_mesh({1, 2, 3}, 0.1, dp));
    const FittedBody tube = body_of(cylinder_mesh({}, {1, 1, 0}, 0.1, {false, false, true}, dp));
    const FittedBody egg = body_of(ellipsoid_mesh({}, {0.1, 0.05, 0}, 0.2, dp));
    for (const FittedBody* body : {&sphere, &tube, &egg})
        for (std::uint32_t f = 0; f < body->mesh.facets.size(); ++f)
        {
            const auto& corners = body->mesh.facets[f];
            const auto& v = body->mesh.vertices;
            const Vec3 before = (v[corners[0]] + v[corners[1]] + v[corners[2]]) / 3;
            Vec3 p = before;
            project_to_exact(*body, p, f);
            EXPECT_LT(norm(p - before), 1.01 * chord_error_dp * dp);
            const double off = body == &sphere ? norm(p - Vec3{1, 2, 3}) - 0.1
                               : body == &tube ? distance_to_line({}, {1, 1, 0}, p) - 0.1
                                               : norm(p) + norm(p - Vec3{0.1, 0.05, 0}) - 0.2;
            EXPECT_NEAR(off, 0, 1e-14);
        }
}

TEST(ProjectToRound, KeepsCoversPlaneAndPutsRimParticlesOnTheCircle)
{
    FittedBody body = body_of(cylinder_mesh({0, 0, 0}, {0, 0, 0.25}, 0.1, all, dp));
    FeatureOptions options;
    options.dp = dp;
    const auto particles = place_feature_particles(body.mesh, body.features, options);
    ASSERT_FALSE(particles.empty());
    for (const FeatureParticle& particle : particles)
        for (const std::uint32_t facet : body.mesh.edge_facets[particle.edge])
        {
            Vec3 p = particle.position;
            project_to_exact(body, p, facet);
            EXPECT_NEAR(std::hypot(p.x, p.y), 0.1, 1e-15);
            EXPECT_EQ(p.z, particle.position.z);
        }
    for (std::uint32_t f = 0; f < body.mesh.facets.size(); ++f)
        if (std::fabs(body.mesh.normals[f].z) > 0.5)
        {
            const auto& corners = body.mesh.facets[f];
            const auto& v = body.mesh.vertices;
            const Vec3 middle = (v[corners[0]] + v[corners[1]] + v[corners[2]]) / 3;
            Vec3 p = middle;
            project_to_exact(body, p, f);
            EXPECT_EQ(p, middle);
        }
}

TEST(ProjectToRound, KeepsYInTwoDimensions)
{
    const FittedBody body = body_of(sphere_mesh({0, 0.05, 0}, 0.1, dp));
    const auto& corners = body.mesh.facets[7];
    Vec3 p = body.mesh.vertices[corners[0]] * 0.5 + body.mesh.vertices[corners[1]] * 0.5;
    const double y = p.y;
    project_to_exact(body, p, 7, true);
    EXPECT_EQ(p.y, y);
    EXPECT_NEAR(norm(p - Vec3{0, 0.05, 0}), 0.1, 1e-15);
}

TEST(ProjectToRound, KeepsTheCornersOfASlantedSectionOnTheirCovers)
{
    const Vec3 p0{0, -0.02, 0};
    const Vec3 p1{0.2, 0.1, 0.3};
    const FittedBody body = body_of(cylinder_mesh(p0, p1, 0.1, all, dp));
    const SectionParticles section = section_particles(body.mesh, {0.05, dp, 30});
    const Vec3 u = (p1 - p0) / norm(p1 - p0);
    int corners = 0;
    for (std::size_t i = 0; i < section.positions.size(); ++i)
    {
        Vec3 p = section.positions[i];
        project_to_exact(body, p, section.facets[i], true);
        EXPECT_EQ(p.y, 0.05);
        if (section.kinds[i] != FitKind::Corner) continue;
        ++corners;
        EXPECT_NEAR(distance_to_line(p0, p1, p), 0.1, 1e-14);
        EXPECT_NEAR(dot(p - section.positions[i], u), 0, 1e-15);
    }
    EXPECT_EQ(corners, 4);
}

TEST(ExactNormal, IsThatOfTheTrueSurfaceOutward)
{
    const FittedBody sphere = body_of(sphere_mesh({1, 2, 3}, 0.1, dp));
    const Vec3 way = Vec3{2, -1, 2} / 3;
    for (std::uint32_t f = 0; f < sphere.mesh.facets.size(); ++f)
    {
        if (dot(sphere.mesh.normals[f], way) < 0.99) continue;
        EXPECT_NEAR(norm(exact_normal(sphere, Vec3{1, 2, 3} + way * 0.1, f) - way), 0, 1e-13);
    }
    const FittedBody pipe = body_of(cylinder_mesh({}, {0, 0, 0.25}, 0.1, all, dp));
    for (std::uint32_t f = 0; f < pipe.mesh.facets.size(); ++f)
    {
        const Vec3 v = pipe.mesh.vertices[pipe.mesh.facets[f][0]];
        const bool on_cover = std::fabs(pipe.mesh.normals[f].z) > 0.5;
        const Vec3 expected = on_cover ? pipe.mesh.normals[f] : Vec3{v.x / 0.1, v.y / 0.1, 0};
        EXPECT_NEAR(norm(exact_normal(pipe, v, f) - expected), 0, 1e-13);
    }
}

} // namespace
} // namespace fppg
