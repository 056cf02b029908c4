// Fluid that gravity drives through a channel beside fitted walls.

#include "balance/made_case.h"

#include <utility>

namespace
{

using namespace fppg::test;

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

} // namespace
