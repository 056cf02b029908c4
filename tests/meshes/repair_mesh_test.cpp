#include "fppg/surface_mesh.h"

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <random>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "fppg/error.h"
#include "fppg/shapes.h"
#include "meshes/test_shapes.h"

namespace fppg
{

namespace
{

using test::add_facet;
using test::add_quad;
using test::box;
using test::inverted;
using test::joined;
using test::moved;
using test::sphere;

SurfaceMesh taken_in(const TriangleSoup& soup, MeshReport& report, double weld_distance = 0,
                     int threads = 2)
{
    return repair_mesh(soup, {.weld_distance = weld_distance, .count_self_intersections = true},
                       threads, report);
}

TriangleSoup open_box()
{
    TriangleSoup soup = box({0, 0, 0}, {1, 1, 1});
    soup.vertices.erase(soup.vertices.begin() + 6, soup.vertices.begin() + 12); // the top
    return soup;
}

} // namespace

TEST(TakeInMesh, WeldsACubeToEightVerticesAndEighteenEdges)
{
    MeshReport report;
    const SurfaceMesh mesh = taken_in(box({0, 0, 0}, {1, 2, 3}), report);
    EXPECT_EQ(mesh.vertices.size(), 8u);
    EXPECT_EQ(mesh.edges.size(), 18u);
    EXPECT_TRUE(report.is_watertight);
    EXPECT_EQ(report.shells, 1u);
    EXPECT_DOUBLE_EQ(report.volume, 6);
    EXPECT_DOUBLE_EQ(report.area, 22);
    EXPECT_TRUE(report.warnings.empty());
    EXPECT_EQ(report.bounds.max, (Vec3{1, 2, 3}));
}

TEST(TakeInMesh, LeadsFromEverySideToTheNeighbourAndBack)
{
    MeshReport report;
    const SurfaceMesh mesh = taken_in(sphere(2), report);
    for (std::uint32_t f = 0; f < mesh.facets.size(); ++f)
        for (std::size_t s = 0; s < 3; ++s)
        {
            const std::uint32_t edge = mesh.facet_edges[f][s];
            const auto [a, b] = mesh.edges[edge];
            EXPECT_LT(a, b);
            EXPECT_TRUE((mesh.facets[f][s] == a && mesh.facets[f][(s + 1) % 3] == b) ||
                        (mesh.facets[f][s] == b && mesh.facets[f][(s + 1) % 3] == a));
            const auto& back = mesh.neighbours[mesh.neighbours[f][s]];
            EXPECT_NE(std::find(back.begin(), back.end(), f), back.end());
        }
    EXPECT_TRUE(std::is_sorted(mesh.edges.begin(), mesh.edges.end()));
}

TEST(TakeInMesh, TurnsFlippedFacetsAndCountsThem)
{
    TriangleSoup soup = sphere(3);
    std::mt19937 random(1);
    std::size_t flipped = 0;
    for (std::size_t f = 0; f < soup.size(); ++f)
        if (random() % 10 < 3)
        {
            std::swap(soup.vertices[3 * f + 1], soup.vertices[3 * f + 2]);
            ++flipped;
        }
    MeshReport report;
    taken_in(soup, report);
    EXPECT_EQ(report.flipped_facets, flipped);
    EXPECT_TRUE(report.is_watertight);
    EXPECT_GT(report.volume, 4);
}

TEST(TakeInMesh, TurnsAnInsideOutMeshAsAWhole)
{
    MeshReport report;
    const SurfaceMesh mesh = taken_in(inverted(sphere(2)), report);
    EXPECT_EQ(report.flipped_facets, mesh.facets.size());
    EXPECT_GT(report.volume, 0);
    for (std::size_t f = 0; f < mesh.facets.size(); ++f)
        EXPECT_GT(dot(mesh.normals[f], mesh.vertices[mesh.facets[f][0]]), 0);
}

TEST(TakeInMesh, KeepsACavityACavity)
{
    MeshReport report;
    const TriangleSoup soup =
        joined(box({0, 0, 0}, {3, 3, 3}), inverted(box({1, 1, 1}, {2, 2, 2})));
    taken_in(soup, report);
    EXPECT_EQ(report.shells, 2u);
    EXPECT_EQ(report.flipped_facets, 0u);
    EXPECT_DOUBLE_EQ(report.volume, 26);
    taken_in(inverted(soup), report);
    EXPECT_EQ(report.flipped_facets, soup.size());
    EXPECT_DOUBLE_EQ(report.volume, 26);
}

TEST(TakeInMesh, TurnsOneOfTwoBodiesSideBySide)
{
    MeshReport report;
    taken_in(joined(box({0, 0, 0}, {1, 1, 1}), inverted(box({2, 0, 0}, {3, 1, 1}))), report);
    EXPECT_EQ(report.flipped_facets, 12u);
    EXPECT_DOUBLE_EQ(report.volume, 2);
}

TEST(TakeInMesh, CountsOpenEdgesOfABoxWithoutLid)
{
    MeshReport report;
    const SurfaceMesh mesh = taken_in(open_box(), report);
    EXPECT_EQ(report.open_edges, 4u);
    EXPECT_FALSE(report.is_watertight);
    ASSERT_EQ(report.warnings.size(), 1u);
    EXPECT_NE(report.warnings[0].find("4 edges have one facet only"), std::string::npos);
    for (std::size_t e = 0; e < mesh.edges.size(); ++e)
        EXPECT_EQ(mesh.edge_facets[e][1] == no_index,
                  mesh.vertices[mesh.edges[e][0]].z == 1 && mesh.vertices[mesh.edges[e][1]].z == 1);
}

TEST(TakeInMesh, DropsCopiesWhicheverWayTheyRun)
{
    const TriangleSoup soup = sphere(2);
    TriangleSoup copies = soup;
    for (std::size_t i = 0; i < 30; ++i) copies.vertices.push_back(soup.vertices[i]);
    const TriangleSoup turned = inverted(copies);
    for (std::size_t i = 60; i < 75; ++i) copies.vertices.push_back(turned.vertices[i]);
    MeshReport report;
    const SurfaceMesh mesh = taken_in(copies, report);
    EXPECT_EQ(report.duplicate_facets, 15u);
    EXPECT_EQ(mesh.facets.size(), soup.size());
    EXPECT_TRUE(report.is_watertight);
}

TEST(TakeInMesh, SplitsTheFacetAtATJunction)
{
    TriangleSoup soup = box({0, 0, 0}, {1, 1, 1});
    soup.vertices.resize(soup.vertices.size() - 6); // the side x = 0, laid anew in four facets
    const Vec3 a{0, 1, 0}, b{0, 0, 0}, c{0, 0, 1}, d{0, 1, 1}, low{0, 0.25, 0}, mid{0, 0.5, 0};
    add_facet(soup, a, mid, d);
    add_facet(soup, mid, low, d);
    add_facet(soup, low, b, c);
    add_facet(soup, low, c, d);
    MeshReport report;
    taken_in(soup, report);
    EXPECT_EQ(report.t_junctions, 2u);
    EXPECT_EQ(report.open_edges, 0u);
    EXPECT_TRUE(report.is_watertight);
    EXPECT_DOUBLE_EQ(report.volume, 1);
}

TEST(TakeInMesh, ReplacesAFacetWithoutAreaByASplit)
{
    TriangleSoup soup = box({0, 0, 0}, {1, 1, 1});
    soup.vertices.resize(soup.vertices.size() - 6);
    const Vec3 a{0, 1, 0}, b{0, 0, 0}, c{0, 0, 1}, d{0, 1, 1}, mid{0, 0.5, 0};
    add_facet(soup, a, mid, d);
    add_facet(soup, mid, b, c);
    add_facet(soup, mid, c, d);
    add_facet(soup, a, b, mid); // a cap on the edge
    MeshReport report;
    taken_in(soup, report);
    EXPECT_EQ(report.degenerate_facets, 1u);
    EXPECT_TRUE(report.is_watertight);
}

TEST(TakeInMesh, DropsASliverThatStandsOnAnEdge)
{
    TriangleSoup soup = box({0, 0, 0}, {1, 1, 1});
    add_facet(soup, {0, 0, 0}, {1, 0, 0}, {0.4, 0, 1e-8});
    MeshReport report;
    taken_in(soup, report);
    EXPECT_EQ(report.degenerate_facets, 1u);
    EXPECT_TRUE(report.is_watertight);
}

TEST(TakeInMesh, CountsTheEdgeWhereTwoCubesTouch)
{
    MeshReport report;
    const SurfaceMesh mesh =
        taken_in(joined(box({0, 0, 0}, {1, 1, 1}), box({1, 1, 0}, {2, 2, 1})), report);
    EXPECT_EQ(report.non_manifold_edges, 1u);
    EXPECT_EQ(report.shells, 2u);
    EXPECT_TRUE(report.is_watertight);
    EXPECT_DOUBLE_EQ(report.volume, 2);
    EXPECT_EQ(std::count(mesh.is_manifold.begin(), mesh.is_manifold.end(), 0), 1);
}

TEST(TakeInMesh, OpensTheWallBetweenTwoCubesThatShareAFace)
{
    TriangleSoup soup = box({0, 0, 0}, {1, 1, 1});
    const TriangleSoup other = moved(box({0, 0, 0}, {1, 1, 1}),
                                     {{Vec3{-1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}}, {2, 0, 0}});
    MeshReport report;
    const SurfaceMesh mesh = taken_in(joined(soup, inverted(other)), report); // mirrored
    EXPECT_EQ(report.inner_wall_facets, 4u);
    EXPECT_EQ(report.duplicate_facets, 0u);
    EXPECT_EQ(report.shells, 1u);
    EXPECT_TRUE(report.is_watertight);
    EXPECT_EQ(mesh.facets.size(), 20u);
    EXPECT_DOUBLE_EQ(report.volume, 2);
    // Seen from inside, the same facets are a baffle in a channel: one sheet of it stays.
    taken_in(inverted(joined(soup, inverted(other))), report);
    EXPECT_EQ(report.inner_wall_facets, 0u);
    EXPECT_EQ(report.duplicate_facets, 2u);
}

TEST(TakeInMesh, KeepsOneSheetOfTwoThatFaceOppositeWays)
{
    TriangleSoup soup;
    add_quad(soup, {0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0});
    MeshReport report;
    const SurfaceMesh mesh = taken_in(joined(soup, inverted(soup)), report);
    EXPECT_EQ(mesh.facets.size(), 2u);
    EXPECT_EQ(report.open_edges, 4u);
}

/// Each corner of each facet is off by up to a distance along each axis.
TriangleSoup jittered(TriangleSoup soup, double by)
{
    std::mt19937 random(7);
    std::uniform_real_distribution<double> jitter(-by, by);
    for (Vec3& v : soup.vertices) v = v + Vec3{jitter(random), jitter(random), jitter(random)};
    return soup;
}

TEST(TakeInMesh, WeldsCracksWithinADistance)
{
    const TriangleSoup soup = jittered(sphere(3), 1e-5);
    MeshReport report;
    taken_in(soup, report, 1e-9);
    EXPECT_GE(report.open_edges, 3 * soup.size());
    for (const double distance : {1e-4, 0.0})
    {
        const SurfaceMesh mesh = taken_in(soup, report, distance);
        EXPECT_TRUE(report.is_watertight);
        EXPECT_EQ(mesh.vertices.size(), soup.size() / 2 + 2);
    }
    EXPECT_EQ(report.joined_corners, 3 * soup.size() - soup.size() / 2 - 2);
    EXPECT_NE(report.warnings.front().find("The facets do not meet"), std::string::npos);
}

TEST(TakeInMesh, LeavesSheetsWithGapsApart)
{
    // Two sheets 1e-5 of their width apart are as open joined as they are apart.
    TriangleSoup soup;
    add_quad(soup, {0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0});
    add_quad(soup, {1.00001, 0, 0}, {2, 0, 0}, {2, 1, 0}, {1.00001, 1, 0});
    MeshReport report;
    EXPECT_EQ(taken_in(soup, report).vertices.size(), 8u);
    EXPECT_EQ(report.joined_corners, 0u);
}

TEST(TakeInMesh, KeepsNarrowTanksOfAnyHeight)
{
    // Joined within 1e-4 of the height, the bottom has no width and the walls are one.
    for (const bool has_bottom : {false, true})
        for (const double height : {1e3, 1e4, 1e5, 1e6, 1e7, 4e7})
            for (const double dp : {0.0, 0.02})
            {
                TriangleSoup soup;
                add_quad(soup, {0, 0, 0}, {0, 2, 0}, {0, 2, height}, {0, 0, height});
                add_quad(soup, {1, 0, 0}, {1, 2, 0}, {1, 2, height}, {1, 0, height});
                if (has_bottom) add_quad(soup, {0, 0, 0}, {1, 0, 0}, {1, 2, 0}, {0, 2, 0});
                MeshReport report;
                const SurfaceMesh mesh =
                    repair_mesh(soup, {.dp = dp, .is_solid = false}, 1, report);
                // Without dp, what float32 may have rounded away of the height can be left out.
                if (mesh.facets.size() != soup.size())
                {
                    EXPECT_TRUE(dp == 0 && height > 1e6) << height << " " << dp;
                    EXPECT_NE(report.warnings.front().find("but for rounding"), std::string::npos);
                }
                EXPECT_EQ(report.joined_corners, 0u) << height << " " << dp;
                EXPECT_EQ(report.t_junctions, 0u) << height << " " << dp;
            }
}

TEST(TakeInMesh, ClosesCracksOfRoundedNumbersAtTheParticleDistance)
{
    // A ball of 2 m across whose corners are off by 3e-5, nearly what four digits round away.
    const TriangleSoup soup = jittered(sphere(3), 3e-5);
    MeshReport report;
    for (const double dp : {0.01, 0.1})
    {
        const SurfaceMesh mesh = repair_mesh(soup, {.dp = dp, .is_solid = true}, 1, report);
        EXPECT_TRUE(report.is_watertight) << dp;
        EXPECT_EQ(mesh.facets.size(), soup.size()) << dp;
        EXPECT_NEAR(report.joined_within, 2e-4, 1e-7) << dp;
    }
}

TEST(TakeInMesh, CountsFacetsThatCross)
{
    MeshReport report;
    const TriangleSoup cube = box({0, 0, 0}, {2, 2, 2});
    taken_in(joined(cube, box({3, 0, 0}, {4, 1, 1})), report);
    EXPECT_EQ(report.self_intersections, 0u);
    taken_in(joined(cube, moved(cube, {.offset = {1.1, 1.2, 1.3}})), report);
    EXPECT_GT(report.self_intersections, 5u);
    // A fin that stands on the cube touches it only.
    TriangleSoup fin = cube;
    add_quad(fin, {2, 0.5, 1}, {3, 0.5, 1}, {3, 1.5, 1}, {2, 1.5, 1});
    MeshReport fin_report;
    taken_in(fin, fin_report);
    EXPECT_EQ(fin_report.self_intersections, 0u);
    EXPECT_TRUE(report.is_watertight);
}

TEST(TakeInMesh, NamesThePlaceWhereAPartCrossesItself)
{
    constexpr double dp = 0.1;
    // A strip that goes on upwards, back above itself and down through its beginning.
    const auto folded = [](double end)
    {
        const std::vector<std::pair<double, double>> profile = {
            {0, 0}, {3, 0}, {3, 1}, {1.2, 1}, {1.2, end}};
        TriangleSoup strip;
        for (std::size_t i = 1; i < profile.size(); ++i)
        {
            const auto& [x, z] = profile[i - 1];
            const auto& [next_x, next_z] = profile[i];
            add_quad(strip, {x, 0, z}, {next_x, 0, next_z}, {next_x, 1, next_z}, {x, 1, z});
        }
        MeshReport report;
        repair_mesh(strip, {.dp = dp, .warns_of_folds = true}, 2, report);
        return report;
    };
    const MeshReport deep = folded(-1);
    EXPECT_GT(deep.folds, 0u);
    EXPECT_TRUE(std::any_of(deep.warnings.begin(), deep.warnings.end(),
                            [](const std::string& w)
                            { return w.starts_with("A part crosses itself: "); }));
    EXPECT_EQ(folded(0.5).folds, 0u);
    // What rounding of coordinates can do is no fold.
    EXPECT_EQ(folded(-1e-4 * dp).folds, 0u);
}

TEST(TakeInMesh, SaysThatAMoebiusStripHasOneSide)
{
    TriangleSoup soup;
    const auto point = [](int i, double w)
    {
        const double turn = 2 * 3.14159265358979323846 * i / 12;
        const double r = 2 + w * std::cos(turn / 2);
        return Vec3{r * std::cos(turn), r * std::sin(turn), w * std::sin(turn / 2)};
    };
    for (int i = 0; i < 12; ++i)
    {
        // The last piece joins the first one upside down.
        const Vec3 c = i < 11 ? point(i + 1, 0.5) : point(0, -0.5);
        const Vec3 d = i < 11 ? point(i + 1, -0.5) : point(0, 0.5);
        add_quad(soup, point(i, -0.5), d, c, point(i, 0.5));
    }
    MeshReport report;
    taken_in(soup, report);
    EXPECT_EQ(report.clashing_edges, 1u);
    EXPECT_FALSE(report.is_watertight);
}

TEST(TakeInMesh, RefusesAMeshWithoutAnyArea)
{
    TriangleSoup soup;
    add_facet(soup, {0, 0, 0}, {1, 0, 0}, {2, 0, 0});
    MeshReport report;
    EXPECT_THROW(taken_in(soup, report), GeometryError);
    EXPECT_THROW(taken_in({}, report), GeometryError);
    add_facet(soup, {0, 0, 0}, {1, 0, 0}, {0, std::nan(""), 0});
    EXPECT_THROW(taken_in(soup, report), GeometryError);
}

TEST(TakeInMesh, GivesTheSameForOneAndEightThreads)
{
    MeshReport one_report, eight_report;
    TriangleSoup soup = joined(sphere(6), moved(inverted(sphere(6)), {.offset = {3, 0, 0}}));
    const SurfaceMesh one = taken_in(soup, one_report, 0, 1);
    const SurfaceMesh eight = taken_in(soup, eight_report, 0, 8);
    EXPECT_EQ(one.vertices, eight.vertices);
    EXPECT_EQ(one.facets, eight.facets);
    EXPECT_EQ(one.neighbours, eight.neighbours);
    EXPECT_EQ(one.facet_edges, eight.facet_edges);
    EXPECT_EQ(one.edges, eight.edges);
    EXPECT_EQ(one.normals, eight.normals);
    EXPECT_EQ(one_report.warnings, eight_report.warnings);
    EXPECT_EQ(one_report.volume, eight_report.volume);
}

TEST(TakeInMesh, LeavesFacetsThatHaveParticlesTheirOwnPlane)
{
    // Half a metre high, with a corner 1,200 km away: for a facet of that place a rounding is 0.07
    // m.
    const Vec3 far{1, 1186837.6, 0};
    TriangleSoup soup;
    add_facet(soup, {0.03, 0.5, 0.6}, far, {-0.2, 1.33, 0.1});
    add_facet(soup, {0.03, 0.5, 0.6}, {1.1, 1, 27.6}, far);
    const auto off_plane = [&](double dp)
    {
        MeshReport report;
        const SurfaceMesh mesh = repair_mesh(soup, {.dp = dp}, 1, report);
        const auto& facet = mesh.facets[0];
        double most = 0;
        for (std::size_t s = 0; s < 3; ++s)
        {
            const Vec3 side = mesh.vertices[facet[(s + 1) % 3]] - mesh.vertices[facet[s]];
            most = std::max(most, std::abs(dot(mesh.normals[0], side)) / norm(side));
        }
        return most;
    };
    EXPECT_LT(off_plane(0.1), 1e-9);
    // Without steps it is a sliver of its neighbour.
    EXPECT_GT(off_plane(0), 0.1);
}

} // namespace fppg
