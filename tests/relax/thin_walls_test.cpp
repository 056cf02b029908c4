// Fluid beside plates thinner than their rows of particles, and in gaps between walls.

#include "relax/fluid_case.h"

#include <gtest/gtest.h>

#include <fmt/format.h>

#include <algorithm>
#include <regex>

namespace
{

using namespace fluid_case;

/// Mean acceleration over gravity that balancing left.
double left_of_gravity(const Result& r)
{
    std::smatch found;
    const std::regex text("accelerations[^:]*: mean ([0-9.]+) g");
    EXPECT_TRUE(std::regex_search(r.log, found, text)) << r.log;
    return found.empty() ? 1 : std::stod(found[1]);
}

/// A tank 1.23 m wide, in 2D, filled up to z = 0.6 from seeds at these x.
Result tank_in_2d(const std::string& body, const std::vector<double>& seeds,
                  const std::string& fppg)
{
    std::string drawn =
        R"(<setmkbound mk="0" /><drawbox><boxfill>solid</boxfill><point x="-0.2" y="-0.1" z="-0.2" /><size x="1.63" y="0.2" z="1.2" /></drawbox>
<setmkvoid /><drawbox><boxfill>solid</boxfill><point x="0" y="-0.1" z="0" /><size x="1.23" y="0.2" z="1.3" /></drawbox><setmkbound mk="1" />)" +
        body + R"(<matrixreset /><setmkfluid mk="0" />)";
    for (const double x : seeds)
        drawn += fmt::format(
            R"(<fillbox x="{}" y="0" z="0.3"><modefill>void</modefill><point x="-0.2" y="-0.1" z="-0.2" /><size x="2" y="0.2" z="0.82" /></fillbox>)",
            x);
    CaseText text = case_of(drawn, fppg);
    text.pointmin = R"(<pointmin x="-0.4" y="0" z="-0.4" />)";
    text.pointmax = R"(<pointmax x="1.7" y="0" z="1.5" />)";
    Result out = make(text);
    EXPECT_EQ(out.code, 0) << out.output;
    return out;
}

/// Half a dp thick, leaning by 17 degrees.
const std::string plate =
    R"(<move x="0.6" y="0" z="0" /><rotate ang="17" x="0" y="1" z="0" /><drawbox><boxfill>solid</boxfill><point x="-0.0125" y="-0.1" z="-0.02" /><size x="0.025" y="0.2" z="0.9" /></drawbox>)";

std::size_t of_plate(const Result& r)
{
    return static_cast<std::size_t>(
        std::count(r.cloud.mk.begin(), r.cloud.mk.end(), first_bound + 1));
}

TEST(ThinPlate, BetweenWaterAndAirHasAllRowsThatWaterFeels)
{
    const Result one = tank_in_2d(plate, {1}, R"(<bodyfitted boundary="dbc" />)");
    EXPECT_TRUE(contains(one.output, "too thin for the rows of particles")) << one.output;
    EXPECT_LT(left_of_gravity(one), 0.005);
    // A row has 0.9 m / dp; in 2D with coefh 1 water feels two.
    EXPECT_NEAR(static_cast<double>(of_plate(one)), 2 * 18.5, 2);
    const Result both = tank_in_2d(plate, {0.1, 1}, R"(<bodyfitted boundary="dbc" />)");
    EXPECT_FALSE(contains(both.output, "too thin for the rows of particles")) << both.output;
    EXPECT_NEAR(static_cast<double>(of_plate(both)), 18.5, 2);
}

TEST(ThinShell, OfModifiedBoundariesIsThickenedUnlessFluidIsOnBothSides)
{
    const std::string shell =
        R"(<drawbox><boxfill>bottom | top | left | right | front | back</boxfill><point x="0.6" y="-0.1" z="-0.02" /><size x="0.025" y="0.2" z="0.9" /></drawbox>)";
    const std::string mdbc = R"(<bodyfitted boundary="mdbc" />)";
    const Result one = tank_in_2d(shell, {1}, mdbc);
    EXPECT_TRUE(contains(one.output, "thickened to 2 dp")) << one.output;
    EXPECT_GE(of_plate(one), 2 * 18u);
    const Result both = tank_in_2d(shell, {0.1, 1}, mdbc);
    EXPECT_FALSE(contains(both.output, "thickened to 2 dp")) << both.output;
    EXPECT_LT(of_plate(both), 22u);
}

TEST(GapUnderABlock, HoldsWaterBetweenLayersButNotBetweenSurfaces)
{
    const std::string block = fmt::format(
        R"(<drawbox><boxfill>solid</boxfill><point x="0.4" y="-0.1" z="{}" /><size x="0.45" y="0.2" z="0.8" /></drawbox>)",
        dp);
    const auto in_gap = [&](const Result& r)
    {
        const std::vector<Vec3> fluid = r.fluid();
        return std::count_if(fluid.begin(), fluid.end(),
                             [](const Vec3& p) { return p.x > 0.4 && p.x < 0.85 && p.z < dp; });
    };
    const Result layers =
        tank_in_2d(block, {0.1, 1}, R"(<bodyfitted boundary="mdbc" /><fluidband />)");
    EXPECT_NEAR(static_cast<double>(in_gap(layers)), 9, 1);
    EXPECT_TRUE(layers.all("pocket").empty()) << layers.output;
    EXPECT_LT(left_of_gravity(layers), 0.01);
    const Result surfaces = tank_in_2d(block, {0.1, 1}, R"(<bodyfitted boundary="dbc" />)");
    EXPECT_EQ(in_gap(surfaces), 0);
    EXPECT_FALSE(surfaces.all("pocket").empty());
}

TEST(GapBesideABall, LetsNoWaterRiseAboveTheSurface)
{
    const Result r = tank_in_2d(
        R"(<drawcylinder radius="0.15"><point x="1" y="-0.1" z="0.55" /><point x="1" y="0.1" z="0.55" /></drawcylinder>)",
        {0.1}, R"(<bodyfitted boundary="mdbc" /><fluidband balance="false" />)");
    for (const Vec3& p : r.fluid()) EXPECT_LT(p.z, r.level()) << p.x;
}

} // namespace
