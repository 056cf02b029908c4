// Still water beside fitted walls on lattices that are stable under pressure, as a user finds it in
// Case.bi4.

#include "fppg/read_particles.h"

#include "helpers/case_text.h"
#include "helpers/run_fppg.h"

#include <gtest/gtest.h>

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <map>

namespace
{

using namespace fppg::test;
using fppg::ParticleCloud;
using fppg::Vec3;

constexpr double dp = 0.1;
constexpr std::uint16_t first_bound = 10; ///< mk of mkbound 0

/// A tank of solid walls 0.4 m thick round the space from 0 to `inside`, open above.
///
/// fluid  its commands
CaseText tank(const Vec3& inside, const std::string& fluid, const std::string& band)
{
    const bool is_2d = inside.y == 0;
    const double front = is_2d ? -1 : 0, deep = is_2d ? 2 : inside.y;
    CaseText text;
    text.pointmin = fmt::format(R"(<pointmin x="-0.6" y="{}" z="-0.6" />)", is_2d ? 0 : -0.6);
    text.pointmax = fmt::format(R"(<pointmax x="{}" y="{}" z="{}" />)", inside.x + 0.6,
                                is_2d ? 0 : inside.y + 0.6, inside.z + 0.6);
    text.mainlist =
        R"(<setdrawmode mode="full" /><setmkbound mk="0" />)" +
        box_command(
            fmt::format(R"(x="-0.4" y="{}" z="-0.4")", front - 0.4),
            fmt::format(R"(x="{}" y="{}" z="{}")", inside.x + 0.8, deep + 0.8, inside.z + 0.4)) +
        "<setmkvoid />" +
        box_command(fmt::format(R"(x="0" y="{}" z="0")", front),
                    fmt::format(R"(x="{}" y="{}" z="{}")", inside.x, deep, inside.z + 1)) +
        fluid;
    text.after_geometry = "<fppg><bodyfitted />" + band + "</fppg>";
    return text;
}

/// The same with another smoothing length, by `coefh`.
CaseText with_coefh(CaseText text, const std::string& coefh)
{
    const std::string one = R"(<coefh value="1" />)";
    text.constants.replace(text.constants.find(one), one.size(),
                           fmt::format(R"(<coefh value="{}" />)", coefh));
    return text;
}

const std::string modified_boundaries = R"(<parameters><parameter key="Boundary" value="2" />)"
                                        R"(<parameter key="SlipMode" value="2" />)"
                                        R"(<parameter key="NoPenetration" value="1" />)"
                                        R"(</parameters>)";

/// Fluid from z = `low` to `high` all over a tank.
std::string water(int mk, const Vec3& inside, double low, double high)
{
    const bool is_2d = inside.y == 0;
    return fmt::format(R"(<setmkfluid mk="{}" />)", mk) +
           box_command(
               fmt::format(R"(x="0" y="{}" z="{}")", is_2d ? -1 : 0, low),
               fmt::format(R"(x="{}" y="{}" z="{}")", inside.x, is_2d ? 2 : inside.y, high - low));
}

/// A ball half full of water, with modified boundaries.
///
/// y  of both ends of the domain; 0: in 2D
CaseText half_full_ball(double y)
{
    CaseText text;
    text.pointmin = fmt::format(R"(<pointmin x="-1.59" y="{}" z="-1.59" />)", -y);
    text.pointmax = fmt::format(R"(<pointmax x="1.59" y="{}" z="1.59" />)", y);
    const auto ball = [](double radius)
    {
        return fmt::format(R"(<drawsphere radius="{}"><point x="0" y="0" z="0" /></drawsphere>)",
                           radius);
    };
    text.mainlist = R"(<setdrawmode mode="full" /><setmkbound mk="0" />)" + ball(1.39) +
                    "<setmkvoid />" + ball(0.99) +
                    R"(<setmkfluid mk="0" /><fillbox x="0" y="0" z="-0.2">)"
                    R"(<modefill>void</modefill><point x="-1.59" y="-1.59" z="-1.59" />)"
                    R"(<size x="3.18" y="3.18" z="1.59" /></fillbox>)";
    text.after_geometry = R"(<fppg><bodyfitted boundary="mdbc" /></fppg>)";
    text.execution = modified_boundaries;
    return text;
}

struct Made
{
    std::string output;
    ParticleCloud cloud;
    std::string bytes;
};

Made make(const CaseText& text, const Arguments& more = {})
{
    const TemporaryFolder folder;
    write_text(folder / "Case_Def.xml", text.text());
    Arguments words{"Case_Def", "out/Case"};
    words.insert(words.end(), more.begin(), more.end());
    const RunResult done = run(folder, words);
    EXPECT_EQ(done.code, 0) << done.output;
    return {done.output, fppg::read_particles(folder / "out/Case", false, 1),
            read_text(folder / "out/Case.bi4")};
}

std::vector<Vec3> fluid_of(const ParticleCloud& cloud)
{
    std::vector<Vec3> out;
    for (std::size_t i = 0; i < cloud.positions.size(); ++i)
        if (cloud.mk[i] < first_bound) out.push_back(cloud.positions[i]);
    return out;
}

/// Of particles farther than 4 dp from the bounds of the fluid and 11 below its surface, how many
/// have how many others nearer than `reach`. (Near the surface, where pressures are low, balancing
/// leaves rows of other lengths.)
std::map<int, int> neighbours_in_the_midst(const std::vector<Vec3>& fluid, double reach)
{
    fppg::Box3 bounds;
    for (const Vec3& p : fluid) bounds.add(p);
    const auto& [low, high] = bounds;
    const bool is_2d = low.y == high.y;
    std::map<int, int> out;
    for (const Vec3& p : fluid)
    {
        bool is_amid = true;
        for (int axis = 0; axis < 3; ++axis)
            if (!(is_2d && axis == 1))
                is_amid = is_amid && p[axis] > low[axis] + 4 * dp &&
                          p[axis] < high[axis] - (axis == 2 ? 11 : 4) * dp;
        if (!is_amid) continue;
        int count = -1; // itself
        for (const Vec3& other : fluid) count += norm(other - p) < reach ? 1 : 0;
        ++out[count];
    }
    return out;
}

/// The number that follows `words` in a text; NaN where they are not in it.
double number_after(const std::string& text, const std::string& words)
{
    const std::size_t at = text.find(words);
    if (at == std::string::npos) return std::numeric_limits<double>::quiet_NaN();
    return std::stod(text.substr(at + words.size()));
}

double nearest_pair(const std::vector<Vec3>& points)
{
    double out = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < points.size(); ++i)
        for (std::size_t j = 0; j < i; ++j) out = std::min(out, norm(points[i] - points[j]));
    return out;
}

const std::string cubic = R"(<fluidband packing="cubic" />)";

} // namespace

TEST(StablePacking, HasSixNeighboursIn2DAt17Dp)
{
    const Vec3 inside{2.4, 0, 3};
    const std::string fluid = water(0, inside, 0, 2.6);
    const Made packed = make(with_coefh(tank(inside, fluid, ""), "1.2"));
    const Made square = make(with_coefh(tank(inside, fluid, cubic), "1.2"));
    EXPECT_TRUE(contains(packed.output, "most stable under pressure")) << packed.output;
    EXPECT_FALSE(contains(square.output, "most stable under pressure"));
    const std::vector<Vec3> places = fluid_of(packed.cloud);
    EXPECT_EQ(packed.cloud.mk, square.cloud.mk);
    // A hexagon of dp^2 has its neighbours at 1.07 dp, the next ones at 1.86; a square at 1, 1.41.
    const std::map<int, int> six = neighbours_in_the_midst(places, 1.4 * dp);
    // A row that ends amid others leaves one place with five and one with seven.
    std::size_t all = 0;
    for (const auto& [neighbours, count] : six) all += static_cast<std::size_t>(count);
    EXPECT_GT(six.at(6), 100);
    EXPECT_LE(all - static_cast<std::size_t>(six.at(6)), 6U);
    EXPECT_EQ(neighbours_in_the_midst(fluid_of(square.cloud), 1.3 * dp).begin()->first, 4);
    EXPECT_GT(nearest_pair(places), 0.6 * dp); // in the highest row
    double highest = 0;
    for (const Vec3& p : places) highest = std::max(highest, p.z);
    EXPECT_NEAR(highest, 2.6 - dp / 2, dp / 2);
}

TEST(StablePacking, KeepsASquareLatticeThatIsStable)
{
    const Vec3 inside{2.4, 0, 3};
    const CaseText text = with_coefh(tank(inside, water(0, inside, 0, 2.6), ""), "1.4142135");
    const Made made = make(text); // h is 2 dp
    EXPECT_TRUE(contains(made.output, "Balanced fluid"));
    EXPECT_FALSE(contains(made.output, "most stable under pressure")) << made.output;
    EXPECT_EQ(neighbours_in_the_midst(fluid_of(made.cloud), 1.3 * dp).begin()->first, 4);
}

// Half a circle of water, whose particles may be as near to the wall as 0.2 dp; one stood as far
// behind it.
TEST(StablePacking, PutsNoFluidBehindWalls)
{
    const Made made = make(with_coefh(half_full_ball(0), "1.3"));
    EXPECT_TRUE(contains(made.output, "most stable under pressure")) << made.output;
    double farthest = 0;
    for (const Vec3& p : fluid_of(made.cloud)) farthest = std::max(farthest, norm(p));
    EXPECT_LT(farthest, 0.99);
}

TEST(StablePacking, HasTwelveNeighboursOrMoreIn3D)
{
    const Vec3 inside{1.6, 1.5, 2.4};
    const Made packed = make(tank(inside, water(0, inside, 0, 2.1), ""));
    EXPECT_TRUE(contains(packed.output, "most stable under pressure")) << packed.output;
    const std::vector<Vec3> places = fluid_of(packed.cloud);
    // The nearest are at 1.12 dp, the next ones at 1.59, of a cubic lattice at 1 and 1.41. Where
    // the lattice is strained to fit, some of the next ones come nearer.
    const std::map<int, int> counts = neighbours_in_the_midst(places, 1.35 * dp);
    EXPECT_GE(counts.begin()->first, 12);
    EXPECT_GT(counts.at(12), 50);
    EXPECT_GT(nearest_pair(places), 0.55 * dp);
}

// Every second row of a net stood a quarter of a step from the wall, and was pressed against it.
TEST(StablePacking, HasStraightRowsAlongUprightWalls)
{
    const Vec3 inside{1.6, 1.6, 2.4};
    CaseText text = tank(inside, water(0, inside, 0, 2.1), "");
    text.execution = modified_boundaries;
    const Made packed = make(text);
    EXPECT_TRUE(contains(packed.output, "most stable under pressure")) << packed.output;
    int in_first_row = 0, between = 0;
    for (const Vec3& p : fluid_of(packed.cloud))
    {
        if (std::abs(p.z - 0.8) > 0.5 || std::abs(p.y - 0.8) > 0.4) continue;
        const double off = std::min(p.x, inside.x - p.x);
        in_first_row += off > 0.3 * dp && off < 0.6 * dp ? 1 : 0;
        between += off < 0.3 * dp || (off > 0.6 * dp && off < 0.95 * dp) ? 1 : 0;
    }
    EXPECT_GT(in_first_row, 80);
    EXPECT_LT(between, 8);
}

// Modified boundaries take their pressures from the fluid, which had those of its places before.
TEST(StablePacking, IsPushedByWallsFromTheFirstStepOn)
{
    const Vec3 inside{1.6, 1.6, 2.4};
    CaseText text = tank(inside, water(0, inside, 0, 2.1), "");
    text.execution = modified_boundaries;
    const Made packed = make(text);
    EXPECT_LT(number_after(packed.output, "before: mean "), 0.35) << packed.output; // was 0.52
}

// The space of the fluid ended half a dp beyond its nodes, not at the walls, and its midst fell:
// what was left of gravity before the first step was 0.25 g on average, and 0.48 g around a column.
TEST(StablePacking, FillsTheSpaceBetweenFlatWalls)
{
    for (const bool has_column : {false, true})
    {
        const Vec3 inside = has_column ? Vec3{1.64, 1.57, 2.4} : Vec3{1.6, 1.6, 2.4};
        CaseText text = tank(inside, water(0, inside, 0, 2.1), "");
        if (has_column)
            text.mainlist += R"(<setmkbound mk="1" /><drawcylinder radius="0.4">)"
                             R"(<point x="0.82" y="0.785" z="-0.2" />)"
                             R"(<point x="0.82" y="0.785" z="2.4" /></drawcylinder>)";
        text.execution = modified_boundaries;
        const Made packed = make(text);
        EXPECT_TRUE(contains(packed.output, "most stable under pressure")) << packed.output;
        EXPECT_LT(number_after(packed.output, "before: mean "), has_column ? 0.32 : 0.15)
            << packed.output;
    }
}

// With no more than 1 dp from the lattice, particles kept 0.03 g along the border of the surface.
TEST(StablePacking, ComesToRestInAHalfFullBall)
{
    const Made made = make(half_full_ball(1.59));
    EXPECT_TRUE(contains(made.output, "most stable under pressure")) << made.output;
    EXPECT_LT(number_after(made.output, "accelerations: mean "), 0.001) << made.output;
}

// No lattice is at rest with a cubic spline on a long beach. The calmer one is taken; it was the
// cubic one whenever the other kept more than 0.01 g.
TEST(StablePacking, IsTakenWhereItIsTheCalmerOfTwoThatMove)
{
    CaseText text;
    text.dp = "0.02";
    text.pointmin = R"(<pointmin x="-0.2" y="0" z="-0.2" />)";
    text.pointmax = R"(<pointmax x="10.2" y="0" z="1.8" />)";
    text.mainlist =
        R"(<setdrawmode mode="full" /><setmkbound mk="0" /><drawbox><boxfill>bottom | left | right</boxfill><point x="0" y="-0.05" z="0" /><size x="10" y="0.1" z="1.65" /></drawbox>
<drawprism><point x="1" y="-0.1" z="0" /><point x="10" y="-0.1" z="0" /><point x="10" y="-0.1" z="0.9" /><point x="1" y="0.1" z="0" /><point x="10" y="0.1" z="0" /><point x="10" y="0.1" z="0.9" /></drawprism>
<setmkfluid mk="0" /><fillbox x="1" y="0" z="0.33"><modefill>void</modefill><point x="-0.1" y="-0.05" z="-0.1" /><size x="10.2" y="0.1" z="1.2" /></fillbox>)";
    text.execution = R"(<parameters><parameter key="Kernel" value="1" /></parameters>)";
    text = with_coefh(text, "1.2");
    const auto left = [&](const std::string& band)
    {
        text.after_geometry = "<fppg><bodyfitted />" + band + "</fppg>";
        return number_after(make(text).output, ": mean ");
    };
    EXPECT_LT(left(""), 0.9 * left(cubic));
}

TEST(StablePacking, KeepsEachFluidWithItsNumberInItsPlace)
{
    const Vec3 inside{2.4, 0, 3};
    const std::string fluid = water(0, inside, 0, 1.2) + water(1, inside, 1.3, 2.4);
    const Made packed = make(tank(inside, fluid, ""));
    EXPECT_TRUE(contains(packed.output, "most stable under pressure")) << packed.output;
    EXPECT_EQ(packed.cloud.mk, make(tank(inside, fluid, cubic)).cloud.mk);
    for (std::size_t i = 0; i < packed.cloud.positions.size(); ++i)
    {
        const double z = packed.cloud.positions[i].z;
        if (packed.cloud.mk[i] >= first_bound) continue;
        const bool is_lower = packed.cloud.mk[i] == 1;
        EXPECT_LT(is_lower ? z : 2.5 - z, 1.25 + dp) << "mk " << packed.cloud.mk[i];
    }
}

TEST(StablePacking, KeepsTheLevelsOfPartedWater)
{
    const Vec3 inside{4, 0, 3};
    const std::string fluid =
        R"(<setmkbound mk="1" />)" +
        box_command(R"(x="1.8" y="-1" z="-0.1")", R"(x="0.4" y="2" z="3.2")") +
        R"(<setmkfluid mk="0" />)" +
        box_command(R"(x="0" y="-1" z="0")", R"(x="1.7" y="2" z="2.5")") +
        box_command(R"(x="2.3" y="-1" z="0")", R"(x="1.7" y="2" z="1.2")");
    const auto counts = [](const ParticleCloud& cloud)
    {
        std::map<bool, std::pair<int, double>> out; // number and highest
        for (const Vec3& p : fluid_of(cloud))
        {
            auto& [number, highest] = out[p.x > 2];
            ++number;
            highest = std::max(highest, p.z);
        }
        return out;
    };
    const Made made = make(tank(inside, fluid, ""));
    EXPECT_TRUE(contains(made.output, "most stable under pressure")) << made.output;
    const auto packed = counts(made.cloud);
    const auto square = counts(make(tank(inside, fluid, cubic)).cloud);
    for (const bool side : {false, true})
    {
        EXPECT_EQ(packed.at(side).first, square.at(side).first);
        EXPECT_NEAR(packed.at(side).second, square.at(side).second, dp / 2);
    }
}

TEST(StablePacking, IsNotDoneToWaterThatFallsOrIsShallow)
{
    const Vec3 inside{4, 0, 3};
    const std::string column = R"(<setmkfluid mk="0" />)" +
                               box_command(R"(x="0" y="-1" z="0")", R"(x="1.5" y="2" z="2.5")");
    const Made falls = make(tank(inside, column, ""));
    EXPECT_TRUE(contains(falls.output, "Balanced fluid"));
    EXPECT_FALSE(contains(falls.output, "most stable under pressure"));
    const Made shallow = make(tank(inside, water(0, inside, 0, 0.25), ""));
    EXPECT_FALSE(contains(shallow.output, "most stable under pressure"));
}

TEST(StablePacking, KeepsTheNumberOfSmallBodiesToo)
{
    for (const double width : {0.5, 0.6, 0.7, 0.8})
        for (const double depth : {0.4, 0.5, 0.7})
        {
            const Vec3 inside{width, 0, 1};
            const std::string fluid = water(0, inside, 0, depth);
            const ParticleCloud packed = make(tank(inside, fluid, "")).cloud;
            EXPECT_EQ(packed.mk, make(tank(inside, fluid, cubic)).cloud.mk);
            EXPECT_GT(nearest_pair(fluid_of(packed)), 0.5 * dp) << width << ' ' << depth;
        }
}

TEST(StablePacking, IsTheSameWithAnyNumberOfThreads)
{
    const Vec3 inside{1.6, 1.5, 1.9};
    const CaseText text = tank(inside, water(0, inside, 0, 1.6), "");
    EXPECT_EQ(make(text, {"-threads:1"}).bytes, make(text, {"-threads:3"}).bytes);
}
