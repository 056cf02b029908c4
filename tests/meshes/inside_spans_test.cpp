#include <cstdlib>

#include "meshes/mesh_query.h"
#include "meshes/spans_helpers.h"
#include "meshes/test_shapes.h"

namespace fppg
{

namespace
{

using test::box;
using test::count_nodes;
using test::cube_grid;
using test::expect_nodes;
using test::inverted;
using test::joined;
using test::moved;
using test::octahedron;
using test::sphere;

/// Off every plane, edge and vertex of the shapes below.
const LatticeGrid generic_grid = cube_grid({-1.4142, -1.3173, -1.2718}, 0.0931, 32);
const LatticeGrid integer_grid = cube_grid({-5, -5, -5}, 1, 11);
const LatticeGrid quarter_grid = cube_grid({-2, -2, -2}, 0.25, 17);

void expect_as_winding_number(const TriangleSoup& soup, const LatticeGrid& grid)
{
    expect_nodes(soup, grid, [&](const Vec3& p) { return test::winding_number(soup, p) > 0.5; });
}

/// Says no more than whether the two differ, because the list of spans is long.
bool are_alike(const SpanSet& a, const SpanSet& b)
{
    return a.x_begin == b.x_begin && a.slabs == b.slabs;
}

bool give_the_same(const TriangleSoup& a, const TriangleSoup& b)
{
    return are_alike(inside_spans(a, generic_grid, 1), inside_spans(b, generic_grid, 1));
}

} // namespace

TEST(InsideSpans, FindsTheNodesOfABox)
{
    expect_nodes(
        box({-0.5, -0.7, -0.9}, {1, 0.8, 0.6}), generic_grid,
        [](const Vec3& p)
        { return p.x > -0.5 && p.x < 1 && p.y > -0.7 && p.y < 0.8 && p.z > -0.9 && p.z < 0.6; });
}

TEST(InsideSpans, AgreesWithTheWindingNumberOfASphere)
{
    expect_as_winding_number(sphere(3), generic_grid);
    LatticeGrid stretched = generic_grid;
    stretched.stretch = {1.04, 0.97, 1.01};
    expect_as_winding_number(sphere(3), stretched);
}

TEST(InsideSpans, AgreesWithRaysThroughASphere)
{
    const MeshQuery query(sphere(4));
    const LatticeGrid grid = cube_grid({-1, -1, -1}, 0.0625, 33);
    const std::vector<bool> nodes = test::nodes_of(inside_spans(query.soup(), grid, 1), grid);
    for (std::uint32_t i = 1; i < 32; ++i)
        for (std::uint32_t j = 1; j < 32; ++j)
        {
            const Vec3 foot = test::node(grid, i, j, 0) - Vec3{0, 0, 1};
            const auto crossings = query.crossings(foot, 2);
            for (std::uint32_t k = 0; k < 33; ++k)
            {
                const double z = test::node(grid, i, j, k).z;
                int sum = 0;
                for (const Crossing& crossing : crossings)
                    if (crossing.step > 0 ? crossing.position <= z : crossing.position < z)
                        sum += crossing.step;
                EXPECT_EQ(nodes[(i * 33 + j) * 33 + k], sum > 0) << i << " " << j << " " << k;
            }
        }
}

TEST(InsideSpans, JoinsOverlappingParts)
{
    const TriangleSoup a = box({-0.9, -0.8, -0.7}, {0.3, 0.4, 0.5});
    const TriangleSoup b = box({-0.2, -0.3, -0.4}, {0.8, 0.9, 1});
    expect_as_winding_number(joined(a, b), generic_grid);
    const Transform shift{{Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}}, {0.3, 0.2, 0.1}};
    expect_as_winding_number(joined(sphere(2), moved(sphere(2), shift)), generic_grid);
}

TEST(InsideSpans, TakesAnInvertedMeshAsItsMirrorImage)
{
    EXPECT_TRUE(give_the_same(sphere(3), inverted(sphere(3))));
}

TEST(InsideSpans, LeavesACavityEmpty)
{
    const TriangleSoup soup = joined(sphere(3), inverted(box({-0.4, -0.4, -0.4}, {0.4, 0.4, 0.4})));
    expect_as_winding_number(soup, generic_grid);
}

TEST(InsideSpans, TakesANestedShellOfTheSameOrientationForSolid)
{
    const TriangleSoup inner = box({-0.4, -0.4, -0.4}, {0.4, 0.4, 0.4});
    EXPECT_TRUE(give_the_same(joined(sphere(3), inner), sphere(3)));
}

TEST(InsideSpans, KeepsAllSidesOfABoxOnLatticeLines)
{
    EXPECT_EQ(count_nodes(inside_spans(box({-2, -1, 0}, {1, 3, 5}), integer_grid, 1)), 4u * 5 * 6);
}

TEST(InsideSpans, KeepsTheNodesOnTheWallOfACavity)
{
    const TriangleSoup soup =
        joined(box({-2, -2, -2}, {2, 2, 2}), inverted(box({-1, -1, -1}, {1, 1, 1})));
    expect_nodes(soup, integer_grid,
                 [](const Vec3& p)
                 {
                     const double largest = std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)});
                     return largest <= 2 && largest >= 1;
                 });
}

TEST(InsideSpans, JoinsBoxesThatTouchInAFace)
{
    expect_nodes(joined(box({-2, -2, -2}, {2, 2, 0}), box({-2, -2, 0}, {2, 2, 3})), integer_grid,
                 [](const Vec3& p)
                 { return std::abs(p.x) <= 2 && std::abs(p.y) <= 2 && p.z >= -2 && p.z <= 3; });
}

TEST(InsideSpans, KeepsTheNodesOnTheFacetsOfAnOctahedron)
{
    for (const LatticeGrid& grid : {integer_grid, quarter_grid})
        for (const double radius : {1.0, 1.75, 2.0})
            expect_nodes(octahedron(radius), grid,
                         [radius](const Vec3& p)
                         { return std::abs(p.x) + std::abs(p.y) + std::abs(p.z) <= radius; });
}

TEST(InsideSpans, KeepsTheNodesOnTheWallsOfAPrismTurnedBy45Degrees)
{
    const double z = 1.5;
    const TriangleSoup soup =
        test::hexahedron({Vec3{-1, 0, -z}, Vec3{0, -1, -z}, Vec3{1, 0, -z}, Vec3{0, 1, -z},
                          Vec3{-1, 0, z}, Vec3{0, -1, z}, Vec3{1, 0, z}, Vec3{0, 1, z}});
    expect_nodes(soup, quarter_grid,
                 [z](const Vec3& p)
                 { return std::abs(p.x) + std::abs(p.y) <= 1 && std::abs(p.z) <= z; });
}

TEST(InsideSpans, KeepsTheNodesOnACubeTurnedByTheAngleOf345)
{
    // The rows of the turn are (3, -4) / 5 and (4, 3) / 5; the cube has an edge of 2.5, so that its
    // corners and those nodes that lie on its walls are exact.
    const auto corner = [](double u, double v, double w) {
        return Vec3{0.75 * u - v, u + 0.75 * v, w};
    };
    const TriangleSoup soup = test::hexahedron(
        {corner(-1, -1, -1), corner(1, -1, -1), corner(1, 1, -1), corner(-1, 1, -1),
         corner(-1, -1, 1), corner(1, -1, 1), corner(1, 1, 1), corner(-1, 1, 1)});
    expect_nodes(soup, quarter_grid,
                 [](const Vec3& p)
                 {
                     return std::abs(0.75 * p.x + p.y) <= 1.5625 &&
                            std::abs(0.75 * p.y - p.x) <= 1.5625 && std::abs(p.z) <= 1;
                 });
}

TEST(InsideSpans, DoesNotDependOnTheNumberOfThreads)
{
    const SpanSet one = inside_spans(sphere(4), generic_grid, 1);
    const SpanSet eight = inside_spans(sphere(4), generic_grid, 8);
    EXPECT_FALSE(one.slabs.empty());
    EXPECT_TRUE(are_alike(one, eight));
}

TEST(InsideSpans, IsCutOffAtTheEndsOfTheLattice)
{
    const LatticeGrid grid = cube_grid({0, 0, 0}, 1, 3);
    EXPECT_EQ(count_nodes(inside_spans(box({-9, -9, -9}, {9, 9, 9}), grid, 1)), 27u);
    EXPECT_EQ(count_nodes(inside_spans(box({1, 1, -9}, {9, 9, 1}), grid, 1)), 8u);
    EXPECT_TRUE(inside_spans(box({5, 5, 5}, {9, 9, 9}), grid, 1).slabs.empty());
    EXPECT_EQ(count_nodes(inside_spans(box({0, 0, 5}, {2, 2, 9}), grid, 1)), 0u);
}

TEST(InsideSpans, DoesNotFloodThroughAMissingLid)
{
    TriangleSoup soup = box({-0.5, -0.5, -0.5}, {0.5, 0.5, 0.5});
    soup.vertices.erase(soup.vertices.begin() + 6, soup.vertices.begin() + 12);
    EXPECT_EQ(count_nodes(inside_spans(soup, generic_grid, 1)), 0u);
}

TEST(InsideSpans, IgnoresFacetsWithoutAreaAndFarStrays)
{
    TriangleSoup soup = sphere(2);
    test::add_facet(soup, soup.vertices[0], soup.vertices[0], soup.vertices[1]);
    test::add_facet(soup, {0, 0, 0}, {0.5, 0.5, 0.5}, {0.25, 0.25, 0.25});
    test::add_facet(soup, {1e30, 0, 0}, {0, 1e30, 0}, {0, 0, 1e30});
    EXPECT_TRUE(give_the_same(soup, sphere(2)));
}

TEST(InsideSpans, FindsTheVolumesOfRealMeshes)
{
    const char* const shared = std::getenv("FPPG_SHARED");
    if (shared == nullptr) GTEST_SKIP() << "FPPG_SHARED is not set; it names the folder of models";
    for (const auto& [name, dp, volume] : {std::tuple{"generated/sphere_ico4", 0.02, 4.18},
                                           {"generated/gear1", 0.5, 2.533e5},
                                           {"real/fandisk", 0.02, 20.24},
                                           {"real/bunny_fppg", 0.5, 2.519e5}})
    {
        const TriangleSoup soup =
            read_stl(std::string(shared) + "/models/" + name + ".stl", 2).soup;
        Box3 bounds;
        for (const Vec3& vertex : soup.vertices) bounds.add(vertex);
        LatticeGrid grid;
        grid.dp = dp;
        grid.origin = bounds.min - Vec3{0.37 * dp, 0.41 * dp, 0.43 * dp};
        for (int axis = 0; axis < 3; ++axis)
            grid.n[static_cast<std::size_t>(axis)] =
                static_cast<std::uint32_t>((bounds.max[axis] - bounds.min[axis]) / dp) + 3;
        const auto count = static_cast<double>(count_nodes(inside_spans(soup, grid, 2)));
        EXPECT_NEAR(count * dp * dp * dp / volume, 1, 2e-3) << name;
    }
}

} // namespace fppg
