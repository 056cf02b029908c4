// Cavities that are filled from a seed, and points from files, run as users run them; FPPG_PROGRAM
// is the program's path.

#include "fppg/read_particles.h"

#include "helpers/bi4_array.h"
#include "helpers/case_text.h"
#include "helpers/run_program.h"

#include <gtest/gtest.h>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <numbers>
#include <random>
#include <tuple>

namespace
{

using fppg::ParticleCloud;
using fppg::Vec3;
using fppg::test::bi4_array;
using fppg::test::box_command;
using fppg::test::CaseText;
using fppg::test::Process;
using fppg::test::read_text;
using fppg::test::RunResult;
using fppg::test::TemporaryFolder;
using fppg::test::write_text;
using Arguments = std::vector<std::string>;

constexpr std::uint16_t fluid_mk = 1;
constexpr std::uint16_t bound_mk = 10; ///< of mkbound 0

bool says(const std::string& text, const std::string& part)
{
    return text.find(part) != std::string::npos;
}

RunResult run_case(const TemporaryFolder& folder, const CaseText& text, const Arguments& more = {})
{
    write_text(folder / "Case_Def.xml", text.text());
    Arguments words{"Case_Def", "out/Case", "-save:all"};
    words.insert(words.end(), more.begin(), more.end());
    return Process(FPPG_PROGRAM, words, folder.path().string(), {{"SOURCE_DATE_EPOCH", "86400"}})
        .wait();
}

/// In the order of read_particles().
std::vector<float> densities_of(const TemporaryFolder& folder)
{
    return bi4_array<float>(read_text(folder / "out/Case.bi4"), "Rhop");
}

std::vector<Vec3> positions_of(const TemporaryFolder& folder, std::uint16_t mk)
{
    const ParticleCloud cloud = fppg::read_particles(folder / "out/Case", false, 1);
    std::vector<Vec3> out;
    for (std::size_t i = 0; i < cloud.positions.size(); ++i)
        if (cloud.mk[i] == mk) out.push_back(cloud.positions[i]);
    return out;
}

/// Walls of mkbound 0 all around a cube of one metre, dp 0.1: 9 nodes a side inside.
CaseText closed_box(const std::string& block)
{
    CaseText out;
    out.mainlist = R"(<setdrawmode mode="face" /><setmkbound mk="0" />)" +
                   box_command(R"(x="0" y="0" z="0")", R"(x="1" y="1" z="1")", "all");
    out.after_geometry = "<fppg>" + block + "</fppg>";
    return out;
}

TEST(FillOfACase, FillsAShareOfABoxAndSaysSo)
{
    const TemporaryFolder folder;
    const RunResult result = run_case(
        folder, closed_box(R"(<fill mkfluid="2" seed="0.5,#0.2+0.3,0.5" percent="33" />)"));
    ASSERT_EQ(result.code, 0) << result.output;
    const std::vector<Vec3> fluid = positions_of(folder, fluid_mk + 2);
    EXPECT_EQ(fluid.size(), 243u);
    for (const Vec3& p : fluid) EXPECT_LT(p.z, 0.31);
    const std::string log = read_text(folder / "out/Case.out");
    EXPECT_TRUE(says(log, "<fill>: the cavity holds 729 litres, 729 nodes, closed"));
    EXPECT_TRUE(
        says(log, "<fill>: filled 243 nodes, 243 litres, 33.33 % of the cavity, level 0.3"));
}

TEST(FillOfACase, TakesVariablesOfTheCommandsAndASeedAsChild)
{
    const TemporaryFolder folder;
    CaseText text =
        closed_box(R"(<fill mkfluid="0" litres="#oil"><seed x="#mid" y="#mid" z="#mid" /></fill>)");
    text.mainlist = R"(<newvarcte oil="162" mid="0.5" />)" + text.mainlist;
    const RunResult result = run_case(folder, text);
    ASSERT_EQ(result.code, 0) << result.output;
    EXPECT_EQ(positions_of(folder, fluid_mk).size(), 162u);
}

/// Nodes from 0.5 dp on stay, so that nothing depends on the volume of the walls.
const std::string near_walls = R"(<bodyfitted clearance="0.5" />)";

TEST(FillOfACase, FillsBesideBodyFittedWalls)
{
    // Relaxed fluid has the particles that its volume asks for, nodes stay as many as they are.
    const std::string on_nodes = R"(<fluidband active="false" />)";
    for (const char* fit : {"-fit:raw", "-fit"})
    {
        const TemporaryFolder folder;
        const RunResult result =
            run_case(folder,
                     closed_box(near_walls + on_nodes +
                                R"(<fill mkfluid="0" seed="0.5,0.5,0.5" level="0.5" />)"),
                     {fit});
        ASSERT_EQ(result.code, 0) << result.output;
        EXPECT_EQ(positions_of(folder, fluid_mk).size(), 9u * 9u * 5u);
        // The box is small against dp, which a warning of its count may say.
        EXPECT_FALSE(says(result.output, "gapclose")) << result.output;
    }
}

TEST(FillOfACase, FillsASectionIn2D)
{
    for (const char* fit : {"-fit:off", "-fit:raw"})
    {
        const TemporaryFolder folder;
        CaseText text =
            closed_box(near_walls + R"(<fill mkfluid="0" seed="0.5,0.5,0.5" percent="100" />)");
        text.pointmin = R"(<pointmin x="-0.5" y="0.5" z="-0.5" />)";
        text.pointmax = R"(<pointmax x="1.5" y="0.5" z="1.5" />)";
        const RunResult result = run_case(folder, text, {fit});
        ASSERT_EQ(result.code, 0) << result.output;
        EXPECT_EQ(positions_of(folder, fluid_mk).size(), 81u) << fit;
    }
}

TEST(FillOfACase, NamesTheElementWhereTheCavityIsOpen)
{
    const TemporaryFolder folder;
    CaseText text = fppg::test::tank();
    text.mainlist = R"(<setdrawmode mode="face" /><setmkbound mk="0" />)" +
                    box_command(R"(x="0" y="0" z="0")", R"(x="1" y="1" z="1")",
                                "bottom | left | right | front | back");
    text.after_geometry = R"(<fppg><fill mkfluid="0" seed="0.5,0.5,0.5" percent="50" /></fppg>)";
    const RunResult result = run_case(folder, text);
    EXPECT_EQ(result.code, 3);
    EXPECT_TRUE(says(result.output,
                     "<fill>: the cavity of the seed (0.5, 0.5, 0.5) is not closed: "
                     "the lowest way out is at height 1.1 near"))
        << result.output;
}

TEST(FillOfACase, RefusesWrongAttributes)
{
    const std::string seed = R"(<fill mkfluid="0" seed="0.5,0.5,0.5" )";
    const std::vector<std::pair<std::string, std::string>> faults{
        {R"(<fill mkfluid="0" percent="50" />)", "the seed is missing"},
        {seed + "/>", "has 0 of the attributes level, litres and percent"},
        {seed + R"(percent="50" level="1" />)", "has 2 of the attributes"},
        {seed + R"(percent="101" />)", "is 101, expected above 0 to 100"},
        {seed + R"(litres="-1" />)", "expected litres above 0"},
        {seed + R"(level="1" up="0,0,0" />)", "expected a direction"},
        {seed + R"(level="1" gapclose="0.5" />)", "expected a whole number of nodes"},
        {R"(<fill mkfluid="9" seed="0,0,0" level="1" />)", "expected 0 to 8"},
        {R"(<fill mkfluid="0" seed="0,0" level="1" />)", "expected x,y,z"},
        {R"(<fill mkfluid="0" seed="0,0,a" level="1" />)", "attribute seed=\"a\""},
        {R"(<points mkfluid="0" />)", "attribute 'file' is missing"},
        {R"(<points file="p.csv" />)", "expected one of the attributes mkbound and mkfluid"}};
    for (const auto& [block, message] : faults)
    {
        const TemporaryFolder folder;
        const RunResult result = run_case(folder, closed_box(block));
        EXPECT_EQ(result.code, 3) << block;
        EXPECT_TRUE(says(result.output, message)) << block << "\n" << result.output;
    }
}

/// A plate from x0 to x1 over 0..1 in y and z with a round hole about (0.5, 0.5), ASCII STL.
std::string plate_with_hole(double x0, double x1, double radius)
{
    constexpr int sides = 48;
    std::string text = "solid plate\n";
    const auto facet = [&](const Vec3& a, const Vec3& b, const Vec3& c)
    {
        text += "facet normal 0 0 0\nouter loop\n";
        for (const Vec3& p : {a, b, c})
            text += fmt::format("vertex {:.9g} {:.9g} {:.9g}\n", p.x, p.y, p.z);
        text += "endloop\nendfacet\n";
    };
    const auto quad = [&](const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d)
    {
        facet(a, b, c);
        facet(a, c, d);
    };
    const auto at = [&](double x, int i, bool is_hole)
    {
        const double angle = 2 * std::numbers::pi * (i % sides) / sides;
        const double y = std::cos(angle);
        const double z = std::sin(angle);
        const double r = is_hole ? radius : 0.5 / std::max(std::abs(y), std::abs(z));
        return Vec3{x, 0.5 + r * y, 0.5 + r * z};
    };
    for (int i = 0; i < sides; ++i)
    {
        const int j = i + 1;
        quad(at(x1, i, true), at(x1, i, false), at(x1, j, false), at(x1, j, true));
        quad(at(x0, i, true), at(x0, j, true), at(x0, j, false), at(x0, i, false));
        quad(at(x0, i, false), at(x0, j, false), at(x1, j, false), at(x1, i, false));
        quad(at(x0, i, true), at(x1, i, true), at(x1, j, true), at(x0, j, true));
    }
    return text + "endsolid plate\n";
}

/// A housing of one metre with walls of two dp and a shaft through holes in two of them.
CaseText gearbox(const TemporaryFolder& folder, double clearance_dp, const std::string& block)
{
    constexpr double dp = 0.05;
    constexpr double shaft = 0.212;
    write_text(folder / "left.stl", plate_with_hole(0, 0.1, shaft + clearance_dp * dp));
    write_text(folder / "right.stl", plate_with_hole(0.9, 1, shaft + clearance_dp * dp));
    CaseText out;
    out.dp = "0.05";
    out.mainlist =
        R"(<setdrawmode mode="full" /><setmkbound mk="0" />)"
        R"(<drawfilestl file="left.stl" fppg:fill="inside" />)"
        R"(<drawfilestl file="right.stl" fppg:fill="inside" />)" +
        box_command(R"(x="0" y="0" z="0")", R"(x="1" y="1" z="0.1")") +
        box_command(R"(x="0" y="0" z="0.9")", R"(x="1" y="1" z="0.1")") +
        box_command(R"(x="0" y="0" z="0")", R"(x="1" y="0.1" z="1")") +
        box_command(R"(x="0" y="0.9" z="0")", R"(x="1" y="0.1" z="1")") +
        R"(<setmkbound mk="1" /><drawcylinder radius="0.212"><point x="-0.2" y="0.5" z="0.5" />)"
        R"(<point x="1.2" y="0.5" z="0.5" /></drawcylinder>)";
    out.after_geometry = "<fppg>" + block + "</fppg>";
    return out;
}

TEST(FillOfACase, DoesNotLeakThroughTheClearanceOfAShaft)
{
    for (const char* fit : {"-fit:off", "-fit:raw"})
        for (const double clearance : {0.5, 1.0})
        {
            const TemporaryFolder folder;
            const RunResult result =
                run_case(folder,
                         gearbox(folder, clearance,
                                 R"(<fill mkfluid="0" seed="0.5,0.5,0.15" percent="60" />)"),
                         {fit});
            ASSERT_EQ(result.code, 0) << fit << " " << clearance << "\n" << result.output;
            const std::vector<Vec3> fluid = positions_of(folder, fluid_mk);
            EXPECT_GT(fluid.size(), 1300u);
            for (const Vec3& p : fluid)
                for (int axis = 0; axis < 3; ++axis)
                {
                    EXPECT_GT(p[axis], 0.05);
                    EXPECT_LT(p[axis], 0.95);
                }
        }
}

TEST(FillOfACase, FillsTheSumpOfAGearboxWhoseLidHasAHole)
{
    const char* shared = std::getenv("FPPG_SHARED");
    const std::string models = std::string(shared != nullptr ? shared : "") + "/models/generated/";
    if (shared == nullptr || !std::filesystem::exists(models + "gearbox_housing.stl"))
        GTEST_SKIP() << "FPPG_SHARED does not name the folder of the generated models";
    CaseText text;
    text.dp = "0.002";
    text.pointmin = R"(<pointmin x="-0.08" y="-0.12" z="-0.11" />)";
    text.pointmax = R"(<pointmax x="0.19" y="0.12" z="0.11" />)";
    text.mainlist = R"(<setdrawmode mode="full" />)";
    int mk = 0;
    for (const char* part : {"housing", "lid", "gear1", "gear2", "shaft1", "shaft2"})
        text.mainlist += fmt::format(
            R"(<setmkbound mk="{}" /><drawfilestl file="{}gearbox_{}.stl" fppg:fill="inside">)"
            R"(<drawscale x="0.001" y="0.001" z="0.001" /></drawfilestl>)",
            mk++, models, part);
    const std::string fill = R"(<fppg><fill mkfluid="0" seed="0.045,0.02,-0.04" {} /></fppg>)";
    for (const char* fit : {"-fit:off", "-fit:raw"})
    {
        const TemporaryFolder folder;
        text.after_geometry = fmt::format(fmt::runtime(fill), R"(level="-0.02")");
        const RunResult level = run_case(folder, text, {fit});
        ASSERT_EQ(level.code, 0) << level.output;
        const std::vector<Vec3> oil = positions_of(folder, fluid_mk);
        EXPECT_NEAR(static_cast<double>(oil.size()) * 8e-6, 0.322, 0.005); // litres
        for (const Vec3& p : oil) EXPECT_LT(p.z, -0.0199);
        text.after_geometry = fmt::format(fmt::runtime(fill), R"(percent="45")");
        const RunResult open = run_case(folder, text, {fit});
        EXPECT_EQ(open.code, 3);
        EXPECT_TRUE(says(open.output, "gapclose=\"4\" closes: 26 nodes near (0.055, 0, 0.07)"))
            << open.output;
    }
}

TEST(FillOfACase, ListsTheGapRoundAShaftAndRefusesAWideOne)
{
    bool has_gap = false;
    for (const double clearance : {1.5, 2.0, 2.5})
    {
        const TemporaryFolder folder;
        const RunResult result = run_case(
            folder,
            gearbox(folder, clearance, R"(<fill mkfluid="0" seed="0.5,0.5,0.15" percent="60" />)"));
        has_gap = has_gap || (result.code == 0 && says(result.output, "closed, so that the fill") &&
                              says(result.output, "to the outside"));
    }
    EXPECT_TRUE(has_gap);
    const TemporaryFolder folder;
    const RunResult wide = run_case(
        folder, gearbox(folder, 3, R"(<fill mkfluid="0" seed="0.2,0.2,0.2" percent="60" />)"));
    EXPECT_EQ(wide.code, 3);
    EXPECT_TRUE(says(wide.output, "it leaks through an opening")) << wide.output;
}

const std::vector<Vec3> some_points{{0.313, 0.2, 0.71}, {0.1, 0.25, 0.33}, {0.313, 0.1, 0.5}};

std::string csv_of(const std::vector<Vec3>& points)
{
    std::string text = "x;y;z\n";
    for (const Vec3& p : points) text += fmt::format("{};{};{}\n", p.x, p.y, p.z);
    return text;
}

void expect_sorted(const std::vector<Vec3>& found, std::vector<Vec3> expected, double tolerance)
{
    std::sort(expected.begin(), expected.end(),
              [](const Vec3& a, const Vec3& b)
              { return std::tie(a.x, a.y, a.z) < std::tie(b.x, b.y, b.z); });
    ASSERT_EQ(found.size(), expected.size());
    for (std::size_t i = 0; i < found.size(); ++i)
        EXPECT_LE(norm(found[i] - expected[i]), tolerance) << i;
}

TEST(PointsOfACase, StandExactlyWhereTheFileSays)
{
    const TemporaryFolder folder;
    write_text(folder / "p.csv", csv_of(some_points));
    const RunResult result = run_case(
        folder, closed_box(R"(<points file="p.csv" mkbound="5" /><points file="p.csv" mkfluid="1" )"
                           R"(move="0,0,0.01" scale="1" />)"));
    ASSERT_EQ(result.code, 0) << result.output;
    expect_sorted(positions_of(folder, bound_mk + 5), some_points, 0);
    std::vector<Vec3> moved = some_points;
    for (Vec3& p : moved) p.z += 0.01;
    expect_sorted(positions_of(folder, fluid_mk + 1), moved, 0);
    EXPECT_TRUE(std::filesystem::exists(folder / "out/p.csv")) << "beside the result, as meshes";
    EXPECT_EQ(positions_of(folder, bound_mk).size(), 11u * 11 * 11 - 9 * 9 * 9);
}

TEST(PointsOfACase, ComeFromVtkAndPlyFilesToo)
{
    const TemporaryFolder folder;
    std::string rows;
    for (const Vec3& p : some_points) rows += fmt::format("{} {} {}\n", p.x, p.y, p.z);
    write_text(folder / "p.vtk",
               "# vtk DataFile Version 3.0\npoints\nASCII\nDATASET POLYDATA\n"
               "POINTS 3 double\n" +
                   rows);
    write_text(folder / "p.ply",
               "ply\nformat ascii 1.0\nelement vertex 3\nproperty double x\nproperty double y\n"
               "property double z\nend_header\n" +
                   rows);
    const RunResult result = run_case(
        folder, closed_box(R"(<points file="p.vtk" mkbound="5" /><points file="p.ply" mkfluid="1" )"
                           R"(/>)"));
    ASSERT_EQ(result.code, 0) << result.output;
    expect_sorted(positions_of(folder, bound_mk + 5), some_points, 0);
    expect_sorted(positions_of(folder, fluid_mk + 1), some_points, 0);
}

TEST(PointsOfACase, StandBesideBodyFittedWallsAndDoNotMove)
{
    const TemporaryFolder folder;
    write_text(folder / "p.csv", csv_of(some_points));
    const RunResult result = run_case(
        folder, closed_box(R"(<fluidband /><points file="p.csv" mkfluid="1" />)"), {"-fit"});
    ASSERT_EQ(result.code, 0) << result.output;
    expect_sorted(positions_of(folder, fluid_mk + 1), some_points, 0);
}

/// A block of points 0.1 apart, 20 high, off the nodes by `offset`; each moved by up to `noise`.
std::vector<Vec3> water_points(double offset, double noise)
{
    std::vector<Vec3> out;
    std::mt19937 dice(3);
    const auto any = [&] { return noise * (static_cast<double>(dice()) / 2147483648.0 - 1); };
    for (int x = 0; x < 6; ++x)
        for (int y = 0; y < 6; ++y)
            for (int z = 0; z < 20; ++z)
                out.push_back(
                    {offset + 0.1 * x + any(), offset + 0.1 * y + any(), offset + 0.1 * z + any()});
    return out;
}

/// Depth below the highest fluid that the density of every fluid particle says, dp, less its real
/// one; and the depth that the case printed, metres.
struct DepthsOfPoints
{
    double largest_error = 0;
    double printed = 0;
};

DepthsOfPoints depths_of(const std::vector<Vec3>& points, const std::string& gradient,
                         const std::string& gravity = R"(<gravity x="0" y="0" z="-9.81" />)")
{
    const TemporaryFolder folder;
    write_text(folder / "p.csv", csv_of(points));
    CaseText text;
    text.gravity = gravity;
    text.rhopgradient = "<rhopgradient value=\"" + gradient + "\" />";
    text.pointmax = R"(<pointmax x="1.5" y="1.5" z="3" />)";
    text.mainlist = R"(<setmkbound mk="0" /><drawpoint x="-0.4" y="-0.4" z="-0.4" />)";
    text.after_geometry = R"(<fppg><points file="p.csv" mkfluid="0" /></fppg>)";
    const RunResult result = run_case(folder, text);
    EXPECT_EQ(result.code, 0) << result.output;
    DepthsOfPoints out;
    out.printed = std::stod(result.output.substr(result.output.find("Maximum depth: ") + 15));
    const ParticleCloud cloud = fppg::read_particles(folder / "out/Case", false, 1);
    const std::vector<float> rhop = densities_of(folder);
    double top = 0;
    for (std::size_t i = 0; i < cloud.positions.size(); ++i)
        if (cloud.mk[i] == fluid_mk) top = std::max(top, cloud.positions[i].z);
    const double b = 400 * 9.81 * out.printed * 1000 / 7;
    for (std::size_t i = 0; i < cloud.positions.size(); ++i)
    {
        if (cloud.mk[i] != fluid_mk) continue;
        const double depth = (std::pow(rhop[i] / 1000, 7) - 1) * b / (1000 * 9.81);
        out.largest_error =
            std::max(out.largest_error, std::abs(depth - (top - cloud.positions[i].z)) / 0.1);
    }
    return out;
}

TEST(PointsOfACase, HaveTheDensityOfTheirDepthAndGiveTheDepthOfWater)
{
    const DepthsOfPoints on_nodes = depths_of(water_points(0, 0), "2");
    EXPECT_NEAR(on_nodes.printed, 1.9, 1e-6);
    EXPECT_LT(on_nodes.largest_error, 0.01);
    const DepthsOfPoints between = depths_of(water_points(0.034, 0), "2");
    EXPECT_NEAR(between.printed, 1.9, 1e-6);
    EXPECT_LT(between.largest_error, 0.5);
    const DepthsOfPoints highest = depths_of(water_points(0.034, 0), "3");
    EXPECT_NEAR(highest.printed, 1.9, 1e-6);
    EXPECT_LT(highest.largest_error, 0.01);
}

TEST(PointsOfACase, LeaveNoGapsInTheWaterWhereTheyAreUneven)
{
    const DepthsOfPoints uneven = depths_of(water_points(0.034, 0.04), "2");
    EXPECT_NEAR(uneven.printed, 1.9, 0.11);
    EXPECT_LT(uneven.largest_error, 1.5);
}

TEST(PointsOfACase, StartAtRhop0WithGradientOne)
{
    const TemporaryFolder folder;
    write_text(folder / "p.csv", csv_of(water_points(0.034, 0)));
    CaseText text = closed_box(R"(<points file="p.csv" mkfluid="0" />)");
    text.pointmax = R"(<pointmax x="1.5" y="1.5" z="3" />)";
    text.rhopgradient = R"(<rhopgradient value="1" />)";
    ASSERT_EQ(run_case(folder, text).code, 0);
    for (const float rhop : densities_of(folder)) EXPECT_EQ(rhop, 1000.0F);
    EXPECT_FALSE(says(read_text(folder / "out/Case.xml"), R"(<b value="0")"));
}

TEST(PointsOfACase, StandOnTheWaterOfTheLattice)
{
    // The lattice is water up to z = 0.5; the points follow from 0.6 up to 2.5.
    std::vector<Vec3> points = water_points(0, 0);
    for (Vec3& p : points) p = p + Vec3{0, 0, 0.6};
    const TemporaryFolder folder;
    write_text(folder / "p.csv", csv_of(points));
    CaseText text;
    text.pointmax = R"(<pointmax x="1.5" y="1.5" z="3" />)";
    text.mainlist = R"(<setdrawmode mode="full" /><setmkfluid mk="1" />)" +
                    box_command(R"(x="0" y="0" z="0")", R"(x="0.5" y="0.5" z="0.5")");
    text.after_geometry = R"(<fppg><points file="p.csv" mkfluid="0" /></fppg>)";
    const RunResult result = run_case(folder, text);
    ASSERT_EQ(result.code, 0) << result.output;
    EXPECT_TRUE(says(result.output, "Maximum depth: 2.5 (automatic)")) << result.output;
}

TEST(FluidOffTheLattice, HasRhop0AsInGenCaseUnlessAskedOtherwise)
{
    CaseText text;
    text.mainlist =
        R"(<setdrawmode mode="full" /><setfrdrawmode auto="true" /><setmkfluid mk="0" />)" +
        box_command(R"(x="0" y="0" z="0.013")", R"(x="0.4" y="0.4" z="1")");
    const TemporaryFolder folder;
    const RunResult usual = run_case(folder, text);
    ASSERT_EQ(usual.code, 0) << usual.output;
    EXPECT_TRUE(says(usual.output, "Density of fluid of <setfrdrawmode>: rhop0, as GenCase"))
        << usual.output;
    for (const float rhop : densities_of(folder)) EXPECT_EQ(rhop, 1000.0F);
    text.after_geometry = R"(<fppg><offlattice hydrostatic="true" /></fppg>)";
    const RunResult asked = run_case(folder, text);
    ASSERT_EQ(asked.code, 0) << asked.output;
    EXPECT_TRUE(says(asked.output, "Density of fluid of <setfrdrawmode>: hydrostatic"))
        << asked.output;
    const std::vector<float> rhop = densities_of(folder);
    const auto [low, high] = std::minmax_element(rhop.begin(), rhop.end());
    EXPECT_NEAR(*low, 1000, 0.1);
    EXPECT_GT(*high, 1002.4);
}

TEST(PointsOfACase, OutsideTheDomainAreRefusedByNumberAndPlace)
{
    const TemporaryFolder folder;
    write_text(folder / "p.csv", csv_of({{0, 0, 0}, {0.5, 7, 0.5}}));
    const RunResult result = run_case(folder, closed_box(R"(<points file="p.csv" mkbound="5" />)"));
    EXPECT_EQ(result.code, 3);
    EXPECT_TRUE(says(result.output, "point 2 of 2 is at (0.5, 7, 0.5)")) << result.output;
}

TEST(PointsOfACase, AreWarnedOfWhereTheyMeetOthers)
{
    const TemporaryFolder folder;
    write_text(folder / "p.csv", csv_of({{0.51, 0.5, 0}, {0.5, 0.5, 0.5}, {0.5, 0.5, 0.5}}));
    const RunResult result = run_case(folder, closed_box(R"(<points file="p.csv" mkbound="5" />)"));
    EXPECT_EQ(result.code, 0);
    EXPECT_TRUE(says(result.output, "1 point is nearer than dp/2 to a particle")) << result.output;
    EXPECT_TRUE(says(result.output, "1 point is at the place of another one"));
}

TEST(FillOfACase, GivesTheSameBytesWithAnyNumberOfThreads)
{
    const std::string block = R"(<fill mkfluid="0" seed="0.5,0.5,0.15" percent="60" />)";
    const TemporaryFolder one;
    const TemporaryFolder eight;
    ASSERT_EQ(run_case(one, gearbox(one, 1.5, block), {"-threads:1"}).code, 0);
    ASSERT_EQ(run_case(eight, gearbox(eight, 1.5, block), {"-threads:8"}).code, 0);
    EXPECT_EQ(read_text(one / "out/Case.bi4"), read_text(eight / "out/Case.bi4"));
    EXPECT_EQ(read_text(one / "out/Case_All.vtk"), read_text(eight / "out/Case_All.vtk"));
}

} // namespace
