#include "fppg/section.h"

#include "fit/fit_shapes.h"
#include "fppg/error.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace fppg
{
namespace
{

using test::add_quad;
using test::box;

constexpr double pi = std::numbers::pi;

SurfaceMesh taken(const TriangleSoup& soup)
{
    MeshReport report;
    return repair_mesh(soup, {}, 1, report);
}

SectionParticles cut(const TriangleSoup& soup, double y, double dp)
{
    return section_particles(taken(soup), {y, dp, 30});
}

/// A prism along y over an outline that runs counter-clockwise with x to the right and z up.
/// Covers are fans around a point from which all corners are seen.
TriangleSoup along_y(const std::vector<Vec3>& outline, double y0, double y1, const Vec3& middle)
{
    TriangleSoup soup;
    const auto at = [](const Vec3& p, double y) { return Vec3{p.x, y, p.z}; };
    for (std::size_t i = 0; i < outline.size(); ++i)
    {
        const Vec3& a = outline[i];
        const Vec3& b = outline[(i + 1) % outline.size()];
        add_quad(soup, at(a, y0), at(b, y0), at(b, y1), at(a, y1));
        test::add_facet(soup, at(b, y0), at(a, y0), at(middle, y0));
        test::add_facet(soup, at(a, y1), at(b, y1), at(middle, y1));
    }
    return soup;
}

std::vector<Vec3> circle(int sides, double radius)
{
    std::vector<Vec3> out;
    for (int i = 0; i < sides; ++i)
        out.push_back(
            {radius * std::cos(2 * pi * i / sides), 0, radius * std::sin(2 * pi * i / sides)});
    return out;
}

TriangleSoup torus(double big, double small, int around, int across)
{
    TriangleSoup soup;
    const auto at = [&](int i, int j)
    {
        const double t = 2 * pi * (i % around) / around;
        const double s = 2 * pi * (j % across) / across;
        const double r = big + small * std::cos(s);
        return Vec3{r * std::cos(t), small * std::sin(s), r * std::sin(t)};
    };
    for (int i = 0; i < around; ++i)
        for (int j = 0; j < across; ++j)
            add_quad(soup, at(i, j), at(i, j + 1), at(i + 1, j + 1), at(i + 1, j));
    return soup;
}

std::size_t corners_of(const SectionParticles& p)
{
    return static_cast<std::size_t>(std::count(p.kinds.begin(), p.kinds.end(), FitKind::Corner));
}

/// Every particle lies in the plane, on its facet, with a unit normal in the plane.
void expect_on_mesh(const SectionParticles& particles, const SurfaceMesh& mesh, double y)
{
    ASSERT_EQ(particles.positions.size(), particles.facets.size());
    ASSERT_EQ(particles.positions.size(), particles.normals.size());
    ASSERT_EQ(particles.positions.size(), particles.kinds.size());
    for (std::size_t i = 0; i < particles.positions.size(); ++i)
    {
        const Vec3& p = particles.positions[i];
        EXPECT_EQ(p.y, y);
        const std::uint32_t f = particles.facets[i];
        EXPECT_NEAR(dot(p - mesh.vertices[mesh.facets[f][0]], mesh.normals[f]), 0, 1e-5);
        EXPECT_NEAR(norm(particles.normals[i]), 1, 1e-12);
        EXPECT_EQ(particles.normals[i].y, 0);
    }
}

/// The points of a closed outline are covered: the greatest distance from one of them to the
/// nearest particle.
double gap(const SectionParticles& particles, const std::vector<Vec3>& outline)
{
    double greatest = 0;
    const int steps = outline.size() > 200 ? 2 : 200;
    for (std::size_t i = 0; i < outline.size(); ++i)
        for (int k = 0; k < steps; ++k)
        {
            const Vec3 p = outline[i] + (outline[(i + 1) % outline.size()] - outline[i]) *
                                            (static_cast<double>(k) / steps);
            double least = 1e300;
            for (const Vec3& q : particles.positions)
                least = std::min(least, std::hypot(p.x - q.x, p.z - q.z));
            greatest = std::max(greatest, least);
        }
    return greatest;
}

double smallest_distance(const SectionParticles& particles)
{
    double least = 1e300;
    for (std::size_t i = 0; i < particles.positions.size(); ++i)
        for (std::size_t j = 0; j < i; ++j)
            least = std::min(least, norm(particles.positions[i] - particles.positions[j]));
    return least;
}

const std::vector<Vec3> l_outline{{0, 0, 0}, {2, 0, 0}, {2, 0, 1}, {1, 0, 1}, {1, 0, 2}, {0, 0, 2}};

TEST(Section, OfABoxHasFourCornersAndItsArea)
{
    const SurfaceMesh mesh = taken(box({0, 0, 0}, {1, 2, 3}));
    const SectionParticles p = section_particles(mesh, {0.7, 0.1, 30});
    expect_on_mesh(p, mesh, 0.7);
    EXPECT_EQ(corners_of(p), 4U);
    EXPECT_EQ(p.positions.size(), 80U);
    EXPECT_EQ(p.closed_chains, 1U);
    EXPECT_EQ(p.open_chains, 0U);
    EXPECT_NEAR(p.area, 3, 1e-14);
    EXPECT_NEAR(p.length, 8, 1e-14);
    EXPECT_NEAR(smallest_distance(p), 0.1, 1e-12);
}

TEST(Section, HasNormalsOutward)
{
    const SectionParticles p = cut(box({-1, -1, -1}, {1, 1, 1}), 0.3, 0.07);
    for (std::size_t i = 0; i < p.positions.size(); ++i)
        EXPECT_GT(p.positions[i].x * p.normals[i].x + p.positions[i].z * p.normals[i].z, 0.5);
    EXPECT_NEAR(std::fabs(p.normals[0].x), std::sqrt(0.5), 1e-12);
}

TEST(Section, ThroughCornersAndSidesOfTheMeshIsClosed)
{
    // At both covers, the plane lies in facets; it touches the lower one from above only.
    for (const double y : {0.0, 1.0, 2.0})
    {
        const SectionParticles p = cut(box({0, 0, 0}, {1, 2, 3}), y, 0.1);
        EXPECT_EQ(p.closed_chains, 1U) << y;
        EXPECT_EQ(corners_of(p), 4U) << y;
        EXPECT_NEAR(p.area, 3, 1e-14) << y;
    }
    const SectionParticles equator = cut(test::sphere(4), 0, 0.05);
    EXPECT_EQ(equator.closed_chains, 1U);
    EXPECT_EQ(corners_of(equator), 0U);
    EXPECT_NEAR(equator.area, pi, 0.01);
}

TEST(Section, OutsideTheMeshIsEmpty)
{
    const SectionParticles p = cut(box({0, 0, 0}, {1, 2, 3}), 2.1, 0.1);
    EXPECT_TRUE(p.positions.empty());
    EXPECT_EQ(p.closed_chains + p.open_chains, 0U);
    EXPECT_EQ(p.area, 0);
}

TEST(Section, OfACircleHasNoCornerAndEvenSpacingHoweverFineItIs)
{
    for (const int sides : {24, 100, 3000})
    {
        const std::vector<Vec3> outline = circle(sides, 1);
        const SurfaceMesh mesh = taken(along_y(outline, -1, 1, {}));
        const SectionParticles p = section_particles(mesh, {0.123, 0.1, 30});
        expect_on_mesh(p, mesh, 0.123);
        EXPECT_EQ(corners_of(p), 0U);
        EXPECT_EQ(p.positions.size(), 63U);
        EXPECT_LE(gap(p, outline), 0.0501);
        EXPECT_GT(smallest_distance(p), 0.98 * 2 * pi / 63);
    }
}

TEST(Section, OfASphereNearItsPoleHasNoCorner)
{
    for (const double y : {0.9, 0.99, 0.9995})
    {
        const SectionParticles p = cut(test::sphere(5), y, 0.02);
        EXPECT_EQ(p.closed_chains, 1U);
        EXPECT_EQ(corners_of(p), 0U) << y;
    }
}

TEST(Section, OfAnLIsCoveredAndCountsItsNotchAsACorner)
{
    for (const double dp : {0.03, 0.07, 0.3})
    {
        const SurfaceMesh mesh = taken(along_y(l_outline, 0, 1, {0.5, 0, 0.5}));
        const SectionParticles p = section_particles(mesh, {0.4, dp, 30});
        expect_on_mesh(p, mesh, 0.4);
        EXPECT_EQ(corners_of(p), 6U);
        EXPECT_NEAR(p.area, 3, 1e-12);
        EXPECT_LE(gap(p, l_outline), 0.501 * dp);
        EXPECT_GT(smallest_distance(p), 0.5 * dp);
    }
}

TEST(Section, OfATorusHasTwoLoopsAndTheHoleTakenOff)
{
    const SectionParticles p = cut(torus(1, 0.3, 200, 60), 0.1, 0.05);
    EXPECT_EQ(p.closed_chains, 2U);
    EXPECT_EQ(corners_of(p), 0U);
    const double half = std::sqrt(0.3 * 0.3 - 0.1 * 0.1);
    EXPECT_NEAR(p.area, 4 * pi * half, 0.01);
    // Normals of the inner loop look into the hole.
    for (std::size_t i = 0; i < p.positions.size(); ++i)
    {
        const double r = std::hypot(p.positions[i].x, p.positions[i].z);
        const double out = p.positions[i].x * p.normals[i].x + p.positions[i].z * p.normals[i].z;
        EXPECT_EQ(out > 0, r > 1);
    }
}

TEST(Section, OfAGearHasACornerAtEveryTurn)
{
    std::vector<Vec3> outline;
    for (int i = 0; i < 24; ++i)
        for (const auto& [share, r] :
             {std::pair{0.0, 1.0}, std::pair{0.4, 1.0}, std::pair{0.5, 0.8}, std::pair{0.9, 0.8}})
        {
            const double angle = 2 * pi * (i + share) / 24;
            outline.push_back({r * std::cos(angle), 0, r * std::sin(angle)});
        }
    for (const double dp : {0.01, 0.05, 0.4})
    {
        const SectionParticles p = cut(along_y(outline, 0, 1, {}), 0.5, dp);
        EXPECT_LE(gap(p, outline), 0.501 * dp);
        EXPECT_EQ(p.closed_chains, 1U);
        if (dp < 0.1)
        {
            EXPECT_EQ(corners_of(p), 96U);
        }
        EXPECT_LT(static_cast<double>(p.positions.size()), 1 + 2 * p.length / dp);
    }
}

TEST(Section, OfAnOpenSurfaceEndsInCorners)
{
    TriangleSoup soup;
    add_quad(soup, {0, 0, 0}, {0, 1, 0}, {1, 1, 0}, {1, 0, 0});
    add_quad(soup, {1, 0, 0}, {1, 1, 0}, {1, 1, 0.55}, {1, 0, 0.55});
    const SectionParticles p = cut(soup, 0.25, 0.1);
    EXPECT_EQ(p.open_chains, 1U);
    EXPECT_EQ(p.closed_chains, 0U);
    EXPECT_EQ(p.area, 0);
    EXPECT_EQ(corners_of(p), 3U);
    EXPECT_EQ(p.positions.size(), 3U + 9U + 5U);
    EXPECT_NEAR(p.length, 1.55, 1e-14);
}

TEST(Section, OfATurnedBoxIsTheSameForAnyAngle)
{
    for (int i = 1; i < 40; ++i)
    {
        Transform turn;
        const double c = std::cos(0.1 * i);
        const double s = std::sin(0.1 * i);
        turn.linear = {Vec3{c, 0, s}, Vec3{0, 1, 0}, Vec3{-s, 0, c}};
        const SectionParticles p =
            cut(test::moved(box({-1, 0, -1}, {1, 2, 1}), turn), i % 2 == 0 ? 1.0 : 0.77, 0.15);
        EXPECT_EQ(corners_of(p), 4U);
        EXPECT_EQ(p.positions.size(), 56U);
        EXPECT_NEAR(p.area, 4, 1e-12);
    }
}

TEST(Section, CornersFirstAndPartsSmallerThanDpHaveOneParticle)
{
    const SectionParticles p = cut(box({0, 0, 0}, {0.01, 1, 0.01}), 0.5, 0.1);
    EXPECT_EQ(p.positions.size(), 1U);
    const SectionParticles q = cut(box({0, 0, 0}, {1, 1, 1}), 0.5, 0.1);
    EXPECT_TRUE(std::is_sorted(q.kinds.begin(), q.kinds.end()));
}

TEST(Section, RefusesOptionsOutOfRange)
{
    const SurfaceMesh mesh = taken(box({0, 0, 0}, {1, 1, 1}));
    EXPECT_THROW(section_particles(mesh, {0.5, 0, 30}), GeometryError);
    EXPECT_THROW(section_particles(mesh, {0.5, 1e-11, 30}), GeometryError);
    EXPECT_THROW(section_particles(mesh, {0.5, 0.1, 180}), GeometryError);
}

} // namespace
} // namespace fppg
