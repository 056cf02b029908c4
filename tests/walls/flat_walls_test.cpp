// Flat walls beside fluid on the lattice: their particles stand in its rows.

#include "fppg/read_particles.h"

#include "helpers/case_text.h"
#include "helpers/run_fppg.h"

#include <gtest/gtest.h>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace
{

using namespace fppg::test;
using fppg::Vec3;

constexpr double dp = 0.1;
constexpr std::uint16_t first_bound = 10; ///< mk of mkbound 0
constexpr double width = 20.3 * dp;       ///< so that the lattice is stretched
constexpr double rim = 2.37;

struct Cloud
{
    std::vector<Vec3> walls, fluid;
};

/// A tank of solid walls, 4 dp thick, whose rim is at no row; its water is 1.5 m deep.
Cloud tank(bool is_2d, const std::string& boundary, double width, std::string& output)
{
    const double y = is_2d ? 0.0 : width;
    CaseText text;
    text.pointmin = fmt::format(R"(<pointmin x="-0.6" y="{}" z="-0.6" />)", is_2d ? 0.0 : -0.6);
    text.pointmax =
        fmt::format(R"(<pointmax x="{}" y="{}" z="2.6" />)", width + 0.6, is_2d ? 0.0 : y + 0.6);
    const double outside = is_2d ? -1.0 : -0.4;
    const auto box = [&](double low, double side, double size_x, double size_y, double top)
    {
        return box_command(fmt::format(R"(x="{}" y="{}" z="{}")", low, side, low),
                           fmt::format(R"(x="{}" y="{}" z="{}")", size_x, size_y, top - low));
    };
    text.mainlist = R"(<setdrawmode mode="full" /><setmkbound mk="0" />)" +
                    box(-0.4, outside, width + 0.8, is_2d ? 2.0 : y + 0.8, rim) + "<setmkvoid />" +
                    box(0, is_2d ? -1.0 : 0.0, width, is_2d ? 2.0 : y, 3) +
                    R"(<setmkfluid mk="0" />)" +
                    box(0, is_2d ? -1.0 : 0.0, width, is_2d ? 2.0 : y, 1.5);
    text.after_geometry =
        "<fppg><bodyfitted" + boundary + R"( /><fluidband balance="false" /></fppg>)";
    const TemporaryFolder folder;
    write_text(folder / "Case_Def.xml", text.text());
    const RunResult done = run(folder, {"Case_Def", "out/Case"});
    EXPECT_EQ(done.code, 0) << done.output;
    output = done.output;
    const fppg::ParticleCloud cloud = fppg::read_particles(folder / "out/Case", false, 1);
    Cloud out;
    for (std::size_t i = 0; i < cloud.positions.size(); ++i)
        (cloud.mk[i] < first_bound ? out.fluid : out.walls).push_back(cloud.positions[i]);
    return out;
}

double nearest(const std::vector<Vec3>& points, const Vec3& p)
{
    double out = 1e9;
    for (const Vec3& q : points)
        if (&q != &p) out = std::min(out, norm(q - p));
    return out;
}

struct Kind
{
    bool is_2d;
    std::string boundary;
    double depth; ///< of the first particles of the walls, metres
};

class FlatWalls : public testing::TestWithParam<Kind>
{
};

} // namespace

/// Sides took nodes in 3D only, and only where a rim at the top was at a row too; else each had
/// rows of its own, and the fluid beside it slid along those of the rest.
TEST_P(FlatWalls, StandInTheRowsOfTheFluid)
{
    const Kind& kind = GetParam();
    std::string output;
    const Cloud all = tank(kind.is_2d, kind.boundary, width, output);
    ASSERT_TRUE(contains(output, "Lattice stretched by")) << output;
    // Beyond the reach of the relaxation, the middle shows the rows.
    std::vector<double> rows;
    for (const Vec3& p : all.fluid)
        if (std::abs(p.x - width / 2) < 0.06 && (kind.is_2d || std::abs(p.y - width / 2) < 0.06))
            rows.push_back(p.z);
    std::sort(rows.begin(), rows.end());
    int beside = 0;
    for (const Vec3& wall : all.walls)
    {
        const bool is_first = std::abs(wall.x + kind.depth) < 0.01 * dp &&
                              (kind.is_2d || (wall.y > 0.3 && wall.y < width - 0.3));
        if (!is_first || wall.z < 0.3 || wall.z > 1.2) continue;
        ++beside;
        double off = 1e9;
        for (const double z : rows) off = std::min(off, std::abs(wall.z - z));
        EXPECT_LT(off, 0.02 * dp) << wall.y << ' ' << wall.z;
    }
    EXPECT_GT(beside, kind.is_2d ? 7 : 100);
}

/// Between the rows and the rim particles are evened out.
TEST_P(FlatWalls, HaveNoGapsBelowTheirRim)
{
    const Kind& kind = GetParam();
    std::string output;
    const Cloud all = tank(kind.is_2d, kind.boundary, width, output);
    double farthest = 0;
    double least = 1e9;
    for (double z = 0.3; z < rim - kind.depth; z += 0.01)
        farthest = std::max(farthest, nearest(all.walls, {-kind.depth, kind.is_2d ? 0 : 1.0, z}));
    for (const Vec3& wall : all.walls)
        if (std::abs(wall.x + kind.depth) < 0.01 * dp && (kind.is_2d || std::abs(wall.y - 1) < 0.3))
            least = std::min(least, nearest(all.walls, wall));
    EXPECT_LT(farthest, (kind.is_2d ? 0.63 : 0.8) * dp);
    EXPECT_GT(least, 0.7 * dp);
}

/// Rows of layers that slide past one another have no gap between them: it denied all layers but
/// the first their nodes. And a vertex of an offset surface 0.004 dp off, near a corner, denied
/// one side of a tank its rows. In the solver such tanks were livelier than with rows of their own.
TEST(FlatWallsOfWideTanks, LayersStandInTheRowsOfTheFluidOnAllSides)
{
    for (const double wide : {30.2 * dp, 40.3 * dp})
    {
        std::string output;
        const Cloud all = tank(true, R"( boundary="mdbc" layers="3")", wide, output);
        std::vector<double> columns, rows;
        for (const Vec3& p : all.fluid)
        {
            if (std::abs(p.z - 0.8) < 0.06) columns.push_back(p.x);
            if (std::abs(p.x - wide / 2) < 0.06) rows.push_back(p.z);
        }
        std::array<int, 6> found{};
        const auto expect_near = [&](double at, const std::vector<double>& lines, std::size_t side)
        {
            double off = 1e9;
            for (const double line : lines) off = std::min(off, std::abs(at - line));
            EXPECT_LT(off, 0.02 * dp) << at << " of side " << side << " in " << wide;
            ++found[side];
        };
        for (const Vec3& wall : all.walls)
            for (const std::size_t layer : {0, 1})
            {
                const double depth = (static_cast<double>(layer) + 0.5) * dp;
                const bool is_beside = wall.z > 0.2 && wall.z < 1.3;
                if (std::abs(wall.z + depth) < 0.01 * dp && wall.x > 0.6 && wall.x < wide - 0.6)
                    expect_near(wall.x, columns, layer);
                if (is_beside && std::abs(wall.x + depth) < 0.01 * dp)
                    expect_near(wall.z, rows, 2 + layer);
                if (is_beside && std::abs(wall.x - wide - depth) < 0.01 * dp)
                    expect_near(wall.z, rows, 4 + layer);
            }
        EXPECT_GT(found[0], wide / dp - 14);
        EXPECT_EQ(found[0], found[1]);
        for (const std::size_t side : {2, 3, 4, 5}) EXPECT_GT(found[side], 9) << side;
    }
}

INSTANTIATE_TEST_SUITE_P(Tanks, FlatWalls,
                         testing::Values(Kind{true, "", 0},
                                         Kind{true, R"( boundary="mdbc")", dp / 2},
                                         Kind{false, "", 0},
                                         Kind{false, R"( boundary="mdbc")", dp / 2}));
