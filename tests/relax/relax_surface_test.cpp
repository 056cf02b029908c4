#include "fppg/relax.h"

#include "batch/rates.h"
#include "fit/fit_shapes.h"
#include "fppg/error.h"
#include "helpers/surface_cover.h"
#include "meshes/mesh_query.h"
#include "meshes/point_grid.h"

#include <gtest/gtest.h>

#include <cstring>

namespace fppg
{

namespace
{

using namespace test;

TriangleSoup cylinder(int sides, double radius, double height)
{
    TriangleSoup soup;
    const Vec3 up{0, 0, height};
    for (int i = 0; i < sides; ++i)
    {
        const auto corner = [&](int k)
        {
            const double angle = 2 * std::numbers::pi * (k % sides) / sides;
            return Vec3{radius * std::cos(angle), radius * std::sin(angle), 0};
        };
        const Vec3 a = corner(i);
        const Vec3 b = corner(i + 1);
        add_facet(soup, b, a, {});
        add_facet(soup, a + up, b + up, up);
        add_quad(soup, a, b, b + up, a + up);
    }
    return soup;
}

/// Walls of one fitted body, and what it takes to relax and judge them.
struct Walls
{
    std::vector<FittedBody> bodies;
    WallParticles particles;
    std::vector<char> held;
    RelaxSurfaceOptions options;

    Walls(const TriangleSoup& soup, double dp) { add(soup, dp); }

    void add(const TriangleSoup& soup, double dp)
    {
        const FitInput input(soup, dp);
        const SurfaceParticles fitted = input.fit();
        FittedBody body;
        body.mesh = input.mesh;
        body.features = input.features;
        const auto b = static_cast<std::uint32_t>(bodies.size());
        bodies.push_back(body);
        for (std::size_t i = 0; i < fitted.positions.size(); ++i)
        {
            particles.positions.push_back(fitted.positions[i]);
            particles.kinds.push_back(fitted.kinds[i]);
            particles.facets.push_back(fitted.facets[i]);
            particles.bodies.push_back(b);
            particles.mk.push_back(static_cast<std::uint16_t>(10 + b));
        }
        options.dp = dp;
    }

    RelaxSurfaceReport relax(int threads = 1)
    {
        return relax_surface(bodies, particles, held, options, threads);
    }
};

struct Named
{
    const char* name;
    TriangleSoup soup;
    double dp;
    double variation; ///< allowed; more where lines crowd
};

std::vector<Named> shapes()
{
    return {{"sphere of small facets", sphere(5), 0.05, 0.045},
            {"sphere of large facets", sphere(2), 0.03, 0.045},
            {"cube", box({0.1, 0.2, 0.3}, {1.13, 1.17, 1.21}), 0.0371, 0.045},
            {"cylinder", cylinder(48, 0.5, 1.3), 0.04, 0.045},
            {"thin plate", box({0, 0, 0}, {1, 1, 0.009}), 0.03, 0.06},
            {"wedge", wedge(), 0.04, 0.06},
            {"coarse gear", gear(14, 0.8, 1, 0.3), 0.04, 0.10}};
}

double farthest_point(const Walls& walls)
{
    return farthest_point_dp(walls.bodies[0].mesh, walls.particles.positions, walls.options.dp, 30);
}

/// Of a surface particle of the first body to another particle of its sheet.
double nearest_pair_dp(const Walls& walls)
{
    const double dp = walls.options.dp;
    PointGrid grid(dp, walls.particles.size());
    for (const Vec3& p : walls.particles.positions) grid.add(p);
    double least = dp * dp;
    for (std::uint32_t i = 0; i < walls.particles.size(); ++i)
    {
        if (walls.particles.kinds[i] != FitKind::Surface) continue;
        const auto& normals = walls.bodies[0].mesh.normals;
        const Vec3& normal = normals[walls.particles.facets[i]];
        grid.for_each_near(
            walls.particles.positions[i], dp,
            [&](std::uint32_t j, double squared)
            {
                const Vec3 offset = walls.particles.positions[j] - walls.particles.positions[i];
                // Edge particles behind a plate belong to its other side.
                const bool is_behind = walls.particles.kinds[j] != FitKind::Surface &&
                                       std::abs(dot(offset, normal)) > 0.1 * dp;
                if (j != i && !is_behind && dot(normal, normals[walls.particles.facets[j]]) > -0.5)
                    least = std::min(least, squared);
            });
    }
    return std::sqrt(least) / dp;
}

/// How far a particle is from the plane of its facet and beyond its sides, in dp.
double off_facet(const Walls& walls, std::size_t i)
{
    const SurfaceMesh& mesh = walls.bodies[walls.particles.bodies[i]].mesh;
    const std::uint32_t f = walls.particles.facets[i];
    const Vec3& p = walls.particles.positions[i];
    const Vec3& normal = mesh.normals[f];
    double off = std::abs(dot(p - mesh.vertices[mesh.facets[f][0]], normal));
    for (std::size_t s = 0; s < 3; ++s)
    {
        const Vec3& from = mesh.vertices[mesh.facets[f][s]];
        const Vec3 side = mesh.vertices[mesh.facets[f][(s + 1) % 3]] - from;
        off = std::max(off, -dot(p - from, cross(normal, side / norm(side))));
    }
    return off / walls.options.dp;
}

void expect_same(const WallParticles& a, const WallParticles& b)
{
    ASSERT_EQ(a.size(), b.size());
    EXPECT_EQ(
        std::memcmp(a.positions.data(), b.positions.data(), a.positions.size() * sizeof(Vec3)), 0);
    EXPECT_EQ(a.facets, b.facets);
    EXPECT_EQ(a.kinds, b.kinds);
    EXPECT_EQ(a.mk, b.mk);
    EXPECT_EQ(a.bodies, b.bodies);
}

} // namespace

TEST(RelaxSurface, SpreadsParticlesEvenly)
{
    for (const Named& shape : shapes())
    {
        Walls walls(shape.soup, shape.dp);
        const RelaxSurfaceReport report = walls.relax(2);
        EXPECT_LE(report.after.iteration, 100) << shape.name;
        EXPECT_LE(report.after.spacing_variation, shape.variation) << shape.name;
        EXPECT_GE(report.after.spacing_mean, 0.93) << shape.name;
        EXPECT_LE(report.after.spacing_mean, 1.10) << shape.name;
    }
}

TEST(RelaxSurface, LeavesNoPointOfTheSurfaceFarFromAParticle)
{
    for (const Named& shape : shapes())
    {
        Walls walls(shape.soup, shape.dp);
        walls.relax(2);
        EXPECT_LE(farthest_point(walls), 0.75) << shape.name;
    }
}

TEST(RelaxSurface, KeepsSurfaceParticlesApart)
{
    for (const Named& shape : shapes())
    {
        Walls walls(shape.soup, shape.dp);
        walls.relax(2);
        EXPECT_GE(nearest_pair_dp(walls), 0.6) << shape.name;
    }
}

TEST(RelaxSurface, KeepsParticlesOnTheirFacets)
{
    for (const Named& shape : shapes())
    {
        Walls walls(shape.soup, shape.dp);
        walls.relax();
        double farthest = 0;
        for (std::size_t i = 0; i < walls.particles.size(); ++i)
            farthest = std::max(farthest, off_facet(walls, i));
        EXPECT_LE(farthest, 1e-9) << shape.name;
    }
}

TEST(RelaxSurface, LeavesEdgeAndCornerParticlesWhereTheyAre)
{
    Walls walls(gear(14, 0.8, 1, 0.3), 0.04);
    const WallParticles given = walls.particles;
    const RelaxSurfaceReport report = walls.relax();
    EXPECT_EQ(walls.particles.size(), given.size() + report.inserted - report.removed);
    std::size_t moved = 0;
    for (std::size_t i = 0; i < given.size(); ++i)
    {
        if (given.kinds[i] == FitKind::Surface) break;
        ASSERT_EQ(walls.particles.kinds[i], given.kinds[i]);
        EXPECT_EQ(walls.particles.positions[i], given.positions[i]);
        EXPECT_EQ(walls.particles.facets[i], given.facets[i]);
        ++moved;
    }
    EXPECT_GT(moved, 100u);
}

TEST(RelaxSurface, GivesTheSameBytesForAnyNumberOfThreads)
{
    for (const Named& shape : shapes())
    {
        Walls one(shape.soup, shape.dp);
        one.options.iterations = 30;
        Walls many = one;
        one.relax(1);
        for (const int threads : {2, 8})
        {
            SCOPED_TRACE(shape.name);
            Walls copy = many;
            copy.relax(threads);
            expect_same(one.particles, copy.particles);
        }
    }
}

TEST(RelaxSurface, LetsNoParticleThroughAThinPlate)
{
    Walls walls(box({0, 0, 0}, {1, 1, 0.002}), 0.05);
    const auto count = [&](double z)
    {
        std::size_t n = 0;
        for (std::size_t i = 0; i < walls.particles.size(); ++i)
            n += walls.particles.kinds[i] == FitKind::Surface &&
                 walls.bodies[0].mesh.normals[walls.particles.facets[i]].z * z > 0.5;
        return n;
    };
    const std::size_t above = count(1);
    const std::size_t below = count(-1);
    const RelaxSurfaceReport report = walls.relax();
    EXPECT_EQ(report.returned, 0u);
    EXPECT_NEAR(static_cast<double>(count(1)), static_cast<double>(above), 15);
    EXPECT_NEAR(static_cast<double>(count(-1)), static_cast<double>(below), 15);
    for (std::size_t i = 0; i < walls.particles.size(); ++i)
    {
        const double z = walls.bodies[0].mesh.normals[walls.particles.facets[i]].z;
        if (walls.particles.kinds[i] != FitKind::Surface || std::abs(z) < 0.5) continue;
        EXPECT_NEAR(walls.particles.positions[i].z, z > 0 ? 0.002 : 0, 1e-12);
    }
}

TEST(RelaxSurface, KeepsAWholeStateWhenToldToStop)
{
    Walls walls(sphere(4), 0.05);
    int calls = 0;
    walls.options.on_progress = [&](const RelaxProgress& progress)
    {
        EXPECT_EQ(progress.iteration, ++calls);
        EXPECT_LE(progress.largest_displacement, 0.1001);
        return calls < 12;
    };
    const RelaxSurfaceReport report = walls.relax();
    EXPECT_EQ(report.after.iteration, 12);
    EXPECT_LT(report.after.spacing_variation, report.before.spacing_variation);
    EXPECT_LE(farthest_point(walls), 0.75);
    for (std::size_t i = 0; i < walls.particles.size(); ++i) ASSERT_LE(off_facet(walls, i), 1e-9);
}

TEST(RelaxSurface, EndsWhenTheSpacingNoLongerImproves)
{
    Walls until_settled(sphere(4), 0.05);
    Walls not_long(sphere(4), 0.05);
    Walls exact(sphere(4), 0.05);
    until_settled.options.tolerance = 1; // no improvement is enough
    not_long.options.max_iterations = 7;
    exact.options.iterations = 13;
    EXPECT_LT(until_settled.relax().after.iteration, 80);
    EXPECT_EQ(not_long.relax().after.iteration, 7);
    EXPECT_EQ(exact.relax().after.iteration, 13);
}

TEST(RelaxSurface, LeavesParticlesAsTheyWereWhenTheCallbackThrows)
{
    Walls walls(sphere(3), 0.1);
    const WallParticles given = walls.particles;
    walls.options.on_progress = [](const RelaxProgress&) -> bool
    { throw std::runtime_error("stop"); };
    EXPECT_THROW(walls.relax(), std::runtime_error);
    expect_same(walls.particles, given);
}

TEST(RelaxSurface, HoldsWhatIsHeld)
{
    Walls walls(sphere(4), 0.05);
    const WallParticles given = walls.particles;
    for (const Vec3& p : given.positions) walls.held.push_back(p.z > 0);
    walls.relax();
    ASSERT_EQ(walls.held.size(), walls.particles.size());
    // Those that are given keep their order; new ones follow.
    std::size_t held = 0;
    for (std::size_t i = 0; i < given.size(); ++i)
    {
        if (given.positions[i].z <= 0) continue;
        while (held < walls.particles.size() && !walls.held[held]) ++held;
        ASSERT_LT(held, walls.particles.size());
        EXPECT_EQ(walls.particles.positions[held++], given.positions[i]);
    }
}

TEST(RelaxSurface, FillsHolesOnlyWhereItMay)
{
    Walls walls(box({0, 0, 0}, {1, 1, 1}), 0.1);
    // A body cut at half its height: nothing of it is left above.
    WallParticles& p = walls.particles;
    WallParticles lower;
    for (std::size_t i = 0; i < p.size(); ++i)
    {
        if (p.positions[i].z > 0.5) continue;
        lower.positions.push_back(p.positions[i]);
        lower.kinds.push_back(p.kinds[i]);
        lower.facets.push_back(p.facets[i]);
        lower.bodies.push_back(p.bodies[i]);
        lower.mk.push_back(p.mk[i]);
        walls.held.push_back(p.positions[i].z > 0.35);
    }
    p = lower;
    walls.options.may_insert = [](std::size_t body, const Vec3& at, const Vec3&)
    { return body == 0 && at.z <= 0.5; };
    walls.relax();
    for (const Vec3& at : p.positions) EXPECT_LE(at.z, 0.5);
}

/// Two walls in one plane, as the layers of two boxes that overlap: each has its particles on its
/// side of a gap of 1.5 dp, and none may come nearer than 0.6 dp to the other.
TEST(RelaxSurface, FillsAGapBetweenTwoWalls)
{
    const double dp = 0.05;
    TriangleSoup plate;
    add_quad(plate, {0, 0, 0}, {3, 0, 0}, {3, 1, 0}, {0, 1, 0});
    Walls walls(plate, dp);
    walls.add(plate, dp);
    const WallParticles fitted = std::move(walls.particles);
    const MeshQuery query(soup_of(walls.bodies[0].mesh), 1);
    const auto is_of = [&](std::uint32_t body, double x)
    { return body == 0 ? x < 1.501 : x > 1.499 + 1.5 * dp; };
    WallParticles& given = walls.particles;
    given = {};
    const auto add = [&](std::uint32_t body, const Vec3& p, FitKind kind, std::uint32_t facet)
    {
        given.positions.push_back(p);
        given.kinds.push_back(kind);
        given.bodies.push_back(body);
        given.facets.push_back(facet);
        given.mk.push_back(static_cast<std::uint16_t>(10 + body));
        walls.held.push_back(1);
    };
    for (std::uint32_t body = 0; body < 2; ++body)
    {
        for (std::size_t i = 0; i < fitted.size(); ++i)
            if (fitted.bodies[i] == body && fitted.kinds[i] != FitKind::Surface &&
                is_of(body, fitted.positions[i].x))
                add(body, fitted.positions[i], fitted.kinds[i], fitted.facets[i]);
        for (int column = 1; column < 60; ++column)
            for (int row = 1; row < 20; ++row)
            {
                const Vec3 p{column * dp + body * 0.5 * dp, (row + body * 0.4) * dp, 0};
                if (p.x < 3 - 0.6 * dp && p.y < 1 - 0.6 * dp && is_of(body, p.x))
                    add(body, p, FitKind::Surface, query.closest_point(p).facet);
            }
    }
    const WallParticles all = given;
    PointGrid grid(dp, all.size());
    for (const Vec3& p : all.positions) grid.add(p);
    walls.options.may_insert = [&](std::size_t body, const Vec3& p, const Vec3&)
    {
        bool is_apart = true;
        grid.for_each_near(p, 0.6 * dp,
                           [&](std::uint32_t i, double)
                           { is_apart = is_apart && all.bodies[i] == body; });
        return is_apart;
    };
    walls.relax(2);
    EXPECT_LE(farthest_point(walls), 0.78);
}

TEST(RelaxSurface, GivesNewParticlesTheMkAroundThem)
{
    Walls walls(sphere(4), 0.05);
    for (std::size_t i = 0; i < walls.particles.size(); ++i)
        walls.particles.mk[i] = walls.particles.positions[i].x > 0 ? 3 : 4;
    const RelaxSurfaceReport report = walls.relax();
    ASSERT_GT(report.inserted, 0u);
    for (std::size_t i = 0; i < walls.particles.size(); ++i)
    {
        const double x = walls.particles.positions[i].x;
        if (std::abs(x) < 0.1) continue;
        EXPECT_EQ(walls.particles.mk[i], x > 0 ? 3 : 4);
    }
}

TEST(RelaxSurface, RelaxesBodiesThatTouchOnTheirOwn)
{
    Walls both(sphere(4), 0.08);
    Transform aside;
    aside.offset = {1.5, 0, 0};
    both.add(moved(sphere(4), aside), 0.08);
    both.options.iterations = 20;
    both.relax();
    Walls one(sphere(4), 0.08);
    one.options.iterations = 20;
    one.relax();
    std::size_t of_first = 0;
    for (std::size_t i = 0; i < both.particles.size(); ++i)
        of_first += both.particles.bodies[i] == 0;
    ASSERT_EQ(of_first, one.particles.size());
    EXPECT_TRUE(std::is_sorted(both.particles.bodies.begin(), both.particles.bodies.end()));
    EXPECT_EQ(both.particles.mk.back(), 11);
}

TEST(RelaxSurface, TakesParticlesOfARoundShapeToTheFacets)
{
    Walls walls(sphere(3), 0.1);
    for (Vec3& p : walls.particles.positions) p = p / norm(p);
    walls.relax();
    for (std::size_t i = 0; i < walls.particles.size(); ++i) ASSERT_LE(off_facet(walls, i), 1e-9);
}

TEST(RelaxSurface, CrossesAnyNumberOfNarrowFacets)
{
    // A sheet of strips so narrow that a step leads over more facets than a walk may cross.
    TriangleSoup sheet;
    constexpr int strips = 6000;
    for (int i = 0; i < strips; ++i)
    {
        const double a = static_cast<double>(i) / strips;
        const double b = static_cast<double>(i + 1) / strips;
        add_quad(sheet, {a, 0, 0}, {b, 0, 0}, {b, 1, 0}, {a, 1, 0});
    }
    Walls walls(sheet, 0.1);
    const RelaxSurfaceReport report = walls.relax();
    EXPECT_GT(report.projected, 0u);
    EXPECT_EQ(report.returned, 0u);
    EXPECT_LT(report.after.spacing_variation, 0.06);
    EXPECT_LE(farthest_point(walls), 0.75);
    for (std::size_t i = 0; i < walls.particles.size(); ++i) ASSERT_LE(off_facet(walls, i), 1e-9);
}

TEST(RelaxSurface, CutsBodiesOfManyParticlesIntoSlabsWithoutSeams)
{
    for (const Named& shape :
         {Named{"sphere", sphere(5), 0.015, 0}, Named{"gear", gear(14, 0.8, 1, 3), 0.02, 0}})
    {
        SCOPED_TRACE(shape.name);
        Walls whole(shape.soup, shape.dp);
        Walls cut = whole;
        cut.options.together = 15'000;
        std::size_t pieces = 0;
        cut.options.on_progress = [&](const RelaxProgress& progress)
        {
            EXPECT_LE(progress.piece, progress.pieces);
            pieces = progress.pieces;
            return true;
        };
        const RelaxSurfaceReport of_whole = whole.relax(2);
        const RelaxSurfaceReport of_cut = cut.relax(2);
        EXPECT_GE(pieces, 3u);
        EXPECT_LE(farthest_point(cut), 0.75);
        EXPECT_GE(nearest_pair_dp(cut), 0.6);
        EXPECT_NEAR(of_cut.after.spacing_variation, of_whole.after.spacing_variation, 0.002);
        EXPECT_NEAR(of_cut.after.spacing_mean, of_whole.after.spacing_mean, 0.003);
        const auto n = static_cast<double>(whole.particles.size());
        EXPECT_NEAR(static_cast<double>(cut.particles.size()), n, 0.002 * n);
        EXPECT_EQ(of_cut.after.particles, cut.particles.size());
        for (std::size_t i = 0; i < cut.particles.size(); ++i) ASSERT_LE(off_facet(cut, i), 1e-9);
    }
}

/// Estimates of memory go by what is relaxed at once.
TEST(RelaxSurface, RelaxesAsManyTogetherAsEstimatesTakeItTo)
{
    EXPECT_EQ(static_cast<double>(RelaxSurfaceOptions{}.together), rates.relaxed_together);
}

TEST(RelaxSurface, GivesTheSameBytesInSlabsForAnyNumberOfThreads)
{
    Walls one(gear(14, 0.8, 1, 3), 0.02);
    one.options.together = 15'000;
    one.options.iterations = 20;
    Walls many = one;
    one.relax(1);
    many.relax(3);
    expect_same(one.particles, many.particles);
}

TEST(RelaxSurface, KeepsTheOrderOfBodiesWhereSomeAreCut)
{
    Walls walls(box({0, 0, 0}, {0.3, 0.3, 0.3}), 0.02);
    walls.add(gear(14, 0.8, 1, 3), 0.02);
    walls.add(box({2, 0, 0}, {2.3, 0.3, 0.3}), 0.02);
    walls.options.together = 15'000;
    const WallParticles given = walls.particles;
    for (std::size_t i = 0; i < given.size(); ++i) walls.held.push_back(given.positions[i].z > 2);
    const RelaxSurfaceReport report = walls.relax(2);
    const WallParticles& now = walls.particles;
    ASSERT_EQ(now.size(), given.size() + report.inserted - report.removed);
    ASSERT_EQ(walls.held.size(), now.size());
    ASSERT_TRUE(std::is_sorted(now.bodies.begin(), now.bodies.end()));
    EXPECT_GT(report.inserted, 0u);
    // Corners, edges and held particles stand where they stood, in their order.
    const auto is_fixed = [](const WallParticles& p, const std::vector<char>& held, std::size_t i)
    { return p.kinds[i] != FitKind::Surface || held[i] != 0; };
    std::size_t next = 0, fixed = 0;
    for (std::size_t i = 0; i < given.size(); ++i)
    {
        if (given.kinds[i] == FitKind::Surface && !(given.positions[i].z > 2)) continue;
        // Behind those of a body new ones may be held, beside such as are.
        const auto is_of_body = [&](std::size_t k) { return now.bodies[k] == given.bodies[i]; };
        while (next < now.size() && !(is_of_body(next) && is_fixed(now, walls.held, next))) ++next;
        ASSERT_LT(next, now.size());
        ASSERT_EQ(now.positions[next], given.positions[i]);
        EXPECT_EQ(now.mk[next], given.mk[i]);
        EXPECT_EQ(now.bodies[next++], given.bodies[i]);
        ++fixed;
    }
    EXPECT_GT(fixed, 1'000u);
}

TEST(RelaxSurface, KeepsAWholeStateWhenToldToStopAmidSlabs)
{
    Walls walls(gear(14, 0.8, 1, 3), 0.02);
    walls.options.together = 15'000;
    walls.options.on_progress = [&](const RelaxProgress& progress)
    { return progress.piece < 2 || progress.iteration < 9; };
    const std::size_t given = walls.particles.size();
    const RelaxSurfaceReport report = walls.relax(2);
    EXPECT_EQ(walls.particles.size(), given + report.inserted - report.removed);
    EXPECT_LE(farthest_point(walls), 0.92);
    for (std::size_t i = 0; i < walls.particles.size(); ++i) ASSERT_LE(off_facet(walls, i), 1e-9);
}

TEST(RelaxSurface, RefusesLengthsOutOfRange)
{
    Walls walls(sphere(2), 0.3);
    walls.options.h = 0.1;
    EXPECT_THROW(walls.relax(), GeometryError);
    walls.options.h = 0.8;
    walls.options.dp = 0;
    EXPECT_THROW(walls.relax(), GeometryError);
}

} // namespace fppg
