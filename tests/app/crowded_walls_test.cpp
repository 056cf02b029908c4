// Walls whose edges and corners are closer than dp: how far their particles are from one another
// and what the log says of it; FPPG_PROGRAM is the program's path.

#include "fppg/read_particles.h"

#include "fit/fit_shapes.h"
#include "fppg/surface_mesh.h"
#include "helpers/case_text.h"
#include "helpers/run_fppg.h"
#include "helpers/surface_cover.h"
#include "meshes/point_grid.h"
#include "meshes/test_shapes.h"

#include <gtest/gtest.h>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace
{

using namespace fppg;
using namespace fppg::test;

std::string stl_of(const TriangleSoup& soup)
{
    std::string text = "solid shape\n";
    for (std::size_t f = 0; f < soup.size(); ++f)
    {
        text += "facet normal 0 0 0\nouter loop\n";
        for (std::size_t k = 0; k < 3; ++k)
        {
            const Vec3& v = soup.vertices[3 * f + k];
            text += fmt::format("vertex {} {} {}\n", v.x, v.y, v.z);
        }
        text += "endloop\nendfacet\n";
    }
    return text + "endsolid shape\n";
}

/// A star of nine points, of radius 1 outside and 0.45 between them, and 0.6 high.
TriangleSoup star()
{
    constexpr int n = 18;
    TriangleSoup soup;
    const auto at = [&](int i, double z)
    {
        const double radius = i % 2 == 0 ? 1 : 0.45;
        const double angle = std::numbers::pi * (i % n) / 9;
        return Vec3{radius * std::cos(angle), radius * std::sin(angle), z};
    };
    for (int i = 0; i < n; ++i)
    {
        add_quad(soup, at(i, 0), at(i + 1, 0), at(i + 1, 0.6), at(i, 0.6));
        add_facet(soup, {0, 0, 0}, at(i + 1, 0), at(i, 0));
        add_facet(soup, {0, 0, 0.6}, at(i, 0.6), at(i + 1, 0.6));
    }
    return soup;
}

/// Slender pyramids side by side.
TriangleSoup needles()
{
    TriangleSoup soup;
    for (int k = 0; k < 6; ++k)
    {
        const auto at = [&](double x, double y, double z) {
            return Vec3{0.3 * k + 0.1 * x - 0.7, 0.1 * y, 2 * z};
        };
        const std::array<Vec3, 4> base{at(-1, -1, 0), at(1, -1, 0), at(1, 1, 0), at(-1, 1, 0)};
        for (std::size_t i = 0; i < 4; ++i)
            add_facet(soup, base[i], base[(i + 1) % 4], at(0, 0, 1));
        add_quad(soup, base[3], base[2], base[1], base[0]);
    }
    return soup;
}

struct Shape
{
    const char* name;
    TriangleSoup soup;
    double dp;
    double farthest; ///< dp, of a place on the surface from a particle on it
};

std::vector<Shape> shapes()
{
    return {{"gear, 6 dp across", gear(36, 0.9, 1, 0.8), 1.0 / 3, 1},
            {"gear, 10 dp across", gear(36, 0.9, 1, 0.8), 0.2, 1},
            {"gear, 20 dp across", gear(36, 0.9, 1, 0.8), 0.1, 1},
            {"star, 10 dp across", star(), 0.2, 1.2},
            {"star, 20 dp across", star(), 0.1, 1.2},
            {"needles", needles(), 0.1, 1},
            {"wedge", wedge(), 0.06, 1.1},
            {"plate of 0.55 dp", box({-1, -0.7, 0}, {1, 0.7, 0.055}), 0.1, 1}};
}

struct Made
{
    RunResult result;
    ParticleCloud cloud;
};

Made make(const Shape& shape, const std::string& boundary, const Arguments& more)
{
    const TemporaryFolder folder;
    write_text(folder / "shape.stl", stl_of(shape.soup));
    CaseText text;
    text.dp = fmt::format("{}", shape.dp);
    text.pointmin = R"(<pointmin x="-4.03" y="-4.01" z="-4.02" />)";
    text.pointmax = R"(<pointmax x="4" y="4" z="4" />)";
    text.mainlist = R"(<setdrawmode mode="full" /><setmkbound mk="0" />
<drawfilestl file="shape.stl" fppg:fill="inside" />)";
    text.after_geometry = "<fppg><bodyfitted boundary=\"" + boundary + "\" /></fppg>";
    write_text(folder / "Case_Def.xml", text.text());
    Arguments words{"Case_Def", "Case", "-save:all"};
    words.insert(words.end(), more.begin(), more.end());
    Made out{run(folder, words), {}};
    EXPECT_EQ(out.result.code, 0) << out.result.output;
    if (out.result.code == 0) out.cloud = read_particles(folder / "Case", true, 1);
    return out;
}

double nearest_pair_dp(const std::vector<Vec3>& points, double dp)
{
    PointGrid grid(dp, points.size());
    double least = 2 * dp;
    for (const Vec3& p : points)
    {
        grid.for_each_near(p, dp,
                           [&](std::uint32_t, double squared)
                           { least = std::min(least, std::sqrt(squared)); });
        grid.add(p);
    }
    return least / dp;
}

TEST(CrowdedWalls, HaveNoTwoParticlesNearerThanTheLeastDistance)
{
    for (const Shape& shape : shapes())
        for (const char* mode : {"-fit", "-fit:raw"})
        {
            const Made made = make(shape, "dbc", {mode});
            ASSERT_GT(made.cloud.positions.size(), 20u) << shape.name;
            std::vector<Vec3> wall;
            for (std::size_t i = 0; i < made.cloud.positions.size(); ++i)
                if (made.cloud.kind[i] < 3) wall.push_back(made.cloud.positions[i]);
            EXPECT_GE(nearest_pair_dp(wall, shape.dp), 0.599) << shape.name << " " << mode;
            MeshReport report;
            const SurfaceMesh mesh =
                repair_mesh(shape.soup, {.dp = shape.dp, .is_solid = true}, 1, report);
            EXPECT_LE(farthest_point_dp(mesh, wall, shape.dp, 100), shape.farthest)
                << shape.name << " " << mode;
        }
}

TEST(CrowdedWalls, AndTheNodesBetweenLayersDoNotEither)
{
    for (const Shape& shape : shapes())
    {
        if (shape.name == std::string("gear, 20 dp across")) continue; // 5 s
        const Made made = make(shape, "mdbc", {});
        ASSERT_GT(made.cloud.positions.size(), 20u) << shape.name;
        EXPECT_GE(nearest_pair_dp(made.cloud.positions, shape.dp), 0.599) << shape.name;
    }
}

/// Two boxes that stand apart by less than the least distance, and one that touches the first.
TEST(CrowdedWalls, OfSeveralBodiesAreApartAsThoseOfOne)
{
    for (const char* boundary : {"dbc", "mdbc"})
        for (const char* mode : {"-fit", "-fit:raw"})
        {
            const TemporaryFolder folder;
            CaseText text;
            text.dp = "0.1";
            text.pointmin = R"(<pointmin x="-4.03" y="-4.01" z="-4.02" />)";
            text.pointmax = R"(<pointmax x="4" y="4" z="4" />)";
            text.mainlist = R"(<setdrawmode mode="full" /><setmkbound mk="0" />)" +
                            box_command(R"(x="0" y="0" z="0")", R"(x="1" y="1.1" z="0.9")") +
                            R"(<setmkbound mk="1" />)" +
                            box_command(R"(x="1.055" y="0.03" z="0.02")", R"(x="1" y="1" z="1")") +
                            R"(<setmkbound mk="2" />)" +
                            box_command(R"(x="0.21" y="0.13" z="0.9")", R"(x="0.6" y="0.6" z="1")");
            text.after_geometry =
                std::string("<fppg><bodyfitted boundary=\"") + boundary + "\" /></fppg>";
            write_text(folder / "Case_Def.xml", text.text());
            const RunResult result = run(folder, {"Case_Def", "Case", "-save:all", mode});
            ASSERT_EQ(result.code, 0) << result.output;
            const ParticleCloud cloud = read_particles(folder / "Case", true, 1);
            std::vector<Vec3> wall;
            for (std::size_t i = 0; i < cloud.positions.size(); ++i)
                if (cloud.kind[i] < 3) wall.push_back(cloud.positions[i]);
            EXPECT_GT(wall.size(), 1000u);
            EXPECT_GE(nearest_pair_dp(wall, 0.1), 0.599) << boundary << " " << mode;
        }
}

TEST(CrowdedWalls, SayHowManyAreLeftOut)
{
    const std::string head = "Left out, as others are nearer than 0.6 dp:";
    const std::string coarse = make(shapes()[0], "dbc", {}).result.output;
    EXPECT_TRUE(contains(coarse, head)) << coarse;
    EXPECT_TRUE(contains(coarse, "  drawfilestl shape.stl (xml row:")) << coarse;
    EXPECT_TRUE(contains(coarse, " of smooth places, nearest pair 0.6")) << coarse;
    const std::string json = make(shapes()[0], "dbc", {"-log-json"}).result.output;
    EXPECT_TRUE(contains(json, "\"left_out\"")) << json;
    EXPECT_TRUE(contains(json, "\"smooth_variation\"")) << json;
    const Shape fine{"gear, 60 dp across", gear(12, 0.7, 1, 0.8), 1.0 / 30, 1};
    EXPECT_FALSE(contains(make(fine, "dbc", {}).result.output, head));
}

TEST(CrowdedWalls, AreTheSameForAnyNumberOfThreads)
{
    for (const char* boundary : {"dbc", "mdbc"})
    {
        const Made one = make(shapes()[3], boundary, {"-threads:1"});
        EXPECT_EQ(one.cloud.positions, make(shapes()[3], boundary, {"-threads:4"}).cloud.positions);
    }
}

/// The public AdvTetrapod: a depth that leaves the surface out.
TEST(DeepInside, StaysOnTheLattice)
{
    const TemporaryFolder folder;
    write_text(folder / "shape.stl", stl_of(box({-1, -1, -1}, {1, 1, 1})));
    CaseText text;
    text.dp = "0.1";
    text.pointmin = R"(<pointmin x="-2.03" y="-2.01" z="-2.02" />)";
    text.pointmax = R"(<pointmax x="2" y="2" z="2" />)";
    text.mainlist = R"(<setdrawmode mode="full" /><setmkbound mk="0" />
<drawfilestl file="shape.stl" advanced="true"><depth depthmin="0.2" depthmax="0.3" /></drawfilestl>)";
    write_text(folder / "Case_Def.xml", text.text());
    ASSERT_EQ(run(folder, {"Case_Def", "Lattice"}).code, 0);
    const RunResult fitted = run(folder, {"Case_Def", "Fitted", "-fit"});
    ASSERT_EQ(fitted.code, 0) << fitted.output;
    EXPECT_TRUE(contains(fitted.output,
                         "<depth depthmin> = 0.2 m leaves the surface out, on which body-fitted "
                         "particles stand; it is drawn on the lattice, not body-fitted"))
        << fitted.output;
    const ParticleCloud lattice = read_particles(folder / "Lattice", true, 1);
    EXPECT_GT(lattice.positions.size(), 0U);
    EXPECT_EQ(read_particles(folder / "Fitted", true, 1).positions, lattice.positions);
}

/// A frame around two chambers, which a slanted block parts; upright, 10 high.
TriangleSoup two_chambers()
{
    constexpr std::array<double, 6> across{-4, 0, 11, 15, 27, 31};
    constexpr std::array<double, 4> along{-8, -4, 4, 8};
    constexpr double height = 10, slant = 0.05;
    const auto is_full = [&](std::size_t i, std::size_t j)
    { return i < 5 && j < 3 && !(j == 1 && (i == 1 || i == 3)); };
    const auto at = [&](std::size_t i, std::size_t j, double z)
    {
        const double moved = (i == 2 ? slant : i == 3 ? -slant : 0) * (along[j] - along[0]);
        return Vec3{across[i] + moved, along[j], z};
    };
    TriangleSoup soup;
    const auto side = [&](std::size_t i, std::size_t j, std::size_t k, std::size_t l)
    { add_quad(soup, at(i, j, 0), at(k, l, 0), at(k, l, height), at(i, j, height)); };
    for (std::size_t i = 0; i < 5; ++i)
        for (std::size_t j = 0; j < 3; ++j)
        {
            if (!is_full(i, j)) continue;
            for (const bool is_top : {true, false})
            {
                const double z = is_top ? height : 0;
                const std::size_t l = is_top ? 1 : 0;
                add_quad(soup, at(i, j, z), at(i + l, j + 1 - l, z), at(i + 1, j + 1, z),
                         at(i + 1 - l, j + l, z));
            }
            // Beyond the first and last, numbers wrap around to large ones, which are not full.
            if (!is_full(i, j - 1)) side(i, j, i + 1, j);
            if (!is_full(i + 1, j)) side(i + 1, j, i + 1, j + 1);
            if (!is_full(i, j + 1)) side(i + 1, j + 1, i, j + 1);
            if (!is_full(i - 1, j)) side(i, j + 1, i, j);
        }
    return soup;
}

/// Rows of nodes along x in the plane of the chambers' walls pass through edges of the block, and
/// by GenCase's rounding not through all of them: a row of the wall was missing beside the fluid.
TEST(DeepInside, HasTheNodesInThePlaneOfAWall)
{
    const TemporaryFolder folder;
    write_text(folder / "shape.stl", stl_of(two_chambers()));
    CaseText text;
    text.dp = "1";
    text.pointmin = R"(<pointmin x="-8" y="-12" z="-3" />)";
    text.pointmax = R"(<pointmax x="36" y="12" z="14" />)";
    text.mainlist = R"(<setdrawmode mode="full" /><setmkbound mk="0" />
<drawfilestl file="shape.stl" advanced="true"><depth depthmin="0" depthmax="3" /></drawfilestl>)";
    write_text(folder / "Case_Def.xml", text.text());
    const RunResult made = run(folder, {"Case_Def", "Case", "-fit:raw"});
    ASSERT_EQ(made.code, 0) << made.output;
    const ParticleCloud cloud = read_particles(folder / "Case", true, 1);
    const auto count = [&](double x, double y)
    {
        return std::count_if(cloud.positions.begin(), cloud.positions.end(),
                             [&](const Vec3& p) {
                                 return norm(p - Vec3{x, y, p.z}) < 1e-6 && p.z > 0.5 && p.z < 9.5;
                             });
    };
    for (const double x : {12, 13, 14}) EXPECT_EQ(count(x, -4), 9) << x;
    EXPECT_EQ(count(13, 4), 9) << "the others are too near to the block's faces";
    EXPECT_EQ(count(13, 6), 9) << "2 below the outside";
    EXPECT_EQ(count(30, 0), 9);
    EXPECT_EQ(count(-1, 0), 9);
}

} // namespace
