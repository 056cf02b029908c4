// Fluid beside body-fitted walls, on the lattice, relaxed or balanced: where it stands and how it
// is numbered; FPPG_PROGRAM is the program's path.

#include "fppg/read_particles.h"

#include "helpers/case_text.h"
#include "helpers/run_fppg.h"

#include <gtest/gtest.h>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>
#include <utility>

namespace
{

using fppg::ParticleCloud;
using fppg::Vec3;
using namespace fppg::test;

constexpr double dp = 0.05;
constexpr double sphere_radius = 0.23;
const Vec3 sphere_center{0.51, 0.5, 0.45};
constexpr std::uint16_t bound_mk = 10; ///< of mkbound 0

struct Made
{
    std::string output;
    ParticleCloud cloud;
};

/// A tank with water and a solid sphere of mkbound 1 under it, with this in its <fppg> block.
CaseText sphere_in_tank(const std::string& fppg)
{
    CaseText text = tank();
    text.dp = fmt::format("{}", dp);
    text.mainlist += fmt::format(
        R"(<setdrawmode mode="full" /><setmkbound mk="1" /><drawsphere radius="{}"><point x="{}" y="{}" z="{}" /></drawsphere>)",
        sphere_radius, sphere_center.x, sphere_center.y, sphere_center.z);
    text.after_geometry = "<fppg>" + fppg + "</fppg>";
    return text;
}

Made make(const CaseText& text)
{
    const TemporaryFolder folder;
    write_text(folder / "Case_Def.xml", text.text());
    const RunResult result = run(folder, {"Case_Def", "out/Case", "-save:all"});
    EXPECT_EQ(result.code, 0) << result.output;
    return {result.output, fppg::read_particles(folder / "out/Case", false, 1)};
}

Made make_sphere_in_tank(const std::string& fppg)
{
    return make(sphere_in_tank(fppg));
}

bool is_fluid(const ParticleCloud& cloud, std::size_t i)
{
    return cloud.mk[i] < bound_mk;
}

/// Least distance from the fluid to the sphere, dp.
double nearest_fluid_dp(const ParticleCloud& cloud)
{
    double nearest = 1e9;
    std::size_t count = 0;
    for (std::size_t i = 0; i < cloud.positions.size(); ++i)
    {
        if (!is_fluid(cloud, i)) continue;
        ++count;
        nearest =
            std::min(nearest, (norm(cloud.positions[i] - sphere_center) - sphere_radius) / dp);
    }
    EXPECT_GT(count, 1000u);
    return nearest;
}

/// Particles that do not come after the one before them in their block by x, then y, then z.
std::size_t unsorted(const ParticleCloud& cloud, bool counts_fluid)
{
    std::size_t count = 0;
    for (std::size_t i = 1; i < cloud.positions.size(); ++i)
    {
        const Vec3& a = cloud.positions[i - 1];
        const Vec3& b = cloud.positions[i];
        if (cloud.mk[i] != cloud.mk[i - 1] || (is_fluid(cloud, i) && !counts_fluid)) continue;
        count += std::tie(a.x, a.y, a.z) < std::tie(b.x, b.y, b.z) ? 0 : 1;
    }
    return count;
}

TEST(FluidBesideASphere, StandsHalfAStepAwayWhereItIsNotBalanced)
{
    for (const std::string band :
         {R"(<fluidband active="false" />)", R"(<fluidband balance="false" />)"})
        EXPECT_GE(nearest_fluid_dp(make_sphere_in_tank("<bodyfitted />" + band).cloud), 0.49)
            << band;
}

/// Pressures of walls hold it at a distance; the rule is the least one.
TEST(FluidBesideASphere, StandsHalfAStepAwayWhereItIsBalanced)
{
    const Made made = make_sphere_in_tank(R"(<bodyfitted layers="3" />)");
    EXPECT_TRUE(contains(made.output, "Balanced fluid: ")) << made.output;
    EXPECT_GE(nearest_fluid_dp(made.cloud), 0.5 - 1e-6);
}

/// Fluid that is balanced keeps the ids that it had.
TEST(FluidBesideASphere, IsNumberedByXThenYThenZUnlessItIsBalanced)
{
    const std::string walls = R"(<bodyfitted layers="3" />)";
    const Made even = make_sphere_in_tank(walls + R"(<fluidband balance="false" />)");
    EXPECT_EQ(unsorted(even.cloud, true), 0u);
    const Made balanced = make_sphere_in_tank(walls + "<fluidband />");
    EXPECT_EQ(unsorted(balanced.cloud, false), 0u);
    EXPECT_EQ(balanced.cloud.mk, even.cloud.mk);
}

/// The corner of a ledge of sheets is 0.12 dp beyond a row of nodes, 0.54 dp from the first layer
/// behind it: nothing but the wall was there to keep fluid out.
TEST(FluidBesideALedge, StaysOutOfTheCorner)
{
    for (const bool is_2d : {true, false})
    {
        const std::string y = is_2d ? R"(y="-0.25")" : R"(y="0")";
        CaseText text;
        text.dp = fmt::format("{}", dp);
        text.pointmin = fmt::format(R"(<pointmin x="-0.3" y="{}" z="-0.3" />)", is_2d ? 0 : -0.3);
        text.pointmax = fmt::format(R"(<pointmax x="1.8" y="{}" z="1.3" />)", is_2d ? 0 : 0.8);
        const auto faces = [&](const std::string& fill, const std::string& size)
        {
            return fmt::format(
                R"(<drawbox><boxfill>{}</boxfill><point x="0" {} z="0" /><size {} /></drawbox>)",
                fill, y, size);
        };
        text.mainlist =
            R"(<setdrawmode mode="full" /><setmkbound mk="0" />)" +
            faces(is_2d ? "bottom | left | right" : "bottom | left | right | front | back",
                  R"(x="1.5" y="0.5" z="1")") +
            R"(<setmkbound mk="1" />)" + faces("top | right", R"(x="0.506" y="0.5" z="0.256")") +
            fmt::format(
                R"(<setmkfluid mk="0" /><fillbox x="1" y="{}" z="0.5"><modefill>void</modefill><point x="0" {} z="0" /><size x="1.5" y="0.5" z="0.75" /></fillbox>)",
                is_2d ? 0 : 0.25, y);
        text.after_geometry = R"(<fppg><bodyfitted /><fluidband active="false" /></fppg>)";
        text.execution =
            R"(<parameters><parameter key="Boundary" value="2" /><parameter key="SlipMode" value="2" /><parameter key="NoPenetration" value="1" /></parameters>)";
        const ParticleCloud cloud = make(text).cloud;
        std::size_t fluid = 0;
        for (std::size_t i = 0; i < cloud.positions.size(); ++i)
        {
            if (!is_fluid(cloud, i)) continue;
            ++fluid;
            const Vec3& p = cloud.positions[i];
            EXPECT_FALSE(p.x < 0.506 && p.z < 0.256) << p.x << ' ' << p.y << ' ' << p.z;
        }
        EXPECT_GT(fluid, 200u);
    }
}

/// How many fluid particles are off the lattice: where is_strip says so, and elsewhere.
template <typename IsStrip>
std::pair<std::size_t, std::size_t> off_lattice(const ParticleCloud& cloud, const IsStrip& is_strip)
{
    std::pair<std::size_t, std::size_t> counts;
    for (std::size_t i = 0; i < cloud.positions.size(); ++i)
    {
        if (!is_fluid(cloud, i)) continue;
        const Vec3 at = cloud.positions[i] / dp;
        const auto off = [](double x) { return std::abs(x - std::round(x)) > 1e-4; };
        if (off(at.x) || off(at.y) || off(at.z))
            ++(is_strip(cloud.positions[i], cloud.mk[i]) ? counts.first : counts.second);
    }
    return counts;
}

// The solver goes on with fluid on the lattice at these places; 2h is 0.1732 m.
constexpr double strip = 0.173;
const std::string layers = R"(<bodyfitted layers="3" />)";

/// The gap to a box of 0.6 x 0.4 m across x at x = 0.7.
bool is_at_zone(const Vec3& p)
{
    const Vec3 gap{p.x - 0.7, std::max({0.2 - p.y, p.y - 0.8, 0.0}),
                   std::max({0.1 - p.z, p.z - 0.5, 0.0})};
    return norm(gap) < strip;
}

TEST(FluidBesideASphere, StaysOnTheLatticeWhereAZoneLetsFluidIn)
{
    CaseText text = sphere_in_tank(layers);
    text.execution +=
        R"(<special><inout><inoutzone><zone3d><box><point x="0.7" y="0.2" z="0.1" /><size x="0" y="0.6" z="0.4" />)"
        R"(<direction x="1" y="0" z="0" /></box></zone3d></inoutzone></inout></special>)";
    const auto [at_zone, elsewhere] =
        off_lattice(make(text).cloud, [](const Vec3& p, int) { return is_at_zone(p); });
    EXPECT_EQ(at_zone, 0u);
    EXPECT_GT(elsewhere, 500u);
}

TEST(FluidBesideASphere, StaysOnTheLatticeWhereItsParticlesAreAZone)
{
    CaseText text = sphere_in_tank(layers);
    text.mainlist += R"(<setmkfluid mk="1" />)" +
                     box_command(R"(x="0.65" y="0.2" z="0.1")", R"(x="0.05" y="0.6" z="0.4")");
    text.execution +=
        R"(<special><inout><inoutzone><zone3d><particles mkfluid="1" direction="right" /></zone3d></inoutzone></inout></special>)";
    const auto [at_zone, elsewhere] = off_lattice(
        make(text).cloud, [](const Vec3& p, int mk) { return mk == 2 || is_at_zone(p); });
    EXPECT_EQ(at_zone, 0u);
    EXPECT_GT(elsewhere, 300u);
}

TEST(FluidBesideASphere, StaysOnTheLatticeAtTheEndsOfAPeriod)
{
    CaseText text = sphere_in_tank(layers);
    text.pointmin = R"(<pointmin x="-0.5" y="0.15" z="-0.5" />)";
    text.pointmax = R"(<pointmax x="1.5" y="0.8" z="1.5" />)";
    text.execution =
        R"(<parameters><parameter key="TimeMax" value="1" /><parameter key="YPeriodicIncX" value="0" /></parameters>)";
    const auto [at_ends, elsewhere] =
        off_lattice(make(text).cloud,
                    [](const Vec3& p, int) { return p.y < 0.125 + strip || p.y > 0.825 - strip; });
    EXPECT_EQ(at_ends, 0u);
    EXPECT_GT(elsewhere, 100u);
}

TEST(FluidBesideASphere, IsWarnedOfWhereAZoneCannotBePlaced)
{
    CaseText text = sphere_in_tank(layers);
    text.execution +=
        R"(<special><inout><inoutzone><zone3d><torus /></zone3d></inoutzone></inout></special>)";
    const Made made = make(text);
    EXPECT_TRUE(contains(made.output, "<inoutzone>: where it lets fluid in or out is not known"))
        << made.output;
}

/// Water 0.8 m high in a tank turned by 25 degrees, one of whose walls leans over it (2D).
CaseText leaning_tank(const std::string& band)
{
    CaseText text;
    text.dp = "0.025";
    text.pointmin = R"(<pointmin x="-2" y="0" z="-1" />)";
    text.pointmax = R"(<pointmax x="2" y="0" z="2" />)";
    const auto box = [](const std::string& name, const std::string& low, const std::string& size)
    {
        return R"(<drawbox fppg:name=")" + name + R"("><boxfill>solid</boxfill><point )" + low +
               " /><size " + size + " /></drawbox>";
    };
    text.mainlist =
        R"(<setdrawmode mode="full" /><rotate ang="25" x="0" y="1" z="0" /><setmkbound mk="0" />)" +
        box("outer", R"(x="-0.2" y="-1" z="-0.2")", R"(x="1.4" y="2" z="1.4")") +
        box("inner", R"(x="0" y="-1" z="0")", R"(x="1" y="2" z="3")") + "<matrixreset />";
    text.after_geometry =
        R"(<fppg><bodyfitted layers="2" boundary="mdbc" />)" + band +
        R"(<boolean op="difference"><part ref="outer" /><part ref="inner" /></boolean>)"
        R"(<fill mkfluid="0" seed="0.2,0,0.6" level="0.8" /></fppg>)";
    text.execution =
        R"(<parameters><parameter key="Boundary" value="2" /><parameter key="SlipMode" value="2" /><parameter key="NoPenetration" value="1" /></parameters>)";
    return text;
}

/// Relaxed fluid stays at its level, balanced fluid comes a quarter of dp above it at most; before,
/// one particle was pushed out 1.6 dp high, between the surface and the wall.
TEST(FluidUnderALeaningWall, KeepsItsLevel)
{
    const auto highest = [](const ParticleCloud& cloud)
    {
        double out = -1e9;
        for (std::size_t i = 0; i < cloud.positions.size(); ++i)
            if (is_fluid(cloud, i)) out = std::max(out, cloud.positions[i].z);
        return out;
    };
    EXPECT_NEAR(highest(make(leaning_tank(R"(<fluidband balance="false" />)")).cloud), 0.8, 1e-6);
    EXPECT_LE(highest(make(leaning_tank("<fluidband />")).cloud), 0.8 + 0.2501 * 0.025);
    EXPECT_LE(highest(make(leaning_tank("")).cloud), 0.8 + 0.2501 * 0.025);
}

/// A tank of one of the shapes that can have layers, with fluid.
CaseText shell_with_fluid(const std::string& shape, const std::string& shells,
                          const std::string& fppg)
{
    CaseText text = tank();
    text.dp = fmt::format("{}", dp);
    text.mainlist =
        R"(<setdrawmode mode="face" /><setmkbound mk="0" />)" +
        fmt::format(fmt::runtime(shape), shells) +
        R"(<setmkfluid mk="0" /><fillbox x="0.51" y="0.5" z="0.4"><modefill>void</modefill>
<point x="-1" y="-1" z="-1" /><size x="4" y="4" z="1.5" /></fillbox>)";
    text.after_geometry = "<fppg>" + fppg + "</fppg>";
    return text;
}

class ShellOfACase : public testing::TestWithParam<std::string>
{
};

TEST_P(ShellOfACase, IsDrawnOnceWhereWallsHaveLayersOfTheirOwn)
{
    const std::string mdbc = R"(<bodyfitted boundary="mdbc" />)";
    const Made bare = make(shell_with_fluid(GetParam(), "", mdbc));
    const std::string shells = R"(<layers vdp="0,1,2" />)";
    const Made made = make(shell_with_fluid(GetParam(), shells, mdbc));
    EXPECT_EQ(made.cloud.positions, bare.cloud.positions);
    EXPECT_EQ(made.cloud.mk, bare.cloud.mk);
    EXPECT_TRUE(contains(made.output, "<layers vdp> of the shapes of line")) << made.output;
    EXPECT_FALSE(contains(bare.output, "<layers vdp>")) << bare.output;
    // Sheets on the surface are those that the case draws.
    const Made sheets = make(shell_with_fluid(GetParam(), shells, "<bodyfitted />"));
    const Made sheet = make(shell_with_fluid(GetParam(), "", R"(<bodyfitted layers="1" />)"));
    EXPECT_GT(std::count_if(sheets.cloud.mk.begin(), sheets.cloud.mk.end(),
                            [](std::uint16_t mk) { return mk == bound_mk; }),
              2 * std::count_if(sheet.cloud.mk.begin(), sheet.cloud.mk.end(),
                                [](std::uint16_t mk) { return mk == bound_mk; }));
    EXPECT_FALSE(contains(sheets.output, "<layers vdp>")) << sheets.output;
}

INSTANTIATE_TEST_SUITE_P(
    Of, ShellOfACase,
    testing::Values(
        R"(<drawbox><boxfill>bottom | left | right | front | back</boxfill><point x="0.02" y="0.01" z="0.03" /><size x="0.9" y="0.8" z="0.8" />{}</drawbox>)",
        R"(<drawsphere radius="0.43"><point x="0.51" y="0.5" z="0.45" />{}</drawsphere>)",
        R"(<drawcylinder radius="0.43"><point x="0.51" y="0.5" z="0.05" /><point x="0.51" y="0.5" z="0.85" />{}</drawcylinder>)",
        R"(<drawextrude closed="true"><extrude x="0" y="0.8" z="0" /><point x="0.1" y="0.1" z="0.05" /><point x="0.9" y="0.1" z="0.05" /><point x="0.9" y="0.1" z="0.8" /><point x="0.1" y="0.1" z="0.8" />{}</drawextrude>)"));

/// Walls of a tank so far outside it, metres.
std::string open_box(double off)
{
    return fmt::format(
        R"(<drawbox><boxfill>bottom | left | right | front | back</boxfill><point x="{0}" y="{0}" z="{0}" /><size x="{1}" y="{1}" z="0.8" /></drawbox>)",
        0.02 - off, 0.9 + 2 * off);
}

const std::string mdbc = R"(<bodyfitted boundary="mdbc" />)";

/// A tank whose walls are thickened shell by shell, or that is divided by a sheet.
TEST(ShellsOfACase, ThatStandAmongTheLayersOfAnotherAreLeftOut)
{
    const std::string sheet =
        R"(<drawbox><boxfill>left</boxfill><point x="0.4" y="0.02" z="0.02" /><size x="0.1" y="0.9" z="0.2" /></drawbox>)";
    const std::string said = "stands among the layers of <drawbox>";
    const Made bare = make(shell_with_fluid(open_box(0), "", mdbc));
    for (const double off : {dp, 2 * dp})
        for (const bool is_inner_first : {false, true})
        {
            const std::string both =
                is_inner_first ? open_box(0) + open_box(off) : open_box(off) + open_box(0);
            const Made made = make(shell_with_fluid(both, "", mdbc));
            EXPECT_TRUE(contains(made.output, said)) << off;
            EXPECT_EQ(made.cloud.positions, bare.cloud.positions) << off;
        }
    EXPECT_FALSE(contains(make(shell_with_fluid(open_box(0) + sheet, "", mdbc)).output, said));
    EXPECT_FALSE(
        contains(make(shell_with_fluid(open_box(0) + open_box(5 * dp), "", mdbc)).output, said));
    // Under dynamic boundaries they are all that the wall has.
    const std::string two = open_box(0) + open_box(dp);
    const Made dbc = make(shell_with_fluid(two, "", "<bodyfitted />"));
    EXPECT_FALSE(contains(dbc.output, said));
    EXPECT_EQ(dbc.cloud.positions,
              make(shell_with_fluid(two, "", R"(<bodyfitted layers="1" />)")).cloud.positions);
}

/// As cases draw the surface for their normals, to take it away again.
TEST(WallsThatAVoidTakesAway, LeaveNothingThatFluidMinds)
{
    const std::string drawn =
        open_box(-0.5 * dp) + R"(<setmkvoid /><redraw /><setmkbound mk="0" />)";
    const Made bare = make(shell_with_fluid(open_box(0), "", mdbc));
    const Made made = make(shell_with_fluid(drawn + open_box(0), "", mdbc));
    EXPECT_EQ(made.cloud.positions, bare.cloud.positions);
}

/// A step beside the walls there is no node, but in the lattice that moves by half a step there is.
TEST(FluidBeforeAPiston, DoesNotComeBehindItThroughAGapOfAStep)
{
    const std::string piston =
        R"(<setdrawmode mode="full" /><setmkbound mk="1" /><drawbox><boxfill>solid</boxfill><point x="0.2" y="0.05" z="0.05" /><size x="0.15" y="0.8" z="0.9" /></drawbox>)";
    const std::string walls =
        R"(<drawbox><boxfill>bottom | left | right | front | back</boxfill><point x="0" y="0" z="0" /><size x="0.9" y="0.9" z="0.9" /></drawbox>)";
    const Made made = make(shell_with_fluid(walls + piston, "", mdbc));
    EXPECT_TRUE(contains(made.output, "Lattice moved by")) << made.output;
    std::size_t behind = 0;
    std::size_t before = 0;
    for (std::size_t i = 0; i < made.cloud.positions.size(); ++i)
        if (is_fluid(made.cloud, i)) ++(made.cloud.positions[i].x < 0.2 ? behind : before);
    EXPECT_EQ(behind, 0u);
    EXPECT_GT(before, 1500u);
}

/// A channel that is drawn shorter than its domain, as in public Poiseuille flows. Its walls bent
/// around their ends, and fluid went into the gaps where copies of the case meet.
TEST(WallsOfAPeriod, GoOnOverItsEnds)
{
    CaseText text;
    text.dp = fmt::format("{}", dp);
    text.pointmin = R"(<pointmin x="-0.2" y="0" z="-1" />)";
    text.pointmax = R"(<pointmax x="3" y="0" z="1" />)";
    text.mainlist =
        R"(<setdrawmode mode="full" /><setmkfluid mk="0" /><drawbox><boxfill>solid</boxfill><point x="0" y="0" z="-0.45" /><size x="1" y="0" z="0.9" /></drawbox>
<setmkbound mk="0" /><drawbox><boxfill>solid</boxfill><point x="0" y="0" z="0.5" /><size x="1" y="0" z="0.2" /></drawbox>
<drawbox><boxfill>solid</boxfill><point x="0" y="0" z="-0.7" /><size x="1" y="0" z="0.2" /></drawbox>)";
    for (const char* boundary : {"1", "2"})
    {
        text.execution = fmt::format(
            R"(<parameters><parameter key="Boundary" value="{}" /><parameter key="XPeriodicIncZ" value="0" /></parameters>)",
            boundary);
        text.after_geometry = "<fppg><bodyfitted /></fppg>";
        const Made made = make(text);
        EXPECT_NE(made.output.find("Period: as far as the case is drawn, from (0, 0, -1) m"),
                  std::string::npos)
            << made.output;
        EXPECT_NE(made.output.find("goes on over the period along x"), std::string::npos);
        // Of DBC those on the surface: nodes under it make room for its ends.
        const double deepest = boundary[0] == '1' ? 0.501 : 1;
        std::map<int, std::vector<double>> rows; // by their height, mm
        for (std::size_t i = 0; i < made.cloud.positions.size(); ++i)
        {
            const Vec3& p = made.cloud.positions[i];
            if (!is_fluid(made.cloud, i) && std::abs(p.z) < deepest)
                rows[static_cast<int>(std::lround(1000 * p.z))].push_back(p.x);
        }
        EXPECT_EQ(rows.size(), boundary[0] == '1' ? 2U : 8U);
        for (auto& [height, row] : rows)
        {
            EXPECT_EQ(row.size(), 21U) << height;
            std::sort(row.begin(), row.end());
            double widest = row.front() + 21 * dp - row.back();
            for (std::size_t i = 1; i < row.size(); ++i)
                widest = std::max(widest, row[i] - row[i - 1]);
            EXPECT_LT(widest / dp, 1.2) << height;
        }
    }
}

} // namespace
