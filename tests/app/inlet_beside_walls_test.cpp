// Zones of <inout> in body-fitted channels: what the solver accepts of their particles and of the
// fluid beside them; FPPG_PROGRAM is the program's path.

#include "fppg/read_particles.h"

#include "helpers/case_text.h"
#include "helpers/run_fppg.h"

#include <gtest/gtest.h>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace
{

using fppg::ParticleCloud;
using fppg::Vec3;
using namespace fppg::test;

constexpr double dp = 0.02;
constexpr double end = 0.8; ///< of the channel, where fluid goes out
constexpr int bound_mk = 10;
constexpr int fluid_mk = 1, inlet_mk = 2, outlet_mk = 3;
constexpr int rows = 4; ///< that the solver sets behind the particles of a zone

struct Channel
{
    RunResult result;
    ParticleCloud cloud;

    std::vector<Vec3> of(int mk) const
    {
        std::vector<Vec3> out;
        for (std::size_t i = 0; i < cloud.positions.size(); ++i)
            if (cloud.mk[i] == mk) out.push_back(cloud.positions[i]);
        return out;
    }
    std::vector<Vec3> walls() const
    {
        std::vector<Vec3> out;
        for (std::size_t i = 0; i < cloud.positions.size(); ++i)
            if (cloud.mk[i] >= bound_mk) out.push_back(cloud.positions[i]);
        return out;
    }
};

/// A channel from x = -0.16 on, fluid between zones at x = 0 and at its end, as fills leave it: two
/// steps off walls and zones. Zones go up to the last nodes in the channel.
///
/// width     0: 2D
/// boundary  1: DBC, 2: mDBC
Channel make_channel(double width, int boundary)
{
    const bool is_2d = width == 0;
    const double y = is_2d ? -0.1 : dp;
    const double wide = is_2d ? 0.2 : dp * std::floor(width / dp);
    CaseText text;
    text.dp = fmt::format("{}", dp);
    text.pointmin = fmt::format(R"(<pointmin x="-0.3" y="{}" z="-0.1" />)", is_2d ? 0 : -0.1);
    text.pointmax =
        fmt::format(R"(<pointmax x="{}" y="{}" z="0.4" />)", end + 0.3, is_2d ? 0 : width + 0.1);
    const auto box = [](const Vec3& p, const Vec3& size)
    {
        return box_command(fmt::format(R"(x="{}" y="{}" z="{}")", p.x, p.y, p.z),
                           fmt::format(R"(x="{}" y="{}" z="{}")", size.x, size.y, size.z));
    };
    const auto zone = [&](int mk, double x)
    {
        return fmt::format(R"(<setmkfluid mk="{}" />)", mk - 1) +
               box({x, is_2d ? y : dp / 2, dp}, {0, is_2d ? wide : wide - dp / 2, 0.18});
    };
    text.mainlist =
        fmt::format(
            R"(<setdrawmode mode="full" /><setmkbound mk="0" /><drawbox><boxfill>{}</boxfill><point x="-0.16" y="{}" z="0" /><size x="{}" y="{}" z="0.3" /></drawbox>)",
            is_2d ? "bottom" : "bottom | front | back", is_2d ? -0.1 : 0, end + 0.32,
            is_2d ? 0.2 : width) +
        zone(inlet_mk, 0) + zone(outlet_mk, end) +
        fmt::format(
            R"(<setmkfluid mk="0" /><fillbox x="0.4" y="{}" z="0.1"><modefill>void</modefill><point x="{}" y="{}" z="{}" /><size x="{}" y="{}" z="0.18" /></fillbox>)",
            is_2d ? 0 : width / 2, dp, y, dp, end - 2 * dp, wide - dp);
    text.after_geometry = "<fppg><bodyfitted /></fppg>";
    const auto ways = [&](int mk, const char* way)
    {
        return fmt::format(
            R"(<inoutzone><layers value="{0}" /><{1}><particles mkfluid="{2}" direction="{3}" /></{1}></inoutzone>)",
            rows, is_2d ? "zone2d" : "zone3d", mk - 1, way);
    };
    text.execution = fmt::format(
        R"(<special><inout>{}{}</inout></special><parameters><parameter key="Boundary" value="{}" /><parameter key="SlipMode" value="2" /><parameter key="NoPenetration" value="1" /></parameters>)",
        ways(inlet_mk, "right"), ways(outlet_mk, "left"), boundary);
    const TemporaryFolder folder;
    write_text(folder / "Case_Def.xml", text.text());
    Channel out{run(folder, {"Case_Def", "out/Case", "-save:all"}), {}};
    EXPECT_EQ(out.result.code, 0) << out.result.output;
    if (out.result.code == 0) out.cloud = fppg::read_particles(folder / "out/Case", false, 1);
    return out;
}

/// The solver ends with an error where particles of a zone are in no plane, and it takes other
/// fluid out that is nearer than 0.7 dp to them.
void expect_fluid_between_zones(const Channel& channel)
{
    for (const Vec3& p : channel.of(inlet_mk)) EXPECT_NEAR(p.x, 0, 1e-6);
    for (const Vec3& p : channel.of(outlet_mk)) EXPECT_NEAR(p.x, end, 1e-6);
    const std::vector<Vec3> fluid = channel.of(fluid_mk);
    EXPECT_GT(fluid.size(), 300u);
    for (const Vec3& p : fluid)
    {
        EXPECT_GT(p.x, 0.7 * dp) << p.y << ' ' << p.z;
        EXPECT_LT(p.x, end - 0.7 * dp) << p.y << ' ' << p.z;
    }
    double nearest = 1;
    for (std::size_t i = 0; i < fluid.size(); ++i)
        for (std::size_t j = i + 1; j < fluid.size(); ++j)
            nearest = std::min(nearest, norm(fluid[i] - fluid[j]) / dp);
    EXPECT_GT(nearest, 0.45);
}

TEST(InletOfAChannel, KeepsItsParticlesInAPlaneBesideLayers)
{
    expect_fluid_between_zones(make_channel(0.2468, 2));
}

TEST(InletOfAChannel, HasNoFluidBehindIt)
{
    expect_fluid_between_zones(make_channel(0, 1));
    expect_fluid_between_zones(make_channel(0, 2));
}

/// A box of points up to 0.5 dp off the floor: the solver stops there.
TEST(InletGivenByItsShape, IsWarnedOfWhereTheSolverStops)
{
    for (const bool is_fitted : {false, true})
        for (const double above : {0.5, 1.0})
        {
            CaseText text;
            text.dp = fmt::format("{}", dp);
            text.pointmin = R"(<pointmin x="-0.3" y="-0.1" z="-0.1" />)";
            text.pointmax = R"(<pointmax x="0.5" y="0.3" z="0.3" />)";
            text.mainlist =
                R"(<setdrawmode mode="full" /><setmkbound mk="0" /><drawbox><boxfill>bottom</boxfill><point x="-0.2" y="0" z="0" /><size x="0.6" y="0.2" z="0.2" /></drawbox>)"
                R"(<setmkfluid mk="0" />)" +
                box_command(R"(x="0.1" y="0.02" z="0.02")", R"(x="0.2" y="0.16" z="0.1")");
            text.after_geometry = is_fitted ? "<fppg><bodyfitted /></fppg>" : "";
            text.execution = fmt::format(
                R"(<special><inout><inoutzone><layers value="4" /><zone3d><box><point x="0.06" y="0.02" z="{}" /><size x="0" y="0.1" z="0.08" /><direction x="1" y="0" z="0" /></box></zone3d></inoutzone></inout></special><parameters><parameter key="Boundary" value="1" /></parameters>)",
                above * dp);
            const TemporaryFolder folder;
            write_text(folder / "Case_Def.xml", text.text());
            const RunResult result = run(folder, {"Case_Def", "out/Case"});
            EXPECT_EQ(result.code, 0) << result.output;
            EXPECT_EQ(contains(result.output,
                               "of 30 points of this zone, or rows behind them, "
                               "are nearer than 0.7 dp to boundary particles"),
                      above < 0.7)
                << result.output;
        }
}

/// Between layers fluid is half a dp off the floor, and the zones, drawn from the node beside it
/// on, move with the lattice: across, not along their way.
TEST(InletOfAChannel, IsInStepWithTheFloor)
{
    const Channel channel = make_channel(0, 2);
    EXPECT_TRUE(contains(channel.result.output, "Lattice moved by (0, 0, 0.01) m"))
        << channel.result.output;
    expect_fluid_between_zones(channel);
    for (const int mk : {inlet_mk, outlet_mk})
    {
        std::vector<Vec3> zone = channel.of(mk);
        std::sort(zone.begin(), zone.end(), [](const Vec3& a, const Vec3& b) { return a.z < b.z; });
        ASSERT_EQ(zone.size(), 10u);
        for (std::size_t row = 0; row < zone.size(); ++row)
            EXPECT_NEAR(zone[row].z, (static_cast<double>(row) + 0.5) * dp, 1e-9);
    }
    for (const Vec3& p : channel.of(fluid_mk)) EXPECT_GT(p.z, 0.45 * dp);
}

/// The lattice is in step with one side wall; the other is 0.6 dp off the last row of a zone.
TEST(InletOfAChannel, KeepsOffWallsAsTheSolverWants)
{
    const Channel channel = make_channel(0.252, 1);
    const std::vector<Vec3> walls = channel.walls();
    for (const int mk : {inlet_mk, outlet_mk})
    {
        const std::vector<Vec3> zone = channel.of(mk);
        EXPECT_GT(zone.size(), 80u);
        double nearest = 1;
        for (const Vec3& p : zone)
            for (int row = 0; row < rows; ++row)
            {
                const Vec3 at = p + Vec3{(mk == inlet_mk ? -row : row) * dp, 0, 0};
                for (const Vec3& wall : walls) nearest = std::min(nearest, norm(at - wall) / dp);
            }
        EXPECT_GE(nearest, 0.7 - 1e-6);
    }
    EXPECT_TRUE(contains(channel.result.output, "particles of mkfluid 1 are left out"))
        << channel.result.output;
    EXPECT_TRUE(contains(channel.result.output, "nearer than 0.7 dp to a wall"))
        << channel.result.output;
}

} // namespace
