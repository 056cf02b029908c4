// What walls leave to fluid: pockets that stay empty, the volume that is missing, exact masses.

#include "relax/fluid_case.h"

#include <gtest/gtest.h>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace
{

using namespace fluid_case;

/// A tank of sheets, 1.23 x 1.04 x 1 m, with two blocks of 0.4 x 0.4 x 0.1 m in its water, one over
/// the other, so far apart; the nodes at z = 0.55 lie midway between them.
std::string tank_with_blocks(double apart)
{
    return fmt::format(
        R"(<setmkbound mk="0" /><drawbox><boxfill>bottom | left | right | front | back</boxfill><point x="0" y="0" z="0" /><size x="1.23" y="1.04" z="1" /></drawbox>
<setmkbound mk="1" /><drawbox><boxfill>solid</boxfill><point x="0.41" y="0.32" z="{:.6f}" /><size x="0.4" y="0.4" z="0.1" /></drawbox>
<drawbox><boxfill>solid</boxfill><point x="0.41" y="0.32" z="{:.6f}" /><size x="0.4" y="0.4" z="0.1" /></drawbox>
<setmkfluid mk="0" /><fillbox x="0.2" y="0.2" z="0.2"><modefill>void</modefill><point x="-0.2" y="-0.2" z="-0.2" /><size x="2" y="2" z="1.12" /></fillbox>)",
        0.45 - apart / 2, 0.55 + apart / 2);
}

/// Fluid between the blocks, off their rims.
std::size_t between_blocks(const Result& r, double apart)
{
    const std::vector<Vec3> fluid = r.fluid();
    return static_cast<std::size_t>(std::count_if(fluid.begin(), fluid.end(),
                                                  [&](const Vec3& p)
                                                  {
                                                      return p.x > 0.46 && p.x < 0.76 &&
                                                             p.y > 0.37 && p.y < 0.67 &&
                                                             std::abs(p.z - 0.55) < apart / 2;
                                                  }));
}

/// Nodes half a dp from walls stay.
const std::string near_walls = R"(<bodyfitted clearance="0.5" />)";

TEST(FluidSpace, NarrowPocketsStayEmptyAndAreListedWithPlaceAndVolume)
{
    const double apart = 1.3 * dp;
    for (const char* band : {"", "<fluidband />"})
    {
        const Result r = make(case_of(tank_with_blocks(apart), near_walls + band));
        ASSERT_EQ(r.code, 0) << r.output;
        EXPECT_EQ(between_blocks(r, apart), 0u);
        const json pocket = r.one("pocket");
        // It reaches a little beyond the rims of the blocks.
        const double litres = 1000 * 0.4 * 0.4 * apart;
        EXPECT_GT(pocket["litres"].get<double>(), litres);
        EXPECT_LT(pocket["litres"].get<double>(), 1.1 * litres);
        EXPECT_NEAR(pocket["narrowest_dp"].get<double>(), 1.3, 0.01);
        EXPECT_NEAR(pocket["center"][0].get<double>(), 0.61, 0.2 * dp);
        EXPECT_NEAR(pocket["center"][1].get<double>(), 0.52, 0.2 * dp);
        EXPECT_NEAR(pocket["center"][2].get<double>(), 0.55, 0.1 * dp);
        EXPECT_GT(pocket["particles"].get<int>(), 40);
        EXPECT_TRUE(contains(r.log, "Left empty: 1 pocket")) << r.log;
    }
}

TEST(FluidSpace, PocketsWithoutRoomForAParticleAreListedToo)
{
    const double apart = 0.6 * dp;
    const Result r = make(case_of(tank_with_blocks(apart), "<bodyfitted />"));
    ASSERT_EQ(r.code, 0) << r.output;
    const json pocket = r.one("pocket");
    const double litres = 1000 * 0.4 * 0.4 * apart;
    EXPECT_NEAR(pocket["litres"].get<double>(), litres, 0.05 * litres);
    EXPECT_NEAR(pocket["narrowest_dp"].get<double>(), 0.6, 0.01);
    EXPECT_EQ(pocket["particles"].get<int>(), 0);
}

TEST(FluidSpace, WiderPlacesKeepTheirFluid)
{
    const double apart = 1.7 * dp;
    const Result r = make(case_of(tank_with_blocks(apart), near_walls));
    ASSERT_EQ(r.code, 0) << r.output;
    EXPECT_GT(between_blocks(r, apart), 20u);
    EXPECT_TRUE(r.all("pocket").empty()) << r.output;
    const Result off =
        make(case_of(tank_with_blocks(1.3 * dp), near_walls + R"(<fluidband active="false" />)"));
    EXPECT_GT(between_blocks(off, 1.3 * dp), 20u);
}

TEST(FluidSpace, TheVolumeBetweenWallsIsThatOfTheCavity)
{
    // Up to half a dp above the highest nodes, at z = 0.85, and without the blocks.
    const Result r = make(case_of(tank_with_blocks(0.15), "<bodyfitted />"));
    ASSERT_EQ(r.code, 0) << r.output;
    const double cavity = 1000 * (1.23 * 1.04 * (0.85 + dp / 2) - 2 * 0.4 * 0.4 * 0.1);
    const json space = r.one("fluid_space");
    EXPECT_NEAR(space["cavity_litres"].get<double>(), cavity, 0.002 * cavity);
    const auto particles = static_cast<double>(r.fluid().size());
    EXPECT_EQ(space["particles"].get<double>(), particles);
    EXPECT_NEAR(space["litres"].get<double>(), particles * 1000 * dp * dp * dp, 1e-6 * cavity);
    EXPECT_TRUE(contains(r.log, "% missing")) << r.log;
}

/// A shell full of fluid, with a solid ball in it.
std::string round_vessel()
{
    return R"(<setdrawmode mode="face" /><setmkbound mk="0" /><drawsphere radius="0.52"><point x="0.613" y="0.521" z="0.537" /></drawsphere>
<setdrawmode mode="full" /><setmkbound mk="1" /><drawsphere radius="0.2"><point x="0.613" y="0.521" z="0.537" /></drawsphere>
<setmkfluid mk="0" /><fillpoint x="0.613" y="0.521" z="0.9"><modefill>void</modefill></fillpoint>)";
}

TEST(FluidSpace, TheVolumeInARoundVesselIsThatOfTheSphere)
{
    const double cavity = 4e3 / 3 * std::numbers::pi * (std::pow(0.52, 3) - std::pow(0.2, 3));
    const Result r = make(case_of(round_vessel(), "<bodyfitted />"));
    ASSERT_EQ(r.code, 0) << r.output;
    EXPECT_NEAR(r.one("fluid_space")["cavity_litres"].get<double>(), cavity, 0.002 * cavity);
}

TEST(FluidSpace, BetweenLayersNoVolumeIsMissing)
{
    const Result r = make(case_of(tank_with_blocks(0.15), R"(<bodyfitted boundary="mdbc" />)"));
    ASSERT_EQ(r.code, 0) << r.output;
    EXPECT_NEAR(r.level(), 0.875, 0.6 * dp);
    const double cavity = 1000 * (1.23 * 1.04 * r.level() - 2 * 0.4 * 0.4 * 0.1);
    const json space = r.one("fluid_space");
    EXPECT_NEAR(space["cavity_litres"].get<double>(), cavity, 0.002 * cavity);
    EXPECT_NEAR(space["litres"].get<double>(), cavity, 0.005 * cavity);
}

/// The tank and the blocks, 1.3 dp apart, filled by a `<fill>`.
CaseText filled_tank(const std::string& fppg, const std::string& fill)
{
    const std::string drawn = tank_with_blocks(1.3 * dp);
    return case_of(drawn.substr(0, drawn.find("<setmkfluid")),
                   fppg + R"(<fill mkfluid="0" seed="0.6,0.1,0.2" )" + fill + " />");
}

/// Fluid from a seed up to z = 0.47; nodes that nothing moves end at 0.4, as GenCase's do.
std::string filled_from(const Vec3& seed)
{
    return fmt::format(
        R"(<setmkfluid mk="0" /><fillbox x="{}" y="{}" z="{}"><modefill>void</modefill><point x="-0.4" y="-0.4" z="-0.4" /><size x="2" y="2" z="0.87" /></fillbox>)",
        seed.x, seed.y, seed.z);
}

/// The walls at x = 0.013 and so on are off the nodes of the definition, which are at multiples of
/// dp.
TEST(FluidSpace, BetweenWallsAWholeNumberOfStepsApartIsACrystalWithThem)
{
    constexpr double x = 0.013, y = 0.021, z = -0.017;
    // A box is drawn up to a step before the walls, as on the lattice.
    const std::string box = fmt::format(
        R"(<setmkfluid mk="0" /><drawbox><boxfill>solid</boxfill><point x="{}" y="{}" z="{}" /><size x="0.7" y="0.6" z="0.38" /></drawbox>)",
        x + dp, y + dp, z + dp);
    // Rows end at 0.458 and 0.408 m.
    for (const auto& [water, rows] :
         {std::pair(filled_from({0.2, 0.4, 0.3}), 10u), std::pair(box, 9u)})
    {
        const Result r = make(case_of(
            fmt::format(
                R"(<setmkbound mk="0" /><drawbox><boxfill>bottom | left | right | front | back</boxfill><point x="{}" y="{}" z="{}" /><size x="0.8" y="0.7" z="0.9" /></drawbox>)",
                x, y, z) +
                water,
            R"(<bodyfitted boundary="mdbc" /><fluidband balance="false" />)"));
        ASSERT_EQ(r.code, 0) << r.output;
        const auto off_crystal = [&](const Vec3& p)
        {
            const Vec3 at = (p - Vec3{x, y, z}) / dp - Vec3{0.5, 0.5, 0.5};
            return norm(at - Vec3{std::round(at.x), std::round(at.y), std::round(at.z)});
        };
        std::size_t fluid = 0;
        std::size_t floor = 0;
        for (std::size_t i = 0; i < r.cloud.positions.size(); ++i)
        {
            const Vec3& p = r.cloud.positions[i];
            const bool is_fluid = r.cloud.mk[i] < first_bound;
            const bool is_floor = p.z < z && p.z > z - dp && p.x > x + dp && p.x < x + 0.8 - dp &&
                                  p.y > y + dp && p.y < y + 0.7 - dp;
            fluid += is_fluid ? 1 : 0;
            floor += is_floor ? 1 : 0;
            if (is_fluid || is_floor)
            {
                EXPECT_LT(off_crystal(p), 0.12) << p.x << ' ' << p.y << ' ' << p.z;
            }
        }
        EXPECT_EQ(fluid, 16u * 14u * rows);
        EXPECT_EQ(floor, 14u * 12u);
    }
}

TEST(FluidSpace, AMovedLatticeKeepsLayersAtTheEndOfTheDomain)
{
    std::vector<std::size_t> numbers;
    for (const char* low : {"-0.4", "-0.145", "-0.13", "-0.05", "-0.051"})
    {
        // The domain ends where it cuts what is drawn, and the lattice with it.
        const bool is_short = low == std::string("-0.051");
        const std::string beyond =
            is_short
                ? R"(<setmkbound mk="1" /><drawbox><boxfill>solid</boxfill><point x="-0.35" y="-0.35" z="-0.5" /><size x="0.1" y="0.1" z="0.7" /></drawbox>)"
                : "";
        CaseText text = case_of(
            R"(<setmkbound mk="0" /><drawbox><boxfill>bottom | left | right | front | back</boxfill><point x="0" y="0" z="0" /><size x="0.8" y="0.7" z="0.9" /></drawbox>)" +
                beyond + filled_from({0.2, 0.4, 0.3}),
            R"(<bodyfitted boundary="mdbc" />)");
        text.pointmin = fmt::format(R"(<pointmin x="-0.4" y="-0.4" z="{}" />)", low);
        const Result r = make(text);
        ASSERT_EQ(r.code, 0) << r.output;
        numbers.push_back(r.cloud.positions.size());
        EXPECT_EQ(contains(r.output, "lie beyond the domain and are left out"), is_short) << low;
        EXPECT_EQ(contains(r.output, "reach further to -z"), is_short) << low;
        if (is_short) continue;
        EXPECT_EQ(
            std::count_if(r.cloud.positions.begin(), r.cloud.positions.end(),
                          [](const Vec3& p) { return std::abs(p.z + 2.5 * dp) < 1e-6; }) > 200,
            true)
            << low;
    }
    EXPECT_EQ(numbers[1], numbers[0]);
    EXPECT_EQ(numbers[2], numbers[0]);
    EXPECT_EQ(numbers[3], numbers[0]);
}

TEST(FluidSpace, AFaceOfASolidOnNodesHasItsFluid)
{
    // The lattice moves to the floor, and a face under the block comes to lie on nodes. Rows of a
    // cubic lattice keep the level of the water: half a dp above the highest.
    for (const double below : {0.125, 0.135})
    {
        const std::string block = fmt::format(
            R"(<setmkbound mk="1" /><drawbox><boxfill>solid</boxfill><point x="0.41" y="0.32" z="{}" /><size x="0.4" y="0.4" z="0.09" /></drawbox>)",
            below);
        const Result r = make(case_of(
            R"(<setmkbound mk="0" /><drawbox><boxfill>bottom | left | right | front | back</boxfill><point x="0" y="0" z="0" /><size x="1.23" y="1.04" z="1" /></drawbox>)" +
                block + filled_from({0.2, 0.2, 0.2}),
            R"(<bodyfitted boundary="mdbc" /><fluidband packing="cubic" />)"));
        ASSERT_EQ(r.code, 0) << r.output;
        const double litres = 1000 * (1.23 * 1.04 * r.level() - 0.4 * 0.4 * 0.09);
        const auto found = static_cast<double>(r.fluid().size()) * 1000 * dp * dp * dp;
        EXPECT_NEAR(found, litres, 0.001 * litres) << below;
    }
}

TEST(FluidSpace, UnderAFreeSurfaceEndsAtItBesideLeaningWallsToo)
{
    const Vec3 middle{0.613, 0.521, 0.42};
    for (const Vec3& way : {Vec3{0.6, 0.5, 0.62}, Vec3{0.8, -0.2, 0.57}, Vec3{0, 0, 1}})
    {
        const Vec3 axis = way / norm(way);
        const Vec3 a = middle - 0.4 * axis;
        const Vec3 b = middle + 0.4 * axis;
        constexpr double radius = 0.41;
        const Result r = make(case_of(
            fmt::format(
                R"(<setdrawmode mode="face" /><setmkbound mk="0" /><drawcylinder radius="{}"><point x="{}" y="{}" z="{}" /><point x="{}" y="{}" z="{}" /></drawcylinder>)",
                radius, a.x, a.y, a.z, b.x, b.y, b.z) +
                filled_from({middle.x, middle.y, 0.36}),
            R"(<bodyfitted boundary="mdbc" />)"));
        ASSERT_EQ(r.code, 0) << r.output;
        EXPECT_NEAR(r.level(), 0.4 + dp / 2, 1.3 * dp) << way.x;
        // By the middles of cubes of 5 mm.
        constexpr double step = 0.005;
        double litres = 0;
        for (double x = -0.4; x < 1.5; x += step)
            for (double y = -0.4; y < 1.5; y += step)
                for (double z = r.level() - step / 2; z > -0.5; z -= step)
                {
                    const Vec3 off = Vec3{x, y, z} - middle;
                    const double along = dot(off, axis);
                    if (std::abs(along) < 0.4 && norm(off - along * axis) < radius)
                        litres += 1000 * step * step * step;
                }
        const auto found = static_cast<double>(r.fluid().size()) * 1000 * dp * dp * dp;
        EXPECT_NEAR(found, litres, 0.005 * litres) << way.x;
    }
}

TEST(FluidSpace, BesideAFreeSurfaceThereIsNoneUnderARoofAboveIt)
{
    // One edge of the plate is 0.9 dp above the surface, the other one more.
    const Result r = make(case_of(
        R"(<setmkbound mk="0" /><drawbox><boxfill>bottom | left | right | front | back</boxfill><point x="0" y="0" z="0" /><size x="1.23" y="1.04" z="1" /></drawbox>
<setmkbound mk="1" /><move x="0.3" y="0.22" z="0.47" /><rotate ang="5" x="0" y="1" z="0" /><drawbox><boxfill>solid</boxfill><point x="0" y="0" z="0" /><size x="0.75" y="0.6" z="0.2" /></drawbox><matrixreset />)" +
            filled_from({0.2, 0.1, 0.2}),
        R"(<bodyfitted boundary="mdbc" /><fluidband balance="false" />)"));
    ASSERT_EQ(r.code, 0) << r.output;
    for (const Vec3& p : r.fluid()) EXPECT_LT(p.z, r.level()) << p.x << ' ' << p.y;
}

TEST(FluidSpace, WhereASolidRunsThroughTheWallsOfATankItHasNone)
{
    const Result r = make(case_of(
        R"(<setmkbound mk="0" /><drawbox><boxfill>bottom | left | right | front | back</boxfill><point x="0.013" y="0.021" z="-0.017" /><size x="1.1" y="0.9" z="1" /></drawbox>
<setmkbound mk="1" /><drawbox><boxfill>solid</boxfill><point x="0.45" y="-0.03" z="-0.06" /><size x="0.19" y="1" z="0.3" /></drawbox>)" +
            filled_from({0.2, 0.4, 0.3}),
        R"(<bodyfitted boundary="mdbc" />)"));
    ASSERT_EQ(r.code, 0) << r.output;
    EXPECT_NEAR(r.level(), 0.4 + dp / 2, 1.3 * dp);
    const double litres = 1000 * (1.1 * 0.9 * (r.level() + 0.017) - 0.19 * 0.9 * (0.24 + 0.017));
    const auto found = static_cast<double>(r.fluid().size()) * 1000 * dp * dp * dp;
    EXPECT_NEAR(found, litres, 0.004 * litres);
}

TEST(FluidSpace, LitresStayThroughRelaxationAndPockets)
{
    const double asked = 777;
    for (const char* band : {"", "<fluidband />"})
    {
        const Result r = make(filled_tank(near_walls + band, fmt::format(R"(litres="{}")", asked)));
        ASSERT_EQ(r.code, 0) << r.output;
        EXPECT_GT(r.one("pocket")["particles"].get<int>(), 0);
        const double litres = static_cast<double>(r.fluid().size()) * 1000 * dp * dp * dp;
        EXPECT_NEAR(litres, r.one("fill")["litres"].get<double>(), 0.001 * asked);
        EXPECT_NEAR(litres, asked, 0.03 * asked); // to half a layer
    }
}

/// However water is drawn between layers, before its walls, after them or by a fill with or without
/// its limits: its rows end where the drawn box ends.
TEST(FluidSpace, WaterBetweenLayersHasTheVolumeThatIsDrawn)
{
    const std::string walls =
        R"(<setmkbound mk="0" /><drawbox><boxfill>bottom | left | right | front | back</boxfill><point x="0" y="0" z="0" /><size x="1" y="0.6" z="1" /></drawbox>)";
    for (const double width : {1.0, 0.5})
        for (const double level : {0.4, 0.42})
        {
            const std::string box = fmt::format(
                R"(<point x="0" y="0" z="0" /><size x="{}" y="0.6" z="{}" />)", width, level);
            const std::string water = fmt::format(
                R"(<setmkfluid mk="0" /><drawbox><boxfill>solid</boxfill>{}</drawbox>)", box);
            const std::string fill = fmt::format(
                R"(<setmkfluid mk="0" /><fillbox x="0.2" y="0.2" z="0.2"><modefill>void</modefill>{}</fillbox>)",
                box);
            const std::string limited = R"(<setboxlimitmode mode="full" />)" + fill;
            for (const std::string& drawn :
                 {water + walls, walls + water, walls + fill, walls + limited})
            {
                // On its own lattice, and on the most stable one, whose highest rows draw together.
                for (const auto& [packing, off] :
                     {std::pair{"cubic", 0.01}, std::pair{"stable", 0.5}})
                {
                    const Result r = make(case_of(
                        drawn,
                        fmt::format(R"(<bodyfitted boundary="mdbc" /><fluidband packing="{}" />)",
                                    packing)));
                    ASSERT_EQ(r.code, 0) << r.output;
                    const double volume = static_cast<double>(r.fluid().size()) * dp * dp * dp;
                    EXPECT_NEAR(volume, width * 0.6 * 0.4, 0.0015 * volume) << drawn;
                    EXPECT_NEAR(r.level(), 0.4, off * dp) << drawn << packing;
                }
            }
        }
}

/// Drawn first and off the lattice, a box of water would end at the nearest nodes, which along the
/// edges of the tank lie beyond it and farther than half a dp from its walls.
TEST(FluidSpace, WaterThatIsDrawnUpToWallsStaysBetweenThem)
{
    const std::string place = R"(<point x="0.023" y="-0.018" z="0.022" />)";
    for (const char* boundary : {"dbc", "mdbc"})
    {
        const Result r = make(case_of(
            fmt::format(
                R"(<setmkfluid mk="0" /><drawbox><boxfill>solid</boxfill>{0}<size x="0.9" y="0.73" z="0.4" /></drawbox>
<setmkbound mk="0" /><drawbox><boxfill>bottom | left | right | front | back</boxfill>{0}<size x="0.9" y="0.73" z="0.8" /></drawbox>)",
                place),
            fmt::format(R"(<bodyfitted boundary="{}" />)", boundary)));
        ASSERT_EQ(r.code, 0) << r.output;
        ASSERT_GT(r.fluid().size(), 1000u);
        for (const Vec3& p : r.fluid())
        {
            EXPECT_GT(std::min({p.x - 0.023, 0.923 - p.x, p.y + 0.018, 0.712 - p.y, p.z - 0.022}),
                      0)
                << boundary << ' ' << p.x << ' ' << p.y << ' ' << p.z;
        }
    }
}

/// Faces of a hollow box that lie on nodes, and its edges beside them, do not make its outside its
/// inside: water before them is evened out as it is before a solid one.
TEST(FluidSpace, WaterBesideAHollowBoxIsEvenedOut)
{
    const auto nearest = [](const char* fill)
    {
        const Result r = make(case_of(
            fmt::format(
                R"(<setmkbound mk="0" /><drawbox><boxfill>bottom | left | right | front | back</boxfill><point x="0" y="0" z="0" /><size x="1.2" y="1" z="0.9" /></drawbox>
<setmkbound mk="1" /><drawbox><boxfill>{}</boxfill><point x="0.4" y="0.325" z="0" /><size x="0.35" y="0.35" z="0.375" /></drawbox>
<setmkfluid mk="0" /><fillbox x="0.2" y="0.2" z="0.2"><modefill>void</modefill><point x="-0.2" y="-0.2" z="-0.2" /><size x="2" y="2" z="0.8" /></fillbox>)",
                fill),
            R"(<bodyfitted boundary="mdbc" /><fluidband balance="false" />)"));
        EXPECT_EQ(r.code, 0) << r.output;
        EXPECT_FALSE(contains(r.output, "both sides")) << r.output;
        double sum = 0;
        int count = 0;
        // Before the faces across y, at mid height.
        for (const Vec3& p : r.fluid())
        {
            const double off = std::max(0.325 - p.y, p.y - 0.675);
            if (p.x < 0.45 || p.x > 0.7 || p.z < 0.1 || p.z > 0.3 || off > 0.9 * dp) continue;
            sum += off / dp;
            ++count;
        }
        return count > 0 ? sum / count : 1.0;
    };
    EXPECT_NEAR(nearest("all"), 0.5, 0.1);
    EXPECT_NEAR(nearest("solid"), 0.5, 0.1);
}

/// A wall in layers that stands on a floor in layers takes no row of the floor beside it.
TEST(FluidSpace, AFloorKeepsItsRowsBesideAWallThatStandsOnIt)
{
    const Result r = make(case_of(
        R"(<setmkbound mk="0" /><drawbox><boxfill>bottom | left | right | front | back</boxfill><point x="0" y="0" z="0" /><size x="1.2" y="0.6" z="0.8" /></drawbox>
<setmkbound mk="1" /><drawbox><boxfill>solid</boxfill><point x="0.5" y="-0.1" z="-0.05" /><size x="0.2" y="0.8" z="0.9" /></drawbox>
<setmkfluid mk="0" /><fillbox x="0.2" y="0.3" z="0.2"><modefill>void</modefill><point x="-0.2" y="-0.2" z="-0.2" /><size x="2" y="2" z="0.7" /></fillbox>
<fillbox x="0.9" y="0.3" z="0.2"><modefill>void</modefill><point x="-0.2" y="-0.2" z="-0.2" /><size x="2" y="2" z="0.7" /></fillbox>)",
        R"(<bodyfitted boundary="mdbc" /><fluidband balance="false" />)"));
    ASSERT_EQ(r.code, 0) << r.output;
    int beside = 0;
    for (const Vec3& p : r.fluid())
    {
        if (p.z > 0.8 * dp || std::abs(std::abs(p.x - 0.6) - 0.1) > 0.8 * dp) continue;
        ++beside;
        double below = 1;
        for (std::size_t i = 0; i < r.cloud.positions.size(); ++i)
            if (r.cloud.mk[i] >= first_bound)
                below = std::min(below, norm(r.cloud.positions[i] - (p - Vec3{0, 0, dp})));
        EXPECT_LT(below, 0.4 * dp) << p.x << ' ' << p.y;
    }
    EXPECT_EQ(beside, 2 * 12);
}

/// A void takes the nodes that lie in it out of water, and no row beside it: the block that is
/// drawn in its place leaves the same water as without the void.
TEST(FluidSpace, AVoidMakesRoomForABlockWithoutARowTooMany)
{
    const std::string block =
        R"(<drawbox><boxfill>solid</boxfill><point x="0.3" y="0.2" z="0" /><size x="0.2" y="0.2" z="0.3" /></drawbox>)";
    const auto water = [&](const std::string& voids)
    {
        const Result r = make(case_of(
            R"(<setmkfluid mk="0" /><drawbox><boxfill>solid</boxfill><point x="0" y="0" z="0" /><size x="1" y="0.6" z="0.4" /></drawbox>)" +
                voids +
                R"(<setmkbound mk="0" /><drawbox><boxfill>bottom | left | right | front | back</boxfill><point x="0" y="0" z="0" /><size x="1" y="0.6" z="1" /></drawbox><setmkbound mk="1" />)" +
                block,
            R"(<bodyfitted boundary="mdbc" /><fluidband balance="false" />)"));
        EXPECT_EQ(r.code, 0) << r.output;
        return r.fluid();
    };
    const std::vector<Vec3> fluid = water("<setmkvoid />" + block);
    EXPECT_EQ(fluid.size(), 20u * 12 * 8 - 4 * 4 * 6);
    EXPECT_EQ(fluid, water(""));
}

TEST(FluidSpace, ExactMassIsThatOfTheLitresAskedFor)
{
    const Result r =
        make(filled_tank(R"(<bodyfitted /><fluidband mass="exact" />)", R"(litres="777")"));
    ASSERT_EQ(r.code, 0) << r.output;
    EXPECT_NEAR(static_cast<double>(r.fluid().size()) * r.mass_fluid, 777, 1e-3);
}

TEST(FluidSpace, ExactMassThatCannotBeIsRefused)
{
    const auto refused = [](const CaseText& text, const std::string& reason)
    {
        const Result r = make(text);
        EXPECT_NE(r.code, 0);
        EXPECT_TRUE(contains(r.output, reason)) << r.output;
        EXPECT_TRUE(contains(r.output, "Case_Def.xml:")) << r.output;
    };
    const std::string tank = tank_with_blocks(0.15);
    refused(case_of(tank, R"(<bodyfitted /><fluidband mass="more" />)"),
            "mass=\\\"more\\\" is unknown");
    refused(case_of(tank, R"(<bodyfitted /><fluidband mass="exact" active="false" />)"),
            "expected one of them");
    CaseText two = case_of(tank, R"(<bodyfitted /><fluidband mass="exact" />)");
    two.constants += R"(<massfluid value="0.125" auto="false" />)";
    refused(two, "both give the mass");
    refused(case_of(tank + R"(<setmkfluid mk="1" />)" +
                        box_command(R"(x="0.1" y="0.1" z="0.6")", R"(x="0.2" y="0.2" z="0.2")"),
                    R"(<bodyfitted /><fluidband mkfluid="0" mass="exact" />)"),
            "one mass for all fluid particles");
}

} // namespace
