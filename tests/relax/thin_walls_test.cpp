// Fluid beside plates thinner than their rows of particles, and in gaps between walls.

#include "helpers/gears.h"
#include "relax/fluid_case.h"

#include <gtest/gtest.h>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <regex>
#include <utility>
#include <vector>

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

double nearest_pair_dp(const std::vector<Vec3>& points)
{
    double nearest = 1;
    for (std::size_t i = 0; i < points.size(); ++i)
        for (std::size_t k = 0; k < i; ++k)
            nearest = std::min(nearest, norm(points[i] - points[k]) / dp);
    return nearest;
}

const std::string no_penetration =
    R"(<parameters><parameter key="Boundary" value="2" /><parameter key="SlipMode" value="2" /><parameter key="NoPenetration" value="1" /><parameter key="Kernel" value="2" /><parameter key="TimeMax" value="1" /></parameters>)";

/// A tank 1.23 m wide, in 2D, filled up to z = 0.6 from seeds at these x.
Result tank_in_2d(const std::string& body, const std::vector<double>& seeds,
                  const std::string& fppg, const std::string& spacing = "0.05")
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
    text.dp = spacing;
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

/// Adds the facets of a box, which look outwards.
void add_box(const Vec3& low, const Vec3& high, fppg::TriangleSoup& soup)
{
    const auto corner = [&](int at)
    {
        return Vec3{(at & 1) != 0 ? high.x : low.x, (at & 2) != 0 ? high.y : low.y,
                    (at & 4) != 0 ? high.z : low.z};
    };
    constexpr std::array<std::array<int, 4>, 6> faces{
        {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}}};
    for (const auto& [a, b, c, d] : faces)
        for (const int k : {a, b, c, a, c, d}) soup.vertices.push_back(corner(k));
}

/// Each slab is a shell of its own and looks to the water with one side. As in a public tank of a
/// wave energy converter (CaseOWSC3D), of which 1.1 g were left.
TEST(TankOfThinSlabs, HasAllRowsThatWaterFeels)
{
    constexpr double thick = 0.002;
    fppg::TriangleSoup slabs;
    add_box({-0.01, -0.01, -thick}, {1.01, 0.61, 0}, slabs);
    add_box({-thick, -0.02, -0.02}, {0, 0.62, 0.6}, slabs);
    add_box({1, -0.02, -0.02}, {1 + thick, 0.62, 0.6}, slabs);
    add_box({-0.02, -thick, -0.02}, {1.02, 0, 0.6}, slabs);
    add_box({-0.02, 0.6, -0.02}, {1.02, 0.6 + thick, 0.6}, slabs);
    const TemporaryFolder folder;
    write_stl(folder / "slabs.stl", slabs);
    CaseText text = case_of(
        R"(<setmkbound mk="0" /><drawfilestl file=")" + folder / "slabs.stl" +
            R"(" /><setmkfluid mk="0" /><fillbox x="0.5" y="0.3" z="0.2"><modefill>void</modefill><point x="-0.1" y="-0.1" z="-0.1" /><size x="1.2" y="0.8" z="0.5" /></fillbox>)",
        R"(<bodyfitted boundary="dbc" />)");
    text.pointmin = R"(<pointmin x="-0.3" y="-0.3" z="-0.3" />)";
    text.pointmax = R"(<pointmax x="1.3" y="0.9" z="0.8" />)";
    const Result made = make(text);
    ASSERT_EQ(made.code, 0) << made.output;
    EXPECT_TRUE(contains(made.output, "too thin for the rows of particles")) << made.output;
    EXPECT_LT(left_of_gravity(made), 0.06); // rows do not meet behind its corners
}

/// A definition need not reach farther than the walls that it draws.
TEST(TankOfSheets, HasAllItsRowsInADomainThatEndsBesideIt)
{
    const auto tank = [](double beside, const std::string& more, const std::string& fppg)
    {
        CaseText text = case_of(
            R"(<setdrawmode mode="full" /><setmkbound mk="0" /><drawbox><boxfill>bottom | left | right | front | back</boxfill><point x="0" y="0" z="0" /><size x="1" y="0.5" z="0.5" /></drawbox>
<setmkfluid mk="0" />)" +
                more +
                R"(<fillbox x="0.5" y="0.2" z="0.1"><modefill>void</modefill><point x="0" y="0" z="0" /><size x="1" y="0.5" z="0.33" /></fillbox>)",
            fppg);
        text.pointmin = fmt::format(R"(<pointmin x="{0}" y="{0}" z="{0}" />)", -beside);
        text.pointmax =
            fmt::format(R"(<pointmax x="{}" y="{}" z="0.7" />)", 1 + beside, 0.5 + beside);
        Result out = make(text);
        EXPECT_EQ(out.code, 0) << out.output;
        return out;
    };
    for (const std::string boundary : {"dbc", "mdbc"})
    {
        const std::string fppg = R"(<bodyfitted boundary=")" + boundary + R"(" />)";
        const Result wide = tank(5 * dp, "", fppg);
        const Result narrow = tank(1.2 * dp, "", fppg);
        EXPECT_EQ(narrow.bound().size(), wide.bound().size());
        EXPECT_EQ(narrow.fluid().size(), wide.fluid().size());
        EXPECT_LT(left_of_gravity(narrow), 0.003);
        EXPECT_TRUE(contains(narrow.output, "Lattice wider than the domain")) << narrow.output;
        EXPECT_FALSE(contains(wide.output, "Lattice wider than the domain")) << wide.output;
    }
    // The domain cuts what is drawn beyond it.
    const Result cut = tank(
        0.6 * dp,
        R"(<drawbox><boxfill>solid</boxfill><point x="-1" y="0.2" z="0.6" /><size x="0.95" y="0.1" z="0.05" /></drawbox>)",
        R"(<bodyfitted boundary="dbc" />)");
    EXPECT_TRUE(contains(cut.output, "Lattice wider than the domain, by 0, ")) << cut.output;
    EXPECT_TRUE(contains(cut.output, "rows behind this sheet lie beyond the domain")) << cut.output;
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

/// An open cup about z on z = 0: its inner radius at the bottom and at the top, its height and the
/// thickness of its wall and its bottom.
fppg::TriangleSoup cup(double bottom, double top, double height, double wall, int sides = 64)
{
    const std::array<std::pair<double, double>, 6> profile{{{0, 0},
                                                            {bottom + wall, 0},
                                                            {top + wall, height},
                                                            {top, height},
                                                            {bottom, wall},
                                                            {0, wall}}};
    fppg::TriangleSoup out;
    for (std::size_t k = 0; k + 1 < profile.size(); ++k)
        for (int i = 0; i < sides; ++i)
        {
            const auto place = [&](const std::pair<double, double>& of, int side)
            {
                const double angle = 2 * std::numbers::pi * (side % sides) / sides;
                return Vec3{of.first * std::cos(angle), of.first * std::sin(angle), of.second};
            };
            const Vec3 a = place(profile[k], i), b = place(profile[k], i + 1);
            const Vec3 c = place(profile[k + 1], i + 1), d = place(profile[k + 1], i);
            if (profile[k].first > 0) out.vertices.insert(out.vertices.end(), {a, b, c});
            if (profile[k + 1].first > 0) out.vertices.insert(out.vertices.end(), {a, c, d});
        }
    return out;
}

/// Water under mDBC in a cup from a file.
Result filled_cup(const fppg::TriangleSoup& mesh, const std::string& spacing, double level)
{
    const TemporaryFolder folder;
    write_stl(folder / "cup.stl", mesh);
    CaseText text = case_of(
        R"(<setmkbound mk="0" /><drawfilestl file=")" + folder / "cup.stl" + R"(" />)",
        fmt::format(
            R"(<bodyfitted boundary="mdbc" /><fill mkfluid="0" level="{}"><seed x="0.011" y="0.007" z="{}" /></fill>)",
            level, 0.8 * level));
    text.dp = spacing;
    text.pointmin = R"(<pointmin x="-0.4" y="-0.4" z="-0.1" />)";
    text.pointmax = R"(<pointmax x="0.4" y="0.4" z="0.5" />)";
    text.execution = no_penetration;
    Result out = make(text);
    EXPECT_EQ(out.code, 0) << out.output;
    return out;
}

/// Cups of 0.7 and 1.8 dp. The first was thickened to 2 dp, which took a tenth of its volume, and
/// 0.0086 g were left; the second has no room for three layers.
TEST(ThinCup, OfModifiedBoundariesHasAllLayersBehindTheSideWithTheWater)
{
    constexpr double spacing = 0.0114, level = 0.2;
    for (const double wall : {0.00793, 0.0205})
    {
        const Result made = filled_cup(cup(0.108, 0.2345, 0.36, wall), "0.0114", level);
        EXPECT_FALSE(contains(made.output, "thickened to 2 dp")) << made.output;
        EXPECT_TRUE(contains(made.output, "3 rows stand behind that side")) << made.output;
        EXPECT_LT(left_of_gravity(made), 0.002);
        const double end = 0.108 + (0.2345 - 0.108) * (level - wall) / (0.36 - wall);
        const double volume =
            std::numbers::pi / 3 * (level - wall) * (0.108 * 0.108 + 0.108 * end + end * end);
        EXPECT_NEAR(static_cast<double>(made.fluid().size()) * std::pow(spacing, 3) / volume, 1,
                    0.06);
    }
}

/// A pipe on a floor, its wall so many dp thick, with water.
///
/// bored  by a void, as GenCase does it; else by a `<boolean>`
Result pipe_on_floor(double thickness, double spacing, bool bored)
{
    const auto rod = [](const char* name, double radius)
    {
        return fmt::format(
            R"(<drawcylinder fppg:name="{}" radius="{}"><point x="0.6" y="0.5" z="0" /><point x="0.6" y="0.5" z="0.9" /></drawcylinder>)",
            name, radius);
    };
    return make(case_of(
        R"(<setmkbound mk="0" />)" + rod("rod", 0.36 + thickness * spacing) + "<setmkvoid />" +
            rod("bore", 0.36) +
            R"(<setmkbound mk="1" /><drawbox><boxfill>solid</boxfill><point x="0" y="-0.1" z="-0.3" /><size x="1.2" y="1.2" z="0.3" /></drawbox>
<setmkfluid mk="0" /><fillbox x="0.6" y="0.5" z="0.3"><modefill>void</modefill><point x="0.2" y="0.1" z="-0.1" /><size x="0.8" y="0.8" z="0.6" /></fillbox>)",
        std::string(R"(<bodyfitted boundary="mdbc" />)") +
            (bored
                 ? ""
                 : R"(<boolean op="difference" mkbound="0"><part ref="rod" /><part ref="bore" /></boolean>)")));
}

/// Behind their inner side all layers stand, also beyond a wall that has no room for them; evened
/// out, there is as much fluid in the middle of the pipe as its volume holds.
TEST(ThinPipe, CutOutOfARodHasAllLayersBehindTheSideWithTheWater)
{
    constexpr double spacing = 0.05;
    const std::string said = "too thin for the rows of particles that fluid on one side of it";
    for (const auto& [thickness, bored] : {std::pair{4.0, true}, {1.5, true}, {1.5, false}})
    {
        const Result made = pipe_on_floor(thickness, spacing, bored);
        ASSERT_EQ(made.code, 0) << made.output;
        EXPECT_EQ(contains(made.output, said), thickness < 3) << made.output;
        double nearest = 1e9;
        double middle = 0;
        std::array<int, 4> layers{};
        for (const Vec3& p : made.bound())
        {
            const double r = std::hypot(p.x - 0.6, p.y - 0.5);
            if (p.z > 0.1) nearest = std::min(nearest, r);
            if (p.z > 0.2 && p.z < 0.7)
                ++layers[std::min<std::size_t>(3, static_cast<std::size_t>((r - 0.36) / spacing))];
        }
        for (const std::size_t k : {0u, 1u, 2u})
            EXPECT_NEAR(layers[k] * spacing * spacing /
                            (2 * std::numbers::pi *
                             (0.36 + (static_cast<double>(k) + 0.5) * spacing) * 0.5),
                        1, 0.1)
                << k;
        for (const Vec3& p : made.fluid())
            middle += p.z > 0.05 && p.z < 0.3 && std::hypot(p.x - 0.6, p.y - 0.5) < 0.18 ? 1 : 0;
        EXPECT_NEAR(nearest, 0.36 + 0.5 * spacing, 0.01 * spacing);
        EXPECT_NEAR(middle * std::pow(spacing, 3) / (std::numbers::pi * 0.18 * 0.18 * 0.25), 1,
                    0.12);
    }
}

/// Rows that go up a cone part from one another. Relaxation ended while they stood 15 % too thin
/// below and too close above, and 0.005 g were left.
TEST(ThinCup, HasEvenLayersWhereItIsACone)
{
    const Result made = filled_cup(cup(0.0626, 0.1604, 0.3769, 0.0137, 24), "0.00636", 0.29);
    EXPECT_LT(left_of_gravity(made), 0.004);
}

/// Where the lattice is in step with the bottom its nodes stand in the plane of the first layer.
/// One that was far from all particles counted as a place in the wall, and the fill took it.
TEST(Cup, HasNoWaterInItsWall)
{
    constexpr double radius = 0.1800173, wall = 0.0257698;
    const Result made = filled_cup(cup(radius, radius, 0.2964367, wall), "0.00635", 0.035);
    EXPECT_GT(made.fluid().size(), 2000u);
    for (const Vec3& p : made.fluid())
    {
        EXPECT_GT(p.z, wall);
        EXPECT_LT(std::hypot(p.x, p.y), radius);
    }
}

/// Water under mDBC, up to a height, in a tank of sheets with a body from a file.
Result tank_with(const fppg::TriangleSoup& body, double top)
{
    const TemporaryFolder folder;
    write_stl(folder / "body.stl", body);
    CaseText text = case_of(
        R"(<setmkbound mk="0" /><drawbox><boxfill>bottom | left | right | front | back</boxfill><point x="0" y="0" z="0" /><size x="1.475" y="1.3" z="1.1" /></drawbox><setmkbound mk="1" /><drawfilestl file=")" +
            folder / "body.stl" +
            fmt::format(
                R"(" /><setmkfluid mk="0" /><fillbox x="1.3" y="0.2" z="0.2"><modefill>void</modefill><point x="-0.1" y="-0.1" z="-0.1" /><size x="1.7" y="1.5" z="{}" /></fillbox>)",
                top + 0.1),
        R"(<bodyfitted boundary="mdbc" />)");
    text.execution = no_penetration;
    Result out = make(text);
    EXPECT_EQ(out.code, 0) << out.output;
    return out;
}

/// They thickened into the gaps between them, through one another and 2 dp beyond the tips.
TEST(ThinTeeth, AreThickenedAsFarAsTheGapsBetweenThemAreWide)
{
    fppg::TriangleSoup wheel = toothed_wheel(16, 4 * dp, 2.8 * dp, 8 * dp);
    for (Vec3& v : wheel.vertices) v = v + Vec3{0.7, 0.6, 0.55};
    const Result made = tank_with(wheel, 1);
    for (std::size_t i = 0; i < made.cloud.positions.size(); ++i)
    {
        if (made.cloud.mk[i] != first_bound + 1) continue;
        const Vec3 p = made.cloud.positions[i] - Vec3{0.7, 0.6, 0.55};
        EXPECT_LT(std::hypot(p.x, p.y), 4.5 * dp);
        EXPECT_LT(std::abs(p.z), 4.5 * dp);
    }
    EXPECT_FALSE(contains(made.output, "crosses itself")) << made.output;
    constexpr double of_wheel = 0.034; // m3
    EXPECT_NEAR(static_cast<double>(made.fluid().size()) * dp * dp * dp,
                1.475 * 1.3 * 1.0 - of_wheel, 0.02);
}

/// The inside of teeth that no draw fills was taken for space of the water around them.
TEST(FineTeeth, LeaveWaterTheSpaceBetweenThem)
{
    fppg::TriangleSoup wheel = toothed_wheel(24, 9 * dp, 7.2 * dp, 8.4 * dp);
    double volume = 0;
    for (std::size_t i = 0; i < wheel.vertices.size(); i += 3)
        volume += dot(wheel.vertices[i], cross(wheel.vertices[i + 1], wheel.vertices[i + 2])) / 6;
    for (Vec3& v : wheel.vertices) v = v + Vec3{0.7, 0.6, 0.5};
    const Result made = tank_with(wheel, 1);
    const double litres = 1000 * (1.475 * 1.3 - volume); // level of 1 m
    EXPECT_NEAR(made.one("fluid_space")["cavity_litres"].get<double>(), litres, 0.003 * litres);
}

/// What came through a wall between two looks went back to where another particle was by then:
/// pairs of 0.2 dp in the gaps between teeth.
TEST(FineTeeth, HaveNoPairsOfWaterBetweenThem)
{
    for (const double turn : {0.176, 0.205})
    {
        fppg::TriangleSoup wheel = toothed_wheel(16, 9 * dp, 7.2 * dp, 12 * dp);
        for (Vec3& v : wheel.vertices)
            v = Vec3{v.x * std::cos(turn) - v.y * std::sin(turn), -v.z,
                     v.x * std::sin(turn) + v.y * std::cos(turn)} +
                Vec3{0.7, 0.6, 0.5};
        const std::vector<Vec3> fluid = tank_with(wheel, 0.35).fluid();
        ASSERT_GT(fluid.size(), 4000u);
        EXPECT_GT(nearest_pair_dp(fluid), 0.5) << turn;
    }
}

/// A wheel stands in the floor, which goes on between its teeth.
TEST(WaterBesideTeeth, StaysAboveTheFloor)
{
    struct Place
    {
        std::array<Vec3, 3> axes; ///< of the turned wheel, by rows
        double z;
    };
    for (const Place& place : {Place{{{{0.92208, 0.28444, 0.262417},
                                       {-0.38122, 0.550843, 0.742458},
                                       {0.066634, -0.784644, 0.616355}}},
                                     0.05},
                               Place{{{{0.102582, 0.97733, 0.185209},
                                       {0.170711, -0.200726, 0.964659},
                                       {0.979967, -0.06734, -0.187432}}},
                                     0.13}})
    {
        fppg::TriangleSoup wheel = toothed_wheel(8, 0.275, 0.176, 0.38);
        for (Vec3& v : wheel.vertices)
            v = Vec3{dot(place.axes[0], v), dot(place.axes[1], v), dot(place.axes[2], v)} +
                Vec3{0.7, 0.65, place.z};
        const Result made = tank_with(wheel, 0.45);
        EXPECT_GT(made.fluid().size(), 5000u);
        for (const Vec3& p : made.fluid()) EXPECT_GT(p.z, -0.1 * dp) << p.x << ' ' << p.y;
    }
}

/// Water 25 dp deep beside a plate of 2.2 dp that has two layers where water feels four. What it
/// presses against the plate is held by NoPenetration in the solver, and counted as if it fell.
TEST(ThinPlate, UnderNoPenetrationHoldsWater)
{
    CaseText text = case_of(
        R"(<setmkbound mk="0" /><drawbox><boxfill>solid</boxfill><point x="-0.3" y="-0.3" z="-0.3" /><size x="1.01" y="1" z="1.8" /></drawbox>
<setmkvoid /><drawbox><boxfill>solid</boxfill><point x="0" y="0" z="0" /><size x="0.91" y="0.4" z="1.9" /></drawbox>
<setmkbound mk="1" /><drawbox><boxfill>solid</boxfill><point x="0.4" y="-0.15" z="-0.15" /><size x="0.11" y="0.7" z="1.5" /></drawbox>
<setmkfluid mk="0" /><fillbox x="0.2" y="0.2" z="0.6"><modefill>void</modefill><point x="-0.05" y="-0.05" z="-0.05" /><size x="0.5" y="0.5" z="1.3" /></fillbox>)",
        R"(<bodyfitted boundary="mdbc" />)");
    text.constants.replace(text.constants.find(R"(coefh value="1")"), 15, R"(coefh value="1.2")");
    text.pointmax = R"(<pointmax x="0.7" y="0.8" z="1.7" />)";
    text.execution = no_penetration;
    const Result made = make(text);
    ASSERT_EQ(made.code, 0) << made.output;
    EXPECT_LT(left_of_gravity(made), 0.005);
}

/// Its one sheet does not hold the water around it: none in the tank was balanced.
TEST(HollowBodyAfloat, LeavesTheRestOfTheTankAtRest)
{
    const Result made = tank_in_2d(
        R"(<drawbox><boxfill>bottom | top | left | right</boxfill><point x="0.3" y="-0.1" z="0.05" /><size x="0.6" y="0.2" z="0.3" /></drawbox>)",
        {0.1},
        R"(<bodyfitted boundary="dbc" /></fppg><floatings><floating mkbound="1" rhopbody="500" /></floatings><fppg>)",
        "0.02");
    EXPECT_TRUE(contains(made.output, "the walls there do not hold them")) << made.output;
    EXPECT_LT(left_of_gravity(made), 0.01);
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

/// Walls go on beyond both ends of a period; rows in their gaps were there twice.
TEST(PeriodicWalls, HaveEachParticleOfARowInAGapOnce)
{
    CaseText text = case_of(
        R"(<setmkbound mk="0" /><drawbox><boxfill>solid</boxfill><point x="-0.5" y="-0.2" z="-0.2" /><size x="3.1" y="1.2" z="0.2" /></drawbox>
<drawbox><boxfill>solid</boxfill><point x="-0.5" y="-0.2" z="-0.2" /><size x="3.1" y="0.455" z="0.5" /></drawbox><setmkbound mk="1" />
<drawbox><boxfill>solid</boxfill><point x="-0.15" y="0.275" z="0.15" /><size x="0.3" y="0.3" z="0.3" /></drawbox>
<drawbox><boxfill>solid</boxfill><point x="1.95" y="0.275" z="0.15" /><size x="0.3" y="0.3" z="0.3" /></drawbox>)",
        "<bodyfitted />");
    text.pointmin = R"(<pointmin x="0" y="-0.4" z="-0.4" />)";
    text.pointmax = R"(<pointmax x="2.05" y="1.2" z="0.8" />)";
    text.execution =
        R"(<parameters><parameter key="Boundary" value="2" /><parameter key="XPeriodicIncY" value="0" /><parameter key="XPeriodicIncZ" value="0" /></parameters>)";
    const Result made = make(text);
    ASSERT_EQ(made.code, 0) << made.output;
    EXPECT_TRUE(contains(made.output, "close the gap")) << made.output;
    EXPECT_GT(nearest_pair_dp(made.bound()), 0.4);
}

} // namespace
