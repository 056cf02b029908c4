#include "fppg/fit.h"

#include "fit/fit_shapes.h"
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

struct Named
{
    const char* name;
    TriangleSoup soup;
    double dp;
};

std::vector<Named> shapes()
{
    return {{"sphere of small facets", sphere(5), 0.03},
            {"sphere of large facets", sphere(2), 0.01},
            {"cube", box({0, 0, 0}, {1, 1, 1}), 0.05},
            {"cube of more than one chart", box({0, 0, 0}, {1, 1, 1}), 0.006},
            {"cube off the lattice", box({0.1, 0.2, 0.3}, {1.13, 1.17, 1.21}), 0.0371},
            {"gear", gear(14, 0.8, 1, 0.3), 0.02},
            {"coarse gear", gear(14, 0.8, 1, 0.3), 0.06},
            {"thin plate", box({0, 0, 0}, {1, 1, 0.012}), 0.03},
            {"strips of 1.5 dp", box({0, 0, 0}, {2, 0.03, 0.045}), 0.02},
            {"wedge", wedge(), 0.03}};
}

double farthest_point(const FitInput& input, const SurfaceParticles& particles)
{
    return farthest_point_dp(input.mesh, particles.positions, input.options.dp, 12);
}

/// The smallest distance of a surface particle to any other on its side of the body, in dp.
double least_distance(const SurfaceMesh& mesh, const SurfaceParticles& particles, double dp)
{
    PointGrid grid(dp, particles.positions.size());
    for (const Vec3& p : particles.positions) grid.add(p);
    double least = dp * dp;
    for (std::uint32_t i = 0; i < particles.positions.size(); ++i)
    {
        if (particles.kinds[i] != FitKind::Surface) continue;
        const Vec3& normal = mesh.normals[particles.facets[i]];
        grid.for_each_near(particles.positions[i], dp,
                           [&](std::uint32_t j, double squared)
                           {
                               if (j != i && dot(normal, mesh.normals[particles.facets[j]]) > -0.5)
                                   least = std::min(least, squared);
                           });
    }
    return std::sqrt(least) / dp;
}

} // namespace

TEST(FitSurface, LeavesNoPointOfTheSurfaceFarFromAParticle)
{
    for (const Named& shape : shapes())
    {
        const FitInput input(shape.soup, shape.dp);
        EXPECT_LE(farthest_point(input, input.fit()), 0.92) << shape.name;
    }
}

TEST(FitSurface, KeepsParticlesApart)
{
    for (const Named& shape : shapes())
    {
        const FitInput input(shape.soup, shape.dp);
        EXPECT_GE(least_distance(input.mesh, input.fit(), shape.dp), 0.8) << shape.name;
    }
}

TEST(FitSurface, PutsOneParticleOnADpSquared)
{
    for (const Named& shape : shapes())
    {
        const FitInput input(shape.soup, shape.dp);
        double length = 0;
        for (const FeatureLine& line : input.features.lines) length += line.length;
        if (length / shape.dp > 0.5 * input.area_dp2()) continue;
        const double density = static_cast<double>(input.fit().positions.size()) / input.area_dp2();
        EXPECT_GE(density, 0.9) << shape.name;
        EXPECT_LE(density, length / shape.dp > 0.2 * input.area_dp2() ? 1.25 : 1.15) << shape.name;
    }
}

TEST(FitSurface, PutsParticlesOnTheirFacets)
{
    for (const Named& shape : shapes())
    {
        const FitInput input(shape.soup, shape.dp);
        const MeshQuery query(shape.soup);
        const SurfaceParticles particles = input.fit();
        ASSERT_EQ(particles.positions.size(), particles.facets.size());
        double farthest = 0;
        double off_plane = 0;
        for (std::size_t i = 0; i < particles.positions.size(); ++i)
        {
            const Vec3& p = particles.positions[i];
            const std::uint32_t f = particles.facets[i];
            const Vec3& corner = input.mesh.vertices[input.mesh.facets[f][0]];
            farthest = std::max(farthest, query.closest_point(p).distance);
            off_plane = std::max(off_plane, std::abs(dot(p - corner, input.mesh.normals[f])));
        }
        EXPECT_LE(farthest, 1e-10 * shape.dp) << shape.name;
        EXPECT_LE(off_plane, 1e-10 * shape.dp) << shape.name;
    }
}

TEST(FitSurface, KeepsAllFeatureParticlesCornersFirst)
{
    const FitInput input(gear(14, 0.8, 1, 0.3), 0.02);
    const SurfaceParticles particles = input.fit();
    std::size_t corners = 0;
    for (const FeatureParticle& p : input.on_features) corners += p.is_corner;
    EXPECT_EQ(corners, 14u * 8u);
    EXPECT_TRUE(std::is_sorted(particles.kinds.begin(), particles.kinds.end()));
    const auto count = [&](FitKind kind)
    {
        return static_cast<std::size_t>(
            std::count(particles.kinds.begin(), particles.kinds.end(), kind));
    };
    EXPECT_EQ(count(FitKind::Corner), corners);
    EXPECT_EQ(count(FitKind::Edge), input.on_features.size() - corners);
}

TEST(FitSurface, GivesTheSameBytesForAnyNumberOfThreads)
{
    for (const Named& shape : shapes())
    {
        const FitInput input(shape.soup, shape.dp);
        const SurfaceParticles one = input.fit(1);
        for (const int threads : {2, 8})
        {
            const SurfaceParticles many = input.fit(threads);
            ASSERT_EQ(one.positions.size(), many.positions.size()) << shape.name;
            EXPECT_EQ(std::memcmp(one.positions.data(), many.positions.data(),
                                  one.positions.size() * sizeof(Vec3)),
                      0)
                << shape.name;
            EXPECT_EQ(one.facets, many.facets) << shape.name;
            EXPECT_EQ(one.kinds, many.kinds) << shape.name;
        }
    }
}

TEST(FitSurface, CoversBothSidesOfAThinPlate)
{
    const FitInput input(box({0, 0, 0}, {1, 1, 0.002}), 0.05);
    const SurfaceParticles particles = input.fit();
    std::size_t above = 0;
    std::size_t below = 0;
    for (std::size_t i = 0; i < particles.positions.size(); ++i)
    {
        if (particles.kinds[i] != FitKind::Surface) continue;
        const double z = input.mesh.normals[particles.facets[i]].z;
        above += z > 0.5;
        below += z < -0.5;
    }
    EXPECT_NEAR(static_cast<double>(above), 19 * 19, 36);
    EXPECT_NEAR(static_cast<double>(below), 19 * 19, 36);
}

TEST(FitSurface, PutsAParticleOnABodySmallerThanDp)
{
    const FitInput input(sphere(3), 5);
    EXPECT_EQ(input.fit().positions.size(), 1u);
}

TEST(FitSurface, PutsAParticleOnEveryCrumbApartFromOthers)
{
    TriangleSoup crumbs;
    for (int i = 0; i < 4; ++i)
        for (int j = 0; j < 4; ++j)
        {
            Transform place;
            for (int axis = 0; axis < 3; ++axis)
                place.linear[static_cast<std::size_t>(axis)] =
                    place.linear[static_cast<std::size_t>(axis)] * 0.1;
            place.offset = {2.0 * i, 2.0 * j, 0};
            crumbs = joined(crumbs, moved(sphere(2), place));
        }
    EXPECT_EQ(FitInput(crumbs, 1).fit().positions.size(), 16u);
}

TEST(FitSurface, TakesAHeapOfTinyLooseFacets)
{
    TriangleSoup heap;
    for (int i = 0; i < 20000; ++i)
    {
        const Vec3 p{std::fmod(0.7548776662466927 * i, 1.0), std::fmod(0.5698402909980532 * i, 1.0),
                     std::fmod(0.8191725133961645 * i, 1.0)};
        add_facet(heap, p, p + Vec3{1e-3, 0, 0}, p + Vec3{0, 1e-3, 0});
    }
    const FitInput input(heap, 0.3);
    const SurfaceParticles particles = input.fit();
    EXPECT_GT(particles.positions.size(), 40u);
    EXPECT_LE(farthest_point(input, particles), 0.92);
}

TEST(FitSurface, CellDensityPutsOneParticleOnEveryCrossedCell)
{
    FitInput input(sphere(4), 0.05);
    input.options.density = FitDensity::Cell;
    input.options.lattice_origin = {0.01, 0.02, 0.03};
    const SurfaceParticles particles = input.fit(2);
    const MeshQuery query(sphere(4));
    for (const Vec3& p : particles.positions) EXPECT_LE(query.closest_point(p).distance, 1e-12);
    // A sphere crosses a cell and a half a dp squared: the mean over all tilts of a plane.
    const double density = static_cast<double>(particles.positions.size()) / input.area_dp2();
    EXPECT_NEAR(density, 1.5, 0.05);
    EXPECT_EQ(particles.positions, input.fit(1).positions);
}

TEST(FitSurface, CellDensityCountsAPlaneBetweenCellsOnce)
{
    FitInput input(box({0.5, 0.5, 0.5}, {10.5, 10.5, 10.5}), 1);
    input.options.density = FitDensity::Cell;
    const SurfaceParticles particles = input.fit();
    // Nodes 1 to 10 a side project onto each face; edges and corners carry their own.
    const auto surface =
        std::count(particles.kinds.begin(), particles.kinds.end(), FitKind::Surface);
    EXPECT_EQ(surface, 6 * 100 + 12 * 10);
}

} // namespace fppg
