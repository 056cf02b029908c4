#include "fppg/exclusion_band.h"

#include "fit/fit_shapes.h"
#include "fit/wall_of_soup.h"
#include "fppg/error.h"
#include "fppg/shapes.h"
#include "meshes/mesh_query.h"
#include "meshes/spans_helpers.h"

#include <gtest/gtest.h>

namespace fppg
{
namespace
{

using namespace test;

/// Every node of a lattice: is it kept inside, left out, and how far from the surface in dp.
struct NodeTable
{
    std::vector<bool> volume, zone, inside;
    std::vector<double> distance;

    NodeTable(const TriangleSoup& soup, const LatticeGrid& grid, const ExclusionBand& found)
        : volume(nodes_of(found.volume, grid)),
          zone(nodes_of(found.zone, grid)),
          inside(nodes_of(inside_spans(soup, grid, 1), grid))
    {
        const MeshQuery query(soup);
        for (std::uint32_t i = 0; i < grid.n[0]; ++i)
            for (std::uint32_t j = 0; j < grid.n[1]; ++j)
                for (std::uint32_t k = 0; k < grid.n[2]; ++k)
                    distance.push_back(query.closest_point(node(grid, i, j, k)).distance / grid.dp);
    }
};

void expect_no_way_through(const LatticeGrid& grid, const NodeTable& nodes)
{
    const std::size_t steps[3] = {std::size_t{grid.n[1]} * grid.n[2], grid.n[2], 1};
    const auto is_kept = [&](std::size_t at) { return !nodes.zone[at]; };
    for (std::size_t at = 0; at < nodes.zone.size(); ++at)
        for (const std::size_t step : steps)
        {
            if (at + step >= nodes.zone.size()) continue;
            const bool crosses = nodes.inside[at] != nodes.inside[at + step];
            ASSERT_FALSE(crosses && is_kept(at) && is_kept(at + step)) << "at node " << at;
        }
}

TEST(ExclusionBand, HoldsTheNodesOfThePlainSearch)
{
    for (const TriangleSoup& soup : {sphere(3), gear(8, 0.8, 1.0, 0.5), sphere(5), octahedron(1)})
    {
        const FittedMesh fitted = fit_soup(soup, 0.13);
        const NodeTable nodes(soup, fitted.grid, fitted.zone);
        for (std::size_t at = 0; at < nodes.zone.size(); ++at)
        {
            const double d = nodes.distance[at];
            const double clearance = nodes.inside[at] ? fitted.zone.clearance_inside_dp
                                                      : fitted.zone.clearance_outside_dp;
            ASSERT_EQ(nodes.volume[at], nodes.inside[at] && !nodes.zone[at]);
            ASSERT_TRUE(nodes.zone[at] ? d <= 1 + 1e-8 : d >= clearance - 2e-9) << d;
            ASSERT_TRUE(nodes.zone[at] || d >= 0.5 - 1e-8) << d;
        }
    }
}

TEST(ExclusionBand, NodesAndWhatIsInsideOfTheWallMakeUpTheVolume)
{
    for (const double shift : {0.0, 0.2, 0.5, 0.7})
        EXPECT_NEAR(fit_soup(sphere(4), 0.04, shift).zone.volume_error, 0, 0.005);
    for (const double shift : {0.0, 0.5})
        EXPECT_NEAR(fit_soup(gear(12, 0.8, 1.0, 0.5), 0.04, shift).zone.volume_error, 0, 0.005);
}

TEST(ExclusionBand, FillsAnAlignedCubeThoughItsNodesAllStandEquallyFar)
{
    const FittedMesh fitted = fit_soup(box({0, 0, 0}, {2, 2, 2}), 0.05, 0);
    EXPECT_NEAR(fitted.volume(), 8, 0.02);
    EXPECT_NEAR(fit_soup(box({0, 0, 0}, {2, 2, 2}), 0.05, 0.5).volume(), 8, 0.02);
}

TEST(ExclusionBand, LeavesNoNodeOutBehindFacesOnNodes)
{
    // Particles on edges stand for a quarter of a cell inside, those on corners for an eighth.
    const FittedMesh fitted = fit_soup(box({0, 0, 0}, {2, 1.5, 1}), 0.05, 0);
    EXPECT_EQ(fitted.volume_nodes(), 39u * 29 * 19);
    EXPECT_EQ(count_nodes(fitted.zone.zone), 41u * 31 * 21 - 39u * 29 * 19);
}

TEST(ExclusionBand, LeavesRoomOutsideForTheOtherHalfOfTheWall)
{
    const FittedMesh fitted = fit_soup(sphere(4), 0.07);
    const NodeTable nodes(sphere(4), fitted.grid, fitted.zone);
    double taken = 0;
    for (std::size_t at = 0; at < nodes.zone.size(); ++at)
        taken += nodes.inside[at] || nodes.zone[at] ? 1 : 0;
    const double cells = fitted.zone.body_volume / (0.07 * 0.07 * 0.07);
    EXPECT_NEAR(taken, cells + 0.5 * static_cast<double>(fitted.wall_particles), 1);
}

TEST(ExclusionBand, LetsNoFillThrough)
{
    for (const double shift : {0.0, 0.5, 0.37})
        for (const TriangleSoup& soup :
             {box({0, 0, 0}, {1, 1, 1}), box({0, 0, 0}, {1, 1, 0.1}), sphere(3)})
        {
            const FittedMesh fitted = fit_soup(soup, 0.1, shift);
            expect_no_way_through(fitted.grid, NodeTable(soup, fitted.grid, fitted.zone));
        }
}

TEST(ExclusionBand, SpreadsEquallyFarNodesEvenly)
{
    // The nodes 0.8 dp below the top of the box: every 10 x 10 of them keep about as many.
    const TriangleSoup soup = box({0, 0, 0}, {5.98, 5.98, 5.98});
    const FittedMesh fitted = fit_soup(soup, 0.1, 0);
    ASSERT_NEAR(fitted.zone.clearance_inside_dp, 0.8, 1e-6);
    const std::vector<bool> zone = nodes_of(fitted.zone.zone, fitted.grid);
    const auto count = [&](std::uint32_t i0, std::uint32_t j0)
    {
        int sum = 0;
        for (std::uint32_t i = i0; i < i0 + 10; ++i)
            for (std::uint32_t j = j0; j < j0 + 10; ++j)
                sum +=
                    zone[(std::size_t{i} * fitted.grid.n[1] + j) * fitted.grid.n[2] + 62] ? 1 : 0;
        return sum;
    };
    const int first = count(10, 10);
    EXPECT_GT(first, 0);
    EXPECT_LT(first, 100);
    for (std::uint32_t i = 10; i <= 50; i += 10)
        for (std::uint32_t j = 10; j <= 50; j += 10) EXPECT_NEAR(count(i, j), first, 6);
}

TEST(ExclusionBand, HasNoInsideInASheet)
{
    TriangleSoup soup;
    add_quad(soup, {0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0});
    const FittedMesh fitted = fit_soup(soup, 0.1, 0);
    EXPECT_FALSE(fitted.zone.has_inside);
    EXPECT_TRUE(fitted.zone.volume.slabs.empty());
    EXPECT_EQ(fitted.zone.clearance_outside_dp, 0.5);
    EXPECT_EQ(count_nodes(fitted.zone.zone), 121u);
    EXPECT_EQ(fitted.zone.warnings.size(), 1u);
}

TEST(ExclusionBand, KeepsAGivenClearance)
{
    MeshReport report;
    const SurfaceMesh mesh = repair_mesh(sphere(3), {}, 1, report);
    const LatticeGrid grid = lattice_around(report.bounds, 0.1, 0.3);
    ExclusionBandOptions options;
    options.clearance_dp = 0.8;
    const ExclusionBand zone = exclusion_band(mesh, report, grid, options, 1);
    const NodeTable nodes(sphere(3), grid, zone);
    for (std::size_t at = 0; at < nodes.zone.size(); ++at)
        ASSERT_EQ(nodes.zone[at], nodes.distance[at] < 0.8);
    options.clearance_dp = 0.4;
    EXPECT_THROW(exclusion_band(mesh, report, grid, options, 1), GeometryError);
}

TEST(ExclusionBand, OfALatticeThatCutsTheBodyIsThatOfTheWholeBody)
{
    MeshReport report;
    const SurfaceMesh mesh = repair_mesh(sphere(3), {}, 1, report);
    const LatticeGrid whole = lattice_around(report.bounds, 0.125, 0);
    LatticeGrid part = whole;
    part.origin.x += 8 * 0.125;
    part.origin.z += 5 * 0.125;
    part.n[0] -= 12;
    part.n[2] -= 5;
    ExclusionBandOptions options;
    options.wall_particles = 800;
    const ExclusionBand all = exclusion_band(mesh, report, whole, options, 1);
    const ExclusionBand cut = exclusion_band(mesh, report, part, options, 1);
    EXPECT_EQ(cut.volume_error, all.volume_error);
    const auto all_nodes = nodes_of(all.volume, whole), cut_nodes = nodes_of(cut.volume, part);
    std::size_t same = 0, at = 0;
    for (std::uint32_t i = 0; i < part.n[0]; ++i)
        for (std::uint32_t j = 0; j < part.n[1]; ++j)
            for (std::uint32_t k = 0; k < part.n[2]; ++k, ++at)
                same +=
                    cut_nodes[at] ==
                            all_nodes[(std::size_t{i + 8} * whole.n[1] + j) * whole.n[2] + k + 5]
                        ? 1
                        : 0;
    // Equally far nodes are chosen by their numbers in the lattice, and few of them differ.
    EXPECT_GT(static_cast<double>(same), 0.99 * static_cast<double>(at));
}

TEST(ExclusionBand, IsAboutTheSectionIn2D)
{
    MeshReport report;
    const SurfaceMesh mesh = repair_mesh(sphere(5), {}, 1, report);
    LatticeGrid grid = lattice_around(report.bounds, 0.02, 0.3);
    grid.is_2d = true;
    grid.origin.y = 0.6;
    grid.n[1] = 1;
    ExclusionBandOptions options;
    options.wall_particles = 251; // a circle of radius 0.8, every 0.02
    const ExclusionBand zone = exclusion_band(mesh, report, grid, options, 1);
    EXPECT_NEAR(zone.body_volume / 0.02, 3.14159 * 0.64, 0.01);
    EXPECT_NEAR(zone.volume_error, 0, 0.001);
    for (const auto& [set, is_volume] : {std::pair{zone.volume, true}, std::pair{zone.zone, false}})
        for (std::size_t slab = 0; slab < set.slabs.size(); ++slab)
            for (const Span& span : set.slabs[slab])
                for (std::uint32_t k = span.z_begin; k < span.z_end; ++k)
                {
                    const Vec3 p =
                        node(grid, set.x_begin + static_cast<std::uint32_t>(slab), span.y, k);
                    const double inwards = (0.8 - std::hypot(p.x, p.z)) / 0.02;
                    ASSERT_TRUE(is_volume ? inwards > 0.45 : std::abs(inwards) < 1.05) << inwards;
                }
}

TEST(ExclusionBand, IsTheSameForOneAndEightThreads)
{
    const TriangleSoup soup = joined(sphere(4), moved(sphere(4), {.offset = {1, 0.1, 0.2}}));
    const ExclusionBand one = fit_soup(soup, 0.05, 0.3, 1).zone;
    const ExclusionBand eight = fit_soup(soup, 0.05, 0.3, 8).zone;
    EXPECT_EQ(one.volume.slabs, eight.volume.slabs);
    EXPECT_EQ(one.zone.slabs, eight.zone.slabs);
    EXPECT_EQ(one.volume_error, eight.volume_error);
    EXPECT_EQ(one.warnings, eight.warnings);
}

} // namespace
} // namespace fppg
