// Rows of particles that close narrow gaps between walls in layers.

#include "balance/made_case.h"

#include "fppg/moving_parts.h"

#include "meshes/point_grid.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

namespace
{

using namespace fppg::test;
using fppg::Vec3;

constexpr double dp = 0.02;

std::string box(const char* point, const char* size)
{
    return fmt::format("<drawbox><boxfill>solid</boxfill><point {} /><size {} /></drawbox>\n",
                       point, size);
}

/// A tank 1 m long in 2D with water 0.4 m deep up to `end`, with a part of mkbound 1.
CaseText tank_with(const std::string& part, double end, const std::string& motion = "")
{
    CaseText out;
    out.dp = fmt::format("{}", dp);
    out.pointmin = R"(<pointmin x="-0.2" y="0" z="-0.2" />)";
    out.pointmax = R"(<pointmax x="1.2" y="0" z="0.8" />)";
    out.mainlist =
        R"(<setdrawmode mode="full" /><setmkfluid mk="0" />)" +
        box(R"(x="0" y="-1" z="0")", fmt::format(R"(x="{}" y="2" z="0.4")", end).c_str()) +
        R"(<setmkbound mk="0" />)" +
        box(R"(x="-0.08" y="-1" z="-0.08")", R"(x="1.16" y="2" z="0.08")") +
        box(R"(x="-0.08" y="-1" z="0")", R"(x="0.08" y="2" z="0.6")") +
        box(R"(x="1" y="-1" z="0")", R"(x="0.08" y="2" z="0.6")") + R"(<setmkbound mk="1" />)" +
        part;
    out.after_geometry = motion + "<fppg><bodyfitted /></fppg>";
    out.execution =
        R"(<parameters><parameter key="Boundary" value="2" /><parameter key="SlipMode" value="2" /><parameter key="NoPenetration" value="1" /></parameters>)";
    return out;
}

/// Particles of a mk, or of all fluid, in a box.
std::vector<Vec3> places_in(const MadeCase& made, bool is_fluid, const Vec3& low, const Vec3& high)
{
    std::vector<Vec3> out;
    for (std::size_t i = 0; i < made.cloud.positions.size(); ++i)
    {
        const Vec3& p = made.cloud.positions[i];
        if ((made.cloud.mk[i] < first_bound) == is_fluid && p.x > low.x && p.x < high.x &&
            p.z > low.z && p.z < high.z)
            out.push_back(p);
    }
    return out;
}

/// What balancing leaves on the mean, over gravity.
double mean_left(const std::string& output)
{
    const std::size_t at = output.find("mean ", output.find("accelerations"));
    return at == std::string::npos ? 1e9 : std::stod(output.substr(at + 5));
}

/// A block stands `width` dp before the wall, 12 dp high in water 20 dp deep.
MadeCase block_before_wall(const TemporaryFolder& folder, double width)
{
    return make(folder,
                tank_with(box(fmt::format(R"(x="{}" y="-1" z="0")", 0.8 - width * dp).c_str(),
                              R"(x="0.2" y="2" z="0.24")"),
                          1));
}

TEST(GapRows, CloseASlotBesideABlock)
{
    const TemporaryFolder folder;
    for (const double width : {0.3, 0.5, 0.59})
    {
        SCOPED_TRACE(width);
        const MadeCase made = block_before_wall(folder, width);
        const Vec3 low{1 - width * dp, 0, 0}, high{1, 0, 0.24};
        EXPECT_EQ(places_in(made, true, low, high).size(), 0U);
        EXPECT_NEAR(static_cast<double>(places_in(made, false, low, high).size()), 12, 1);
        EXPECT_TRUE(contains(made.output, "close the gap between mkbound 0 and mkbound 1"));
        EXPECT_LT(mean_left(made.output), 0.003);
    }
    const MadeCase narrow = block_before_wall(folder, 0.15);
    EXPECT_FALSE(contains(narrow.output, "close the gap")) << "the layers are near enough";
    const MadeCase wide = block_before_wall(folder, 0.8);
    EXPECT_FALSE(contains(wide.output, "close the gap"));
    EXPECT_GT(places_in(wide, true, {1 - 0.8 * dp, 0, 0}, {1, 0, 0.24}).size(), 8U)
        << "there is water in it";
}

TEST(GapRows, KeepOffOtherParticles)
{
    const TemporaryFolder folder;
    // Round, so that the gap grows from nothing to where water stands.
    const MadeCase made = make(
        folder,
        tank_with(
            R"(<drawcylinder radius="0.12"><point x="0.5" y="-1" z="0.12" /><point x="0.5" y="1" z="0.12" /></drawcylinder>)",
            1));
    fppg::PointGrid grid(dp, 0);
    for (const Vec3& p : made.cloud.positions) grid.add(p);
    double least = dp;
    for (const Vec3& p : made.cloud.positions)
        grid.for_each_near(p, dp,
                           [&](std::uint32_t, double squared)
                           {
                               if (squared > 0) least = std::min(least, std::sqrt(squared));
                           });
    EXPECT_GT(least, 0.55 * dp);
    EXPECT_LT(mean_left(made.output), 0.004);
}

/// 1 dp over the floor, water on one side.
std::string gate()
{
    return box(R"(x="0.5" y="-1" z="0.02")", R"(x="0.06" y="2" z="0.58")");
}

TEST(GapRows, CloseTheGapUnderAGate)
{
    const TemporaryFolder folder;
    const MadeCase made = make(
        folder,
        tank_with(
            gate(), 0.5,
            R"(<motion><objreal ref="1"><begin mov="1" start="0.3" /><mvrect id="1" duration="2"><vel x="0" y="0" z="0.1" /></mvrect></objreal></motion>)"));
    EXPECT_TRUE(contains(made.output, "close the gap between mkbound 1 and mkbound 0"));
    EXPECT_FALSE(contains(made.output, "fluid goes through"));
    const Vec3 low{0.5, 0, 0}, high{0.56, 0, 0.02};
    std::size_t rows = 0;
    for (std::size_t i = 0; i < made.cloud.positions.size(); ++i)
    {
        const Vec3& p = made.cloud.positions[i];
        if (p.x < low.x || p.x > high.x || p.z < low.z || p.z > high.z) continue;
        EXPECT_EQ(made.cloud.mk[i], first_bound + 1) << "they move with the gate";
        ++rows;
    }
    EXPECT_EQ(rows, 3U);
    EXPECT_LT(mean_left(made.output), 0.003);
}

TEST(GapRows, LeaveTheGapUnderAFlapAndAFloatingBody)
{
    const TemporaryFolder folder;
    const MadeCase flap = make(
        folder,
        tank_with(
            gate(), 0.5,
            R"(<motion><objreal ref="1"><begin mov="1" start="0.3" /><mvrot id="1" duration="2" anglesunits="degrees"><vel ang="5" /><axisp1 x="0.53" y="0" z="0.5" /><axisp2 x="0.53" y="1" z="0.5" /></mvrot></objreal></motion>)"));
    EXPECT_FALSE(contains(flap.output, "close the gap"));
    EXPECT_TRUE(contains(flap.output, "fluid goes through"));
    const MadeCase floating = make(
        folder,
        tank_with(
            gate(), 0.5,
            R"(<floatings><floating mkbound="1"><massbody value="30" /></floating></floatings>)"));
    EXPECT_FALSE(contains(floating.output, "close the gap"));
}

TEST(GapRows, AreNoneUnderDynamicBoundaries)
{
    const TemporaryFolder folder;
    CaseText text = tank_with(box(R"(x="0.79" y="-1" z="0")", R"(x="0.2" y="2" z="0.24")"), 1);
    text.execution = R"(<parameters><parameter key="Boundary" value="1" /></parameters>)";
    EXPECT_FALSE(contains(make(folder, text).output, "close the gap"));
}

} // namespace
