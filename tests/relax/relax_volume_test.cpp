#include "fppg/relax_volume.h"

#include "fit/fit_shapes.h"
#include "fppg/error.h"
#include "meshes/mesh_query.h"
#include "relax/volume_regions.h"

#include <gtest/gtest.h>

#include <limits>
#include <set>

namespace fppg
{

namespace
{

using namespace test;

double least_depth_dp(const VolumeRegion& region)
{
    double least = std::numeric_limits<double>::infinity();
    for (const Vec3& p : region.moving) least = std::min(least, region.depth(p) / region.dp);
    return least;
}

/// The smallest distance between any two volume or wall particles, of which one moves.
double least_gap_dp(const VolumeRegion& region)
{
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < region.moving.size(); ++i)
    {
        const Vec3& p = region.moving[i];
        for (std::size_t j = 0; j < i; ++j) least = std::min(least, norm(region.moving[j] - p));
        for (const Vec3& q : region.held) least = std::min(least, norm(q - p));
        for (const Vec3& q : region.walls) least = std::min(least, norm(q - p));
    }
    return least / region.dp;
}

RelaxVolumeReport relax(VolumeRegion& region, const RelaxVolumeOptions& options, int threads = 1)
{
    return relax_volume(region.moving, region.surroundings(), options, threads);
}

/// The options of a region where particles may be added and taken away.
RelaxVolumeOptions counting_options(const VolumeRegion& region)
{
    RelaxVolumeOptions options = region.options();
    options.fit_count = true;
    return options;
}

struct EvenBounds
{
    double std_before;   ///< at least, as given
    double mean_off_one; ///< at most
    double gap_dp;       ///< at least
};

/// Relaxes a region whose particles are uneven and holds them against bounds afterwards.
void expect_relaxed_evenly(VolumeRegion& region, const RelaxVolumeOptions& options,
                           const EvenBounds& bounds)
{
    EXPECT_GT(evenness(region).std, bounds.std_before);
    relax(region, options);
    const Evenness after = evenness(region);
    EXPECT_LT(after.std, 0.02);
    EXPECT_NEAR(after.mean, 1, bounds.mean_off_one);
    EXPECT_GT(least_gap_dp(region), bounds.gap_dp);
}

/// Lattice nodes that miss a box by uneven amounts: 0.6 dp at one side, 0.4 at the other.
VolumeRegion shifted_box()
{
    return box_region({1.6, 1.4, 1.2}, {0.06, 0.08, 0.03});
}

/// A tank of 1.6 x 1.4 with water up to z = 1.
VolumeRegion tank()
{
    return box_region({1.6, 1.4, 1.5}, {0.06, 0.08, 0.05}, false, false, 1.0);
}

} // namespace

TEST(RelaxVolume, SpreadsParticlesEvenlyInASphere)
{
    VolumeRegion region = ball(1);
    expect_relaxed_evenly(region, region.options(),
                          {.std_before = 0.03, .mean_off_one = 0.03, .gap_dp = 0.6});
}

TEST(RelaxVolume, FitsTheCountInABoxThatTheLatticeMisses)
{
    VolumeRegion region = shifted_box();
    expect_relaxed_evenly(region, counting_options(region),
                          {.std_before = 0.07, .mean_off_one = 0.02, .gap_dp = 0.6});
    const double counted = static_cast<double>(region.moving.size() + region.held.size()) +
                           0.5 * static_cast<double>(region.walls.size());
    EXPECT_NEAR(counted * 0.001, 1.6 * 1.4 * 1.2, 0.02 * 1.6 * 1.4 * 1.2);
}

TEST(RelaxVolume, SpreadsParticlesEvenlyBetweenTheFittedTeethOfAGear)
{
    const TriangleSoup soup = gear(8, 0.8, 1.1, 0.9);
    const MeshQuery query(soup);
    VolumeRegion region;
    region.walls = FitInput(soup, region.dp).fit().positions;
    region.closest = [&](const Vec3& p) { return query.closest_point(p).point; };
    region.depth = [&](const Vec3& p)
    { return (winding_number(soup, p) > 0.5 ? 1 : -1) * query.closest_point(p).distance; };
    region.fill({-1.13, -1.14, 0.03}, {1.2, 1.2, 0.9});
    expect_relaxed_evenly(region, counting_options(region),
                          {.std_before = 0.06, .mean_off_one = 0.03, .gap_dp = 0.6});
    EXPECT_GE(least_depth_dp(region), 0.4 - 1e-5);
}

TEST(RelaxVolume, SpreadsParticlesEvenlyWithAWiderKernel)
{
    for (const double h : {0.8, 1.3, 1.6})
    {
        VolumeRegion region = ball(1);
        RelaxVolumeOptions options = counting_options(region);
        options.h_dp = h;
        relax(region, options);
        EXPECT_LT(evenness(region).std, 0.02) << h;
        EXPECT_NEAR(evenness(region).mean, 1, 0.03) << h;
        EXPECT_GE(least_depth_dp(region), 0.4 - 1e-5) << h;
    }
}

TEST(RelaxVolume, KeepsALatticeWhoseWallsLieOnNodes)
{
    VolumeRegion region = box_region({1.5, 1.4, 1.2}, {0.1, 0.1, 0.1});
    const std::size_t n = region.moving.size();
    EXPECT_LT(evenness(region).std, 0.01);
    const RelaxVolumeReport report = relax(region, counting_options(region));
    EXPECT_LT(report.removed + report.inserted, n / 50);
    EXPECT_LT(evenness(region).std, 0.01);
    EXPECT_NEAR(evenness(region).mean, 1.0095, 0.01); // the sum over the lattice
}

TEST(RelaxVolume, SaysWhichParticleEachOneCameFrom)
{
    VolumeRegion region = shifted_box();
    const auto before = region.moving;
    const RelaxVolumeReport report = relax(region, counting_options(region));
    ASSERT_EQ(report.sources.size(), region.moving.size());
    EXPECT_GT(report.removed, 0U);
    EXPECT_GT(report.inserted, 0U);
    EXPECT_EQ(region.moving.size(), before.size() - report.removed + report.inserted);
    const std::size_t kept = before.size() - report.removed;
    for (std::size_t i = 0; i < region.moving.size(); ++i)
    {
        EXPECT_LT(norm(region.moving[i] - before[report.sources[i]]), 0.3);
        if (i == 0 || i >= kept) continue;
        EXPECT_LT(report.sources[i - 1], report.sources[i]);
    }
}

TEST(RelaxVolume, LetsNoParticleThroughAWallHoweverCrowdedTheyAre)
{
    VolumeRegion region;
    region = box_region({1.6, 1.4, 1.2}, {0.03, 0.02, 0.025});
    region.moving.clear();
    region.held.clear();
    region.dp = 0.08; // a denser lattice than the walls are made for
    region.fill({0.01, 0.02, 0.025}, {1.6, 1.4, 1.2}, 0.1);
    const double start = least_depth_dp(region);
    const std::size_t n = region.moving.size();
    region.dp = 0.1;
    relax(region, region.options());
    EXPECT_EQ(region.moving.size(), n);
    EXPECT_LT(start * 0.8, 0.4);
    EXPECT_GE(least_depth_dp(region), std::min(0.4, start * 0.8) - 1e-5);
}

TEST(RelaxVolume, KeepsTheMinimumDistanceToTheWall)
{
    VolumeRegion region = ball(1);
    RelaxVolumeOptions options = region.options();
    options.min_wall_distance_dp = 0.5;
    relax(region, options);
    EXPECT_GE(least_depth_dp(region), 0.5 - 1e-5);
}

TEST(RelaxVolume, LeavesTheFreeSurfaceWhereItWas)
{
    VolumeRegion region = tank();
    const auto before = region.moving;
    const Evenness start = evenness(region, 0.7);
    const RelaxVolumeReport report = relax(region, region.options());
    double top = 0;
    for (const Vec3& p : before) top = std::max(top, p.z);
    std::size_t moved = 0;
    for (std::size_t i = 0; i < before.size(); ++i)
    {
        if (before[i].z > top - 1.5 * region.dp)
            EXPECT_EQ(region.moving[i], before[i]);
        else
            moved += norm(region.moving[i] - before[i]) > 0.02 * region.dp ? 1 : 0;
    }
    EXPECT_GT(report.held_at_surface, 0U);
    EXPECT_GT(moved, before.size() / 2);
    EXPECT_LT(evenness(region, 0.7).std, start.std);
}

TEST(RelaxVolume, FitsTheCountUnderAFreeSurface)
{
    VolumeRegion region = tank();
    RelaxVolumeOptions options = counting_options(region);
    options.iterations = 40;
    const auto before = region.moving;
    relax(region, options);
    const Evenness after = evenness(region, 0.6);
    EXPECT_LT(after.std, 0.02);
    EXPECT_NEAR(after.mean, 1, 0.02);
    const auto at_top = [](const std::vector<Vec3>& particles)
    {
        std::set<std::tuple<double, double, double>> top;
        for (const Vec3& p : particles)
            if (p.z > 0.85) top.emplace(p.x, p.y, p.z);
        return top;
    };
    EXPECT_EQ(at_top(region.moving), at_top(before));
}

TEST(RelaxVolume, KeepsYInThePlane)
{
    VolumeRegion region = box_region({2, 0, 1.5}, {0.06, 0, 0.08}, true);
    expect_relaxed_evenly(region, counting_options(region),
                          {.std_before = 0.05, .mean_off_one = 0.03, .gap_dp = 0.5});
    for (const Vec3& p : region.moving) EXPECT_EQ(p.y, 0);
    EXPECT_GE(least_depth_dp(region), 0.4 - 1e-5);
}

TEST(RelaxVolume, EndsWhereEveryParticleTouchesAWall)
{
    VolumeRegion region;
    region.is_2d = true;
    region.closest = [](const Vec3& p) { return p; };
    region.depth = [&](const Vec3& p)
    { return 0.9 - std::max(std::abs(p.x), std::abs(p.z)) + 0.55 * region.dp; };
    region.fill({-0.9, 0, -0.9}, {0.91, 0, 0.91});
    region.moving.resize(region.moving.size() / 2);
    relax(region, counting_options(region));
    for (const Vec3& p : region.moving) EXPECT_TRUE(is_finite(p));
}

TEST(RelaxVolume, GivesTheSameBytesForAnyNumberOfThreads)
{
    for (const bool fit_count : {false, true})
    {
        VolumeRegion region = shifted_box();
        const auto start = region.moving;
        RelaxVolumeOptions options = region.options();
        options.fit_count = fit_count;
        relax(region, options, 1);
        const auto one = region.moving;
        for (const int threads : {2, 8})
        {
            region.moving = start;
            relax(region, options, threads);
            EXPECT_EQ(region.moving, one) << threads << " threads";
        }
    }
}

TEST(RelaxVolume, StopsWhenTold)
{
    VolumeRegion region = ball(0.6);
    RelaxVolumeOptions options = region.options();
    std::vector<int> seen;
    options.on_iteration = [&](const RelaxVolumeProgress& progress)
    {
        seen.push_back(progress.iteration);
        EXPECT_GT(progress.shepard_mean, 0.9);
        EXPECT_LE(progress.largest_step_dp, 0.1 + 1e-6);
        return progress.iteration < 4;
    };
    EXPECT_EQ(relax(region, options).iterations, 4);
    EXPECT_EQ(seen, (std::vector<int>{1, 2, 3, 4}));
}

TEST(RelaxVolume, EndsByItselfWhenTheSpreadHasSettled)
{
    VolumeRegion region = ball(1);
    RelaxVolumeOptions options = region.options();
    options.iterations = 0;
    const RelaxVolumeReport report = relax(region, options);
    EXPECT_GT(report.iterations, 10);
    EXPECT_LT(report.iterations, 100);
    EXPECT_LT(evenness(region).std, 0.015);
}

TEST(RelaxVolume, TakesNoParticlesAndNoWalls)
{
    std::vector<Vec3> none;
    RelaxVolumeOptions options;
    options.dp = 0.1;
    EXPECT_EQ(relax_volume(none, {}, options, 1).iterations, 0);
    // Without a wall every node of a small block is at a free surface or near to it.
    std::vector<Vec3> block;
    for (const int x : {0, 1, 2})
        for (const int y : {0, 1, 2})
            for (const int z : {0, 1, 2}) block.push_back({0.1 * x, 0.1 * y, 0.1 * z});
    const auto before = block;
    EXPECT_EQ(relax_volume(block, {}, options, 1).held_at_surface, 27U);
    EXPECT_EQ(block, before);
}

TEST(RelaxVolume, RefusesWhatIsOutOfRange)
{
    std::vector<Vec3> one{{0, 0, 0}};
    RelaxVolumeOptions options;
    EXPECT_THROW(relax_volume(one, {}, options, 1), GeometryError);
    options.dp = 0.1;
    options.h_dp = 0.1;
    EXPECT_THROW(relax_volume(one, {}, options, 1), GeometryError);
    options.h_dp = 1;
    one[0].y = std::numeric_limits<double>::quiet_NaN();
    EXPECT_THROW(relax_volume(one, {}, options, 1), GeometryError);
}

TEST(ShepardSums, AreOneOnALatticeBetweenWallsOnNodes)
{
    const VolumeRegion region = box_region({1.5, 1.4, 1.2}, {0.1, 0.1, 0.1});
    ShepardOptions options;
    options.dp = region.dp;
    for (const double sum : shepard_sums(region.moving, region.surroundings(), options, 2))
        EXPECT_NEAR(sum, 1, 0.035);
}

} // namespace fppg
