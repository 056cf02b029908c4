#include "boolean/boolean_parts.h"

#include "fppg/error.h"

#include <gtest/gtest.h>

#include <functional>

namespace fppg
{
namespace
{

using namespace test;

/// Faults of the four results of a random pair, as text; empty without any.
std::string faults_of_pair(unsigned seed, Placing placing, double tolerance,
                           const std::function<TriangleSoup(TriangleSoup)>& blur = {})
{
    std::mt19937 random(seed);
    PartList list;
    for (int i = 0; i < 2; ++i)
    {
        const TriangleSoup soup = any_part(random, placing);
        list.add(blur ? blur(soup) : soup);
    }
    const BooleanMesh join = list.run(of_two(BooleanOp::Union));
    const BooleanMesh common = list.run(of_two(BooleanOp::Intersection));
    const BooleanMesh rest = list.run(of_two(BooleanOp::Difference));
    std::string out;
    const auto check = [&](const char* name, const BooleanMesh& m, bool may_be_empty)
    {
        if (m.mesh.facets.empty() && may_be_empty) return;
        if (!m.report.is_watertight)
            out +=
                std::string(name) + " is open: " + std::to_string(m.report.open_edges) + " edges; ";
    };
    check("union", join, false);
    check("intersection", common, true);
    check("difference", rest, true);
    const double a = list.volume(0), b = list.volume(1);
    const double both = common.report.volume;
    if (std::abs(join.report.volume + both - a - b) > tolerance * (a + b))
        out += "union " + std::to_string(join.report.volume) + " + " + std::to_string(both) +
               " is not " + std::to_string(a) + " + " + std::to_string(b) + "; ";
    if (std::abs(rest.report.volume + both - a) > tolerance * (a + b))
        out += "difference " + std::to_string(rest.report.volume) + " + " + std::to_string(both) +
               " is not " + std::to_string(a) + "; ";
    return out;
}

TEST(BooleanMesh, VolumesOfRandomPairsAddUp)
{
    for (unsigned seed = 1; seed <= 200; ++seed)
        EXPECT_EQ(faults_of_pair(seed, Placing::Random, 1e-9), "") << "seed " << seed;
}

TEST(BooleanMesh, VolumesAddUpWhereFacesAndEdgesCoincide)
{
    for (unsigned seed = 1; seed <= 200; ++seed)
        EXPECT_EQ(faults_of_pair(seed, Placing::Aligned, 1e-6), "") << "seed " << seed;
}

TEST(BooleanMesh, VolumesAddUpWhereFacesCoincideButForTheRoundingOfAFile)
{
    const auto blur = [](TriangleSoup soup)
    {
        soup = moved(soup, placed({31, 47, 11}, 1, {0.3, 0.2, 0.1}));
        for (Vec3& v : soup.vertices)
            for (int axis = 0; axis < 3; ++axis) v[axis] = static_cast<float>(v[axis]);
        return soup;
    };
    for (unsigned seed = 1; seed <= 200; ++seed)
        EXPECT_EQ(faults_of_pair(seed, Placing::Aligned, 3e-6, blur), "") << "seed " << seed;
}

/// A random combination of the parts from `first` on, each once.
BooleanNode any_tree(std::mt19937& random, std::uint32_t first, std::uint32_t count)
{
    if (count == 1) return leaf(first);
    const auto split = std::uniform_int_distribution<std::uint32_t>(1, count - 1)(random);
    const auto op = static_cast<BooleanOp>(std::uniform_int_distribution<int>(1, 3)(random));
    return combined(
        op, {any_tree(random, first, split), any_tree(random, first + split, count - split)});
}

TEST(BooleanMesh, HoldsThePointsThatTheCombinationHolds)
{
    for (unsigned seed = 1; seed <= 60; ++seed)
        for (const Placing placing : {Placing::Random, Placing::Aligned})
        {
            std::mt19937 random(seed);
            PartList list;
            const std::uint32_t n = 3 + seed % 2;
            for (std::uint32_t i = 0; i < n; ++i) list.add(any_part(random, placing));
            const BooleanNode tree = any_tree(random, 0, n);
            const BooleanMesh result = list.run(tree);
            const TriangleSoup surface =
                result.mesh.facets.empty() ? TriangleSoup{} : soup_of(result.mesh);
            EXPECT_TRUE(result.mesh.facets.empty() || result.report.is_watertight)
                << "seed " << seed;
            std::uniform_real_distribution<double> any(-1.5, 1.5);
            for (int k = 0; k < 40; ++k)
            {
                const Vec3 p{any(random), any(random), any(random)};
                std::vector<char> is_in;
                for (const SurfaceMesh& m : list.meshes)
                    is_in.push_back(winding_number(soup_of(m), p) > 0.5);
                EXPECT_EQ(winding_number(surface, p) > 0.5, evaluate(tree, is_in))
                    << "seed " << seed << " at " << p.x << " " << p.y << " " << p.z;
            }
        }
}

TEST(BooleanMesh, TwoBoxesSideBySideBecomeOne)
{
    PartList list;
    list.add(box({0, 0, 0}, {1, 1, 1}));
    list.add(box({1, 0, 0}, {2, 1, 1}));
    const BooleanMesh join = list.run(of_two(BooleanOp::Union));
    EXPECT_TRUE(join.report.is_watertight);
    EXPECT_DOUBLE_EQ(join.report.volume, 2);
    EXPECT_DOUBLE_EQ(join.report.area, 10);
    EXPECT_TRUE(join.seams.empty()); // flat
    EXPECT_TRUE(list.run(of_two(BooleanOp::Intersection)).mesh.facets.empty());
    EXPECT_DOUBLE_EQ(list.run(of_two(BooleanOp::Difference)).report.area, 6);
}

TEST(BooleanMesh, ASharedFaceBelongsToTheFirstPart)
{
    PartList list;
    list.add(box({0, 0, 0}, {2, 2, 1}));
    list.add(box({1, 1, 0}, {3, 3, 1}));
    const BooleanMesh join = list.run(of_two(BooleanOp::Union));
    EXPECT_DOUBLE_EQ(join.report.volume, 7);
    EXPECT_DOUBLE_EQ(join.report.area, 2 * 7 + 12);
    double of_first = 0;
    for (std::size_t f = 0; f < join.parts.size(); ++f)
        if (join.parts[f] == 0 && join.mesh.normals[f].z > 0.5) of_first += join.mesh.areas[f];
    EXPECT_DOUBLE_EQ(of_first, 4);
}

TEST(BooleanMesh, ADrilledBoxHasSeamsAroundItsHole)
{
    PartList list;
    list.add(box({-1, -1, -1}, {1, 1, 1}));
    TriangleSoup drill = tube(24);
    for (Vec3& v : drill.vertices) v = {0.5 * v.x, 0.5 * v.y, 2 * v.z};
    list.add(drill);
    const BooleanMesh rest = list.run(of_two(BooleanOp::Difference));
    EXPECT_TRUE(rest.report.is_watertight);
    double length = 0;
    for (const std::uint32_t e : rest.seams)
        length += norm(rest.mesh.vertices[rest.mesh.edges[e][1]] -
                       rest.mesh.vertices[rest.mesh.edges[e][0]]);
    EXPECT_NEAR(length, 2 * 24 * std::sin(std::numbers::pi / 24), 1e-9);
    // What is left of the drill looks into the hole.
    for (std::size_t f = 0; f < rest.parts.size(); ++f)
        if (rest.parts[f] == 1)
        {
            const Vec3 middle = rest.mesh.vertices[rest.mesh.facets[f][0]];
            EXPECT_LT(dot(rest.mesh.normals[f], {middle.x, middle.y, 0}), 0);
        }
}

TEST(BooleanMesh, APartWithAHoleHasAnInside)
{
    PartList list;
    TriangleSoup ball = sphere(3);
    const double whole = [&]
    {
        MeshReport report;
        repair_mesh(ball, {}, 1, report);
        return report.area;
    }();
    ball.vertices.resize(ball.vertices.size() - 3);
    list.add(ball);
    list.add(box({-2, -2, 0}, {2, 2, 2}));
    const BooleanMesh cut = list.run(of_two(BooleanOp::Intersection));
    EXPECT_NEAR(cut.report.area, 0.5 * whole + std::numbers::pi, 0.1);
    const BooleanMesh rest = list.run(of_two(BooleanOp::Difference));
    EXPECT_NEAR(rest.report.area, 0.5 * whole + std::numbers::pi, 0.1);
    EXPECT_EQ(cut.report.open_edges + rest.report.open_edges, 3U);
}

TEST(BooleanMesh, NamesAPartWithoutAnInside)
{
    PartList list;
    list.add(box({0, 0, 0}, {1, 1, 1}));
    TriangleSoup sheet;
    add_quad(sheet, {-1, -1, 0.5}, {2, -1, 0.5}, {2, 2, 0.5}, {-1, 2, 0.5});
    list.add(sheet, "baffle");
    try
    {
        list.run(of_two(BooleanOp::Union));
        FAIL() << "no error";
    }
    catch (const GeometryError& e)
    {
        EXPECT_NE(std::string(e.what()).find("'baffle'"), std::string::npos) << e.what();
    }
}

TEST(BooleanMesh, ASheetStaysOutsideInAUnionAndInsideInAnIntersection)
{
    PartList list;
    list.add(box({0, 0, 0}, {1, 1, 1}));
    TriangleSoup sheet;
    add_quad(sheet, {-1, -1, 0.5}, {2, -1, 0.5}, {2, 2, 0.5}, {-1, 2, 0.5});
    list.add(sheet);
    list.parts[1].may_be_sheet = true;
    EXPECT_NEAR(list.run(of_two(BooleanOp::Union)).report.area, 6 + 9 - 1, 1e-9);
    EXPECT_NEAR(list.run(of_two(BooleanOp::Intersection)).report.area, 1, 1e-9);
    EXPECT_NEAR(list.run(of_two(BooleanOp::Difference)).report.area, 6, 1e-9);
}

TEST(BooleanMesh, IsTheSameForAnyNumberOfThreads)
{
    std::mt19937 random(7);
    PartList list;
    for (int i = 0; i < 4; ++i) list.add(any_part(random, Placing::Random));
    const BooleanNode tree = any_tree(random, 0, 4);
    const BooleanMesh one = list.run(tree, 1);
    const BooleanMesh many = list.run(tree, 5);
    EXPECT_EQ(one.mesh.vertices, many.mesh.vertices);
    EXPECT_EQ(one.mesh.facets, many.mesh.facets);
    EXPECT_EQ(one.parts, many.parts);
    EXPECT_EQ(one.seams, many.seams);
}

} // namespace
} // namespace fppg
