// Fluid that gravity drives through a channel beside fitted walls.

#include "balance/made_case.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace
{

using namespace fppg::test;
using fppg::Vec3;

/// Flow that gravity drives through a period has no depth.
TEST(DrivenFlow, HasOneDensity)
{
    const auto channel = [](const std::string& fppg, const std::string& gravity)
    {
        CaseText text;
        text.pointmin = R"(<pointmin x="0" y="0" z="-0.5" />)";
        text.pointmax = R"(<pointmax x="2" y="0" z="1.5" />)";
        text.gravity = gravity;
        text.mainlist =
            R"(<setdrawmode mode="full" /><setmkbound mk="0" /><drawbox><boxfill>solid</boxfill><point x="0" y="-1" z="-0.4" /><size x="2" y="2" z="1.8" /></drawbox>
<setmkfluid mk="0" /><drawbox><boxfill>solid</boxfill><point x="0" y="-1" z="0" /><size x="2" y="2" z="1" /></drawbox>)";
        text.execution = R"(<parameters><parameter key="XPeriodicIncZ" value="0" /></parameters>)";
        text.after_geometry = fppg;
        return text;
    };
    const auto range = [](const MadeCase& made)
    {
        std::pair<float, float> out{1e9F, 0};
        for (std::size_t i = 0; i < made.cloud.positions.size(); ++i)
            if (made.cloud.mk[i] < first_bound)
                out = {std::min(out.first, made.densities[i]),
                       std::max(out.second, made.densities[i])};
        return out;
    };
    const std::string along = R"(<gravity x="1" y="0" z="0" />)";
    const std::string fitted = "<fppg><bodyfitted /></fppg>";
    const TemporaryFolder folder;
    const MadeCase driven = make(folder, channel(fitted, along));
    EXPECT_EQ(range(driven), std::pair(1000.0F, 1000.0F));
    EXPECT_TRUE(contains(driven.output, "gravity drives the fluid along x, which is periodic"));
    const MadeCase lattice = make(folder, channel("", along));
    EXPECT_GT(range(lattice).second, range(lattice).first) << "as GenCase has it";
    EXPECT_FALSE(contains(lattice.output, "gravity drives"));
    const MadeCase still = make(folder, channel(fitted, R"(<gravity x="0" y="0" z="-9.81" />)"));
    EXPECT_GT(range(still).second, range(still).first);
}

/// Water on a bed under gravity that leans along x, at rest across the bed.
TEST(DrivenFlow, HasTheDepthsThatItsBedHolds)
{
    const auto channel = [](const std::string& gravity_x, const std::string& execution)
    {
        CaseText text;
        text.pointmin = R"(<pointmin x="0" y="0" z="-0.5" />)";
        text.pointmax = R"(<pointmax x="2" y="0" z="1.5" />)";
        text.gravity = R"(<gravity x=")" + gravity_x + R"(" y="0" z="-9.8" />)";
        text.constants += R"(<speedsound value="60" auto="false" />)";
        text.mainlist =
            R"(<setdrawmode mode="full" /><setmkbound mk="0" /><drawbox><boxfill>solid</boxfill><point x="0" y="-1" z="-0.4" /><size x="2" y="2" z="0.35" /></drawbox>
<setmkfluid mk="0" /><drawbox><boxfill>solid</boxfill><point x="0" y="-1" z="0" /><size x="2" y="2" z="1" /></drawbox>)";
        text.execution = execution;
        text.after_geometry = "<fppg><bodyfitted /></fppg>";
        return text;
    };
    const std::string periodic =
        R"(<parameters><parameter key="XPeriodicIncZ" value="0" /></parameters>)";
    const auto zone = [](const std::string& x, const std::string& way)
    {
        return "<inoutzone><zone2d><line><point x=\"" + x + "\" z=\"0\" /><point2 x=\"" + x +
               "\" z=\"1\" /><direction x=\"" + way + "\" z=\"0\" /></line></zone2d></inoutzone>";
    };
    const std::string through =
        "<special><inout>" + zone("0", "1") + zone("2", "-1") + "</inout></special><parameters />";
    const std::string from_one_end =
        "<special><inout>" + zone("0", "1") + "</inout></special><parameters />";
    const TemporaryFolder folder;
    for (const std::string& execution : {periodic, through})
    {
        const MadeCase level = make(folder, channel("0", execution));
        const MadeCase leaning = make(folder, channel("0.9", execution));
        EXPECT_EQ(leaning.cloud.positions, level.cloud.positions);
        EXPECT_EQ(leaning.densities, level.densities);
        EXPECT_TRUE(contains(leaning.output, "gravity drives the fluid along x"));
        EXPECT_FALSE(contains(level.output, "gravity drives"));
    }
    const MadeCase level = make(folder, channel("0", from_one_end));
    const MadeCase held = make(folder, channel("0.9", from_one_end));
    EXPECT_NE(held.densities, level.densities) << "a basin that is filled from one end";
    EXPECT_FALSE(contains(held.output, "gravity drives"));
}

/// Water over and under a plate that reaches from one side of its tank to its middle, in a case
/// whose axes are exchanged so that `up` is up, or down if it is not positive.
CaseText plate_in_tank(int up, bool is_positive)
{
    const auto place = [&](double x, double y, double z)
    {
        const std::array<double, 3> of_up = {x, y, is_positive ? z : 1 - z};
        // z goes to the axis that is up, the others keep their order.
        if (up == 0) return Vec3{of_up[2], x, y};
        if (up == 1) return Vec3{x, of_up[2], y};
        return Vec3{x, y, of_up[2]};
    };
    const auto corners = [&](const Vec3& a, const Vec3& b)
    {
        const Vec3 from = place(a.x, a.y, a.z);
        const Vec3 to = place(b.x, b.y, b.z);
        fppg::Box3 box;
        box.add(from);
        box.add(to);
        return box;
    };
    const auto solid = [&](const Vec3& a, const Vec3& b)
    {
        const fppg::Box3 box = corners(a, b);
        return fmt::format(
            R"(<drawbox><boxfill>solid</boxfill><point x="{}" y="{}" z="{}" /><size x="{}" y="{}" z="{}" /></drawbox>)",
            box.min.x, box.min.y, box.min.z, box.max.x - box.min.x, box.max.y - box.min.y,
            box.max.z - box.min.z);
    };
    CaseText text;
    text.pointmin = R"(<pointmin x="-0.5" y="-0.5" z="-0.5" />)";
    text.pointmax = R"(<pointmax x="1.5" y="1.5" z="1.5" />)";
    Vec3 gravity;
    gravity[up] = is_positive ? -9.81 : 9.81;
    text.gravity =
        fmt::format(R"(<gravity x="{}" y="{}" z="{}" />)", gravity.x, gravity.y, gravity.z);
    text.constants += R"(<speedsound value="60" auto="false" />)";
    text.mainlist = R"(<setdrawmode mode="full" /><setmkbound mk="0" />)" +
                    solid({-0.4, -0.4, -0.4}, {1.4, 1.4, 1.4}) + "<setmkvoid />" +
                    solid({0, 0, 0}, {1, 1, 1.4}) + R"(<setmkbound mk="1" />)" +
                    solid({-0.1, -0.1, 0.3}, {0.5, 1.1, 0.6});
    const Vec3 seed = place(0.8, 0.5, 0.5);
    const fppg::Box3 fill = corners({-0.2, -0.2, -0.2}, {1.2, 1.2, 0.9});
    text.mainlist += fmt::format(
        R"(<setmkfluid mk="0" /><fillbox x="{}" y="{}" z="{}"><modefill>void</modefill><point x="{}" y="{}" z="{}" /><size x="{}" y="{}" z="{}" /></fillbox>)",
        seed.x, seed.y, seed.z, fill.min.x, fill.min.y, fill.min.z, fill.max.x - fill.min.x,
        fill.max.y - fill.min.y, fill.max.z - fill.min.z);
    text.after_geometry = R"(<fppg><bodyfitted boundary="mdbc" /></fppg>)";
    text.execution = R"(<parameters><parameter key="Boundary" value="2" /></parameters>)";
    return text;
}

/// Under the plate it has the pressure of its depth under the open surface, whichever axis is up.
TEST(WaterUnderAPlate, IsTheSameUnderGravityAlongAnyAxis)
{
    const TemporaryFolder folder;
    const auto densities_of = [&](int up, bool is_positive)
    {
        const MadeCase made = make(folder, plate_in_tank(up, is_positive));
        std::vector<float> out;
        for (std::size_t i = 0; i < made.cloud.positions.size(); ++i)
            if (made.cloud.mk[i] < first_bound) out.push_back(made.densities[i]);
        std::sort(out.begin(), out.end());
        return out;
    };
    const std::vector<float> upright = densities_of(2, true);
    ASSERT_GT(upright.size(), 500u);
    for (const auto& [up, is_positive] : {std::pair{0, true}, {0, false}, {1, true}, {2, false}})
    {
        const std::vector<float> turned = densities_of(up, is_positive);
        ASSERT_EQ(turned.size(), upright.size()) << up << is_positive;
        float farthest = 0;
        for (std::size_t i = 0; i < turned.size(); ++i)
            farthest = std::max(farthest, std::abs(turned[i] - upright[i]));
        EXPECT_LT(farthest, 0.1F * (upright.back() - upright.front())) << up << is_positive;
    }
}

/// A bed of water beside a dam, in two basins.
TEST(WaterAtTwoLevels, HasTheDepthOfItsOwnSurfaceBesideFittedWalls)
{
    const auto basins = [](const std::string& gradient, const std::string& fppg)
    {
        CaseText text;
        text.pointmin = R"(<pointmin x="-0.4" y="0" z="-0.4" />)";
        text.pointmax = R"(<pointmax x="2.5" y="0" z="1.5" />)";
        text.constants += R"(<speedsound value="60" auto="false" />)";
        text.rhopgradient = R"(<rhopgradient value=")" + gradient + R"(" />)";
        text.mainlist =
            R"(<setdrawmode mode="full" /><setmkbound mk="0" /><drawbox><boxfill>bottom | left | right</boxfill><point x="0" y="-1" z="0" /><size x="2.1" y="2" z="1.2" /></drawbox><drawbox><boxfill>solid</boxfill><point x="1" y="-1" z="0" /><size x="0.4" y="2" z="1.2" /></drawbox>
<setmkfluid mk="0" /><fillbox x="0.5" y="0" z="0.2"><modefill>void</modefill><point x="-0.1" y="-1" z="-0.1" /><size x="1.2" y="2" z="0.95" /></fillbox>
<setmkfluid mk="1" /><fillbox x="1.7" y="0" z="0.2"><modefill>void</modefill><point x="1.2" y="-1" z="-0.1" /><size x="1" y="2" z="0.45" /></fillbox>)";
        text.after_geometry = fppg;
        return text;
    };
    const TemporaryFolder folder;
    const std::string fitted = "<fppg><bodyfitted /></fppg>";
    const MadeCase by_column = make(folder, basins("2", fitted));
    const MadeCase by_height = make(folder, basins("3", fitted));
    EXPECT_EQ(by_height.cloud.positions, by_column.cloud.positions);
    EXPECT_EQ(by_height.densities, by_column.densities);
    EXPECT_TRUE(contains(by_height.output, "fluid that stands lower")) << by_height.output;
    EXPECT_FALSE(contains(by_column.output, "fluid that stands lower"));
    const MadeCase lattice = make(folder, basins("3", ""));
    EXPECT_NE(lattice.densities, make(folder, basins("2", "")).densities) << "as GenCase has it";
    EXPECT_FALSE(contains(lattice.output, "fluid that stands lower"));
}

} // namespace
