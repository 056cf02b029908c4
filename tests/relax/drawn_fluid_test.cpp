// Fluid that is drawn into, beside and through fitted walls, and the layers that sheets get by it.

#include "relax/fluid_case.h"

#include <gtest/gtest.h>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <set>
#include <utility>

namespace
{

using namespace fluid_case;

/// Fluid in a tube, both from below to above; `shells` of its wall are drawn.
Result column(double radius, const std::string& shells = "")
{
    return make(case_of(
        fmt::format(
            R"(<setdrawmode mode="face" /><setmkbound mk="0" /><drawcylinder radius="0.1375"><point x="0" y="0" z="0" /><point x="0" y="0" z="0.75" />{}</drawcylinder>
<setdrawmode mode="full" /><setmkfluid mk="0" /><drawcylinder radius="{}"><point x="0" y="0" z="0.1" /><point x="0" y="0" z="0.6" /></drawcylinder>)",
            shells, radius),
        R"(<bodyfitted boundary="mdbc" />)"));
}

/// What is drawn less than half a step into a wall gives way to its first layer.
TEST(DrawnFluid, ThatIsDrawnIntoWallsStandsBeforeThemOrIsWarnedOf)
{
    const std::string said = "more particles than fit between the walls";
    const std::string through = "fluid that is drawn later passes through ";
    for (const auto& [radius, shells] :
         {std::pair{0.16, ""}, {0.19, R"(<layers vdp="0,1,2" />)"}, {0.07, ""}})
    {
        const Result made = column(radius, shells);
        ASSERT_EQ(made.code, 0) << made.output;
        EXPECT_EQ(contains(made.log, said), radius > 0.18) << made.log;
        EXPECT_FALSE(contains(made.log, through)) << made.log;
        if (radius > 0.18) continue;
        EXPECT_GT(made.fluid().size(), 30u);
        for (const Vec3& p : made.fluid())
            EXPECT_LT(std::hypot(p.x, p.y), 0.1375 - 0.3 * dp) << radius;
    }
}

/// GenCase rounds a radius of 6.5 dp to 7, and of 7.5 to 8: fluid a step inside a tube has nodes
/// within half a step of the true tube. It took two of five particles of the tube's wall, and
/// leaked.
TEST(DrawnFluid, ThatIsDrawnAStepOffAWallTakesNothingOfIt)
{
    const auto wall = [](const std::string& boundary, double radius)
    {
        const Result made = make(case_of(
            fmt::format(
                R"(<setdrawmode mode="face" /><setmkbound mk="0" /><drawcylinder radius="0.375"><point x="0.6" y="0.5" z="0" /><point x="0.6" y="0.5" z="0.75" /></drawcylinder>
<setdrawmode mode="full" /><setmkfluid mk="0" /><drawcylinder radius="{}"><point x="0.6" y="0.5" z="0.1" /><point x="0.6" y="0.5" z="0.6" /></drawcylinder>)",
                radius),
            R"(<bodyfitted boundary=")" + boundary + R"(" />)"));
        EXPECT_EQ(made.code, 0) << made.output;
        EXPECT_GT(made.fluid().size(), 10u);
        return made.bound().size();
    };
    for (const char* boundary : {"dbc", "mdbc"})
        EXPECT_EQ(wall(boundary, 0.325), wall(boundary, 0.1)) << boundary;
}

/// As users draw pipes: a rod, its bore as a void, and the fluid of the same radius. The nodes of
/// bore and fluid reach half a step into the wall: fluid stood there, and nodes of the wall lacked.
TEST(DrawnFluid, ThatFillsABoreTakesNothingOfItsWall)
{
    const auto pipe = [](const std::string& fluid)
    {
        return make(case_of(
            R"(<setdrawmode mode="full" /><setmkbound mk="0" /><drawcylinder radius="0.5"><point x="0.6" y="0.5" z="0" /><point x="0.6" y="0.5" z="0.75" /></drawcylinder>)" +
                fluid,
            R"(<bodyfitted boundary="dbc" />)"));
    };
    const auto bore = [](const std::string& mk)
    {
        return mk +
               R"(<drawcylinder radius="0.325"><point x="0.6" y="0.5" z="0.2" /><point x="0.6" y="0.5" z="0.6" /></drawcylinder>)";
    };
    const std::string empty = "<setmkvoid />", full = R"(<setmkfluid mk="0" />)";
    const Result drawn = pipe(bore(full)), both = pipe(bore(empty) + bore(full));
    const double turn = 2 * std::numbers::pi;
    const double volume = turn / 2 * (0.5 * 0.5 * 0.75 - 0.325 * 0.325 * 0.4);
    const double area = turn * (0.5 * 0.75 + 0.325 * 0.4 + 0.5 * 0.5 + 0.325 * 0.325);
    // Particles of the surface stand for half.
    const double wall = volume / (dp * dp * dp) + 0.5 * area / (dp * dp);
    for (const Result& made : {drawn, both})
    {
        ASSERT_EQ(made.code, 0) << made.output;
        EXPECT_GT(made.fluid().size(), 300u);
        for (const Vec3& p : made.fluid())
            EXPECT_LT(std::hypot(p.x - 0.6, p.y - 0.5), 0.325 - 0.5 * dp + 1e-6);
        EXPECT_NEAR(static_cast<double>(made.bound().size()), wall, 0.03 * wall);
    }
}

/// On the lattice fluid takes the nodes of walls that were drawn before it: where it covers them on
/// both sides no wall is left.
TEST(DrawnFluid, ThatIsDrawnThroughASheetLeavesNoWallThere)
{
    const Result made = column(0.18);
    ASSERT_EQ(made.code, 0) << made.output;
    // 0.5 of 0.75 m of a tube with two covers: 56.3 % of a round one.
    EXPECT_TRUE(contains(made.log, "passes through 56.")) << made.log;
    int above = 0, below = 0;
    for (const Vec3& p : made.bound())
    {
        above += p.z > 0.6 - 0.01 * dp ? 1 : 0;
        below += p.z < 0.1 + 0.01 * dp ? 1 : 0;
    }
    EXPECT_GT(above, 100);
    EXPECT_GT(below, 100);
    EXPECT_EQ(above + below, static_cast<int>(made.bound().size()));
}

/// Particles of the walls behind the planes of a tank of 0.8 x 0.6 m, 0.6 m high, by the layers
/// that they stand in, up to the level of its water.
std::array<int, 4> layers_of_tank(const Result& made)
{
    std::array<int, 4> out{};
    for (const Vec3& p : made.bound())
    {
        const double beyond = std::max({-p.x, p.x - 0.8, -p.y, p.y - 0.6, -p.z, 0.0}) / dp;
        if (p.z < 0.45 && std::abs(beyond - std::round(beyond)) < 0.1)
            ++out[static_cast<std::size_t>(std::min(3.0, std::round(beyond)))];
    }
    return out;
}

const std::string tank =
    R"(<setdrawmode mode="face" /><setmkbound mk="0" /><drawbox><boxfill>all^top</boxfill><point x="0" y="0" z="0" /><size x="0.8" y="0.6" z="0.6" /></drawbox>)";
const std::string water =
    R"(<setmkfluid mk="0" /><fillbox x="0.1" y="0.3" z="0.3"><modefill>void</modefill><point x="0" y="0" z="0" /><size x="0.8" y="0.6" z="0.42" /></fillbox>)";

/// One sheet of dynamic boundaries does not hold fluid at rest; two do, in the solver.
TEST(SheetLayers, StandOnTheDrySideOfTanks)
{
    const Result wet = make(case_of(tank + water, "<bodyfitted />"));
    ASSERT_EQ(wet.code, 0) << wet.output;
    const std::array<int, 4> layers = layers_of_tank(wet);
    EXPECT_GT(layers[0], 300);
    EXPECT_GT(layers[1], layers[0]);
    EXPECT_GT(layers[2], layers[1]);
    EXPECT_EQ(layers[3], 0);
    EXPECT_TRUE(contains(wet.log, "Balanced fluid")) << wet.log;
    for (const auto& [mainlist, fitted] :
         {std::pair{tank, "<bodyfitted />"}, {tank + water, R"(<bodyfitted layers="1" />)"}})
    {
        const Result one = make(case_of(mainlist, fitted));
        ASSERT_EQ(one.code, 0) << one.output;
        EXPECT_EQ(layers_of_tank(one)[1] + layers_of_tank(one)[2], 0) << fitted;
    }
}

TEST(SheetLayers, AreLeftOutWhereFluidIsOnBothSides)
{
    // A partition that the fill goes round, lower than the water.
    const std::string partition =
        R"(<setdrawmode mode="face" /><setmkbound mk="1" /><drawbox><boxfill>left</boxfill><point x="0.425" y="0" z="0" /><size x="0.1" y="0.6" z="0.25" /></drawbox>)";
    const auto is_of_partition = [](const Vec3& p)
    { return p.x > 0.2 && p.x < 0.6 && p.y > 0.1 && p.y < 0.5 && p.z > 0.1; };
    const Result made = make(case_of(tank + partition + water, "<bodyfitted />"));
    ASSERT_EQ(made.code, 0) << made.output;
    EXPECT_GT(layers_of_tank(made)[1], 300);
    int count = 0;
    for (const Vec3& p : made.bound())
    {
        if (!is_of_partition(p)) continue;
        ++count;
        EXPECT_NEAR(p.x, 0.425, 1e-9);
    }
    EXPECT_GT(count, 10);
}

/// Fluid comes in between layers of what is jerked by more than a thirtieth of the speed of sound,
/// which is 39 m/s here.
TEST(SheetLayers, AreForWhatMovesSlowly)
{
    const auto made_with = [](const std::string& movement)
    {
        CaseText text = case_of(tank + water, "<bodyfitted />");
        text.after_geometry += R"(<motion><objreal ref="0"><begin mov="1" start="0" />)" +
                               movement + "</objreal></motion>";
        return make(text);
    };
    const auto turn = [](double degrees_per_second)
    {
        return fmt::format(
            R"(<mvrot id="1" duration="1" anglesunits="degrees"><vel ang="{}" /><axisp1 x="0.4" y="0.3" z="0" /><axisp2 x="0.4" y="0.3" z="1" /></mvrot>)",
            degrees_per_second);
    };
    const std::string slow = R"(<mvrect id="1" duration="1"><vel x="1" y="0" z="0" /></mvrect>)";
    const std::string fast = R"(<mvrect id="1" duration="1"><vel x="2" y="0" z="0" /></mvrect>)";
    // Corners of the tank are 0.5 m from the axis.
    for (const auto& [movement, layers_it] :
         {std::pair{slow, true}, std::pair{fast, false}, std::pair{turn(120), true},
          std::pair{turn(200), false}})
    {
        const Result made = made_with(movement);
        ASSERT_EQ(made.code, 0) << made.output;
        const std::array<int, 4> layers = layers_of_tank(made);
        EXPECT_GT(layers[0], 300);
        if (layers_it)
            EXPECT_GT(layers[2], layers[1]) << movement;
        else
            EXPECT_EQ(layers[1] + layers[2], 0) << movement;
    }
}

/// Of a hollow ball, how many of its particles stand on its surface and how many within.
std::array<int, 2> shell_of_ball(const std::string& more)
{
    constexpr double radius = 0.15;
    const std::string ball = fmt::format(
        R"(<setdrawmode mode="face" /><setmkbound mk="1" /><drawsphere radius="{}"><point x="0.4" y="0.3" z="0.35" /></drawsphere>)",
        radius);
    CaseText text = case_of(tank + ball + water, "<bodyfitted />");
    text.after_geometry += more;
    const Result made = make(text);
    EXPECT_EQ(made.code, 0) << made.output;
    std::array<int, 2> out{};
    for (const Vec3& p : made.bound())
        if (const double r = norm(p - Vec3{0.4, 0.3, 0.35}); r < radius + 0.1 * dp)
            ++out[r > radius - 0.1 * dp ? 0 : 1];
    return out;
}

/// A mass that particles make is that of one layer.
TEST(SheetLayers, AreForHollowBodiesAfloatWithAMassOfTheirOwn)
{
    const std::array<int, 2> given = shell_of_ball(
        R"(<floatings><floating mkbound="1"><massbody value="5" /></floating></floatings>)");
    EXPECT_GT(given[0], 100);
    EXPECT_GT(given[1], 50);
    const std::array<int, 2> made =
        shell_of_ball(R"(<floatings><floating mkbound="1" rhopbody="500" /></floatings>)");
    EXPECT_GT(made[0], 100);
    EXPECT_EQ(made[1], 0);
}

/// What is before the other side of a thin shell is no fluid within it.
TEST(SheetLayers, AreInThinHollowBodiesInFluid)
{
    const Result made = make(case_of(
        tank +
            R"(<setdrawmode mode="face" /><setmkbound mk="1" /><drawbox><boxfill>all</boxfill><point x="0.36" y="0.14" z="0.15" /><size x="0.11" y="0.31" z="0.3" /></drawbox>)" +
            water,
        "<bodyfitted />"));
    ASSERT_EQ(made.code, 0) << made.output;
    int inside = 0;
    for (const Vec3& p : made.bound())
        if (p.x > 0.37 && p.x < 0.46 && p.y > 0.2 && p.y < 0.4 && p.z > 0.2 && p.z < 0.4) ++inside;
    EXPECT_GT(inside, 10);
}

/// Layers behind the surface of hollow balls that are united stand in both.
TEST(SheetLayers, AreInHollowBooleansInFluid)
{
    const auto ball = [](const char* name, double x)
    {
        return fmt::format(
            R"(<drawsphere fppg:name="{}" radius="0.15"><point x="{}" y="0.3" z="0.3" /></drawsphere>)",
            name, x);
    };
    const Result made = make(case_of(
        tank + R"(<setdrawmode mode="face" /><setmkbound mk="1" />)" + ball("A", 0.32) +
            ball("B", 0.48) + water,
        R"(<bodyfitted /><boolean op="union" mkbound="1"><part ref="A" /><part ref="B" /></boolean>)"));
    ASSERT_EQ(made.code, 0) << made.output;
    std::array<int, 2> inside{};
    for (const Vec3& p : made.bound())
        for (const std::size_t k : {0u, 1u})
            if (const double depth = 0.15 - norm(p - Vec3{k == 0 ? 0.32 : 0.48, 0.3, 0.3});
                depth > 0.6 * dp && (p.x < 0.4) == (k == 0))
                ++inside[k];
    EXPECT_GT(inside[0], 20);
    EXPECT_GT(inside[1], 20);
}

/// Water behind a gate of one dp in a tank of faces. What floats keeps its volume.
TEST(ThinWalls, OfMdbcKeepFluidAStepOffTheirParticles)
{
    const std::string gate =
        R"(<setdrawmode mode="face" /><setmkbound mk="0" /><drawbox><boxfill>all^top</boxfill><point x="0" y="0" z="0" /><size x="1.2" y="0.8" z="0.8" /></drawbox>
<setdrawmode mode="full" /><setmkfluid mk="0" /><drawbox><boxfill>solid</boxfill><point x="0.05" y="0.05" z="0.05" /><size x="0.5" y="0.7" z="0.5" /></drawbox>
<setmkbound mk="1" /><drawbox><boxfill>solid</boxfill><point x="0.6" y="0" z="0" /><size x="0.05" y="0.8" z="0.7" /></drawbox>)";
    for (const bool floats : {false, true})
    {
        CaseText text = case_of(gate, R"(<bodyfitted boundary="mdbc" />)");
        if (floats)
            text.after_geometry +=
                R"(<floatings><floating mkbound="1"><massbody value="1" /></floating></floatings>)";
        const Result made = make(text);
        ASSERT_EQ(made.code, 0) << made.output;
        EXPECT_EQ(contains(made.output, "it is thickened to 2 dp, 0.1 m"), !floats) << made.output;
        std::set<long> sheets;
        double end = 0;
        for (std::size_t i = 0; i < made.cloud.positions.size(); ++i)
        {
            const double x = made.cloud.positions[i].x;
            if (made.cloud.mk[i] == first_bound + 1)
                sheets.insert(std::lround((x - 0.625) / dp * 10));
            if (made.cloud.mk[i] < first_bound) end = std::max(end, x);
        }
        EXPECT_EQ(sheets, floats ? (std::set<long>{0}) : (std::set<long>{-5, 5}));
        EXPECT_NEAR(end, 0.625 - (floats ? 1 : 1.5) * dp, 0.1 * dp);
    }
}

/// Slabs that overlap by half a step: the layers of the floor end where those of its walls go on,
/// and do not spread under them.
TEST(WallLayers, EndWhereThoseOfAnotherBodyGoOn)
{
    const auto slab = [](const std::string& low, const std::string& size) {
        return "<drawbox><boxfill>solid</boxfill><point " + low + " /><size " + size +
               " /></drawbox>";
    };
    std::array<double, 2> count{};
    for (const bool relaxes : {false, true})
    {
        const Result made = make(
            case_of(R"(<setmkbound mk="0" />)" +
                        slab(R"(x="0" y="0" z="-0.025")", R"(x="1.2" y="0.8" z="0.1")") +
                        R"(<setmkbound mk="1" />)" +
                        slab(R"(x="-0.025" y="0" z="0")", R"(x="0.1" y="0.8" z="0.6")") +
                        slab(R"(x="0" y="-0.025" z="0")", R"(x="1.2" y="0.1" z="0.6")") +
                        slab(R"(x="0" y="0.725" z="0")", R"(x="1.2" y="0.1" z="0.6")"),
                    fmt::format(R"(<bodyfitted boundary="mdbc"><relax active="{}" /></bodyfitted>)",
                                relaxes)));
        ASSERT_EQ(made.code, 0) << made.output;
        for (std::size_t i = 0; i < made.cloud.positions.size(); ++i)
        {
            if (made.cloud.mk[i] != first_bound) continue;
            ++count[relaxes ? 1 : 0];
            EXPECT_GT(made.cloud.positions[i].x, 0.075 - dp);
            EXPECT_GT(made.cloud.positions[i].y, 0.075 - dp);
        }
    }
    EXPECT_GT(count[0], 500);
    EXPECT_NEAR(count[1] / count[0], 1, 0.2);
}

/// Shells that thicken a wall into the room of its fluid, of which layers take the place: the
/// innermost is where fluid stood on the lattice. Around a block in fluid it is the outermost.
TEST(ShellsOfALayeredWall, HaveItsSurfaceWhereFluidIs)
{
    const std::string shells = R"(<layers vdp="0,-1,-2" />)";
    const std::string tubes[] = {
        R"(<drawcylinder radius="0.4" mask="2"><point x="0.6" y="0.5" z="0" /><point x="0.6" y="0.5" z="0.9" />)" +
            shells + "</drawcylinder>",
        R"(<drawbox><boxfill>all^top</boxfill><point x="0.2" y="0.1" z="0" /><size x="0.8" y="0.8" z="0.9" />)" +
            shells + "</drawbox>"};
    for (const std::string& tube : tubes)
    {
        const Result made = make(case_of(
            R"(<setdrawmode mode="face" /><setmkbound mk="0" />)" + tube +
                R"(<setmkfluid mk="0" /><fillbox x="0.6" y="0.5" z="0.4"><modefill>void</modefill><point x="0" y="-0.1" z="-0.1" /><size x="1.2" y="1.2" z="0.7" /></fillbox>)",
            R"(<bodyfitted boundary="mdbc" />)"));
        ASSERT_EQ(made.code, 0) << made.output;
        EXPECT_TRUE(contains(made.output, "fluid is within it")) << made.output;
        double nearest = 1e9;
        for (const Vec3& p : made.bound())
            if (std::abs(p.y - 0.5) < dp && p.z > 0.4)
                nearest = std::min(nearest, std::abs(p.x - 0.6));
        EXPECT_NEAR(nearest, 0.3 + dp / 2, 0.3 * dp);
    }
    const Result made = make(case_of(
        tank +
            R"(<setmkbound mk="1" /><drawbox><boxfill>all</boxfill><point x="0.5" y="0.2" z="0" /><size x="0.2" y="0.2" z="0.5" />)" +
            shells + "</drawbox>" + water,
        R"(<bodyfitted boundary="mdbc" />)"));
    ASSERT_EQ(made.code, 0) << made.output;
    EXPECT_FALSE(contains(made.output, "fluid is within it")) << made.output;
}

/// A warning says where fitted walls leave much more or less room than GenCase's do.
TEST(LatticeFluid, IsComparedWithThatBesideFittedWalls)
{
    const std::string said = "on the lattice, as GenCase draws the case, it has ";
    const Result made = column(0.16);
    ASSERT_EQ(made.code, 0) << made.output;
    const std::size_t at = made.log.find(said);
    ASSERT_NE(at, std::string::npos) << made.log;
    EXPECT_EQ(std::stoul(made.log.substr(at + said.size())), 407u); // as GenCase v5.0 has
    EXPECT_NEAR(static_cast<double>(made.fluid().size()), 276, 10);
    const Result box = make(case_of(tank + water, "<bodyfitted />"));
    EXPECT_FALSE(contains(box.log, said)) << box.log;
}

/// Fluid drawn a little into the floor of a case whose lattice does not move, as a pile stands on
/// it: its lowest row stayed between the surface and the first layer.
TEST(DrawnFluid, StandsBeforeTheLayersOfAWallThatItIsDrawnInto)
{
    for (const double top : {0.01, 0.02, 0.024})
    {
        const Result made = make(case_of(
            fmt::format(
                R"(<setmkbound mk="1" /><drawbox><boxfill>solid</boxfill><point x="-0.2" y="-0.2" z="-0.3" /><size x="1.6" y="1.4" z="{}" /></drawbox>
<setmkbound mk="0" /><drawbox><boxfill>solid</boxfill><point x="1" y="0.8" z="0.1" /><size x="0.1" y="0.1" z="0.4" /></drawbox>
<setmkfluid mk="0" /><drawbox><boxfill>solid</boxfill><point x="0" y="0" z="0" /><size x="0.8" y="0.6" z="0.4" /></drawbox>)",
                0.3 + top),
            R"(<bodyfitted mkbound="1" boundary="mdbc" />)"));
        ASSERT_EQ(made.code, 0) << made.output;
        ASSERT_FALSE(contains(made.output, "Lattice moved"));
        double lowest = 1e9;
        for (const Vec3& p : made.fluid()) lowest = std::min(lowest, p.z);
        EXPECT_GT(lowest, top + 0.2 * dp) << top;
        EXPECT_LT(lowest, top + 0.8 * dp) << top;
    }
}

/// Solid mode draws no surface nodes. Of a box that ends between nodes of the moved lattice it took
/// away the outermost rows: three of five particles of water 3 dp deep.
TEST(DrawnFluid, FillsItsBoxOnAMovedLatticeInSolidModeToo)
{
    for (const char* mode : {"solid", "full"})
    {
        const Result made = make(case_of(
            fmt::format(
                R"(<setdrawmode mode="{}" /><setmkfluid mk="0" /><drawbox><boxfill>solid</boxfill><point x="0" y="0" z="0" /><size x="1" y="0.6" z="0.15" /></drawbox>
<setdrawmode mode="face" /><setmkbound mk="0" /><drawbox><boxfill>all^top</boxfill><point x="0" y="0" z="0" /><size x="1" y="0.6" z="0.5" /></drawbox>)",
                mode),
            R"(<bodyfitted boundary="mdbc" />)"));
        ASSERT_EQ(made.code, 0) << made.output;
        EXPECT_TRUE(contains(made.output, "Lattice moved"));
        EXPECT_EQ(made.fluid().size(), 20u * 12 * 3) << mode;
    }
}

/// Walls of dynamic boundaries that lie halfway between nodes: fluid half a step off them was moved
/// to a whole one, which crowds some rows and tears others (solver: 3 g beside walls 200 dp deep).
TEST(DrawnFluid, StandsInStepWithFlatWallsOfDynamicBoundaries)
{
    const std::string fluid =
        R"(<setmkfluid mk="0" /><drawbox><boxfill>solid</boxfill><point x="0.025" y="0.025" z="0.025" /><size x="1" y="0.6" z="0.4" /></drawbox>)";
    const Result made = make(case_of(
        R"(<setmkbound mk="0" /><drawbox><boxfill>solid</boxfill><point x="-0.175" y="-0.175" z="-0.175" /><size x="1.4" y="1" z="0.8" /></drawbox>
<setmkvoid /><drawbox><boxfill>solid</boxfill><point x="0.025" y="0.025" z="0.025" /><size x="1" y="0.6" z="1" /></drawbox>)" +
            fluid,
        R"(<bodyfitted /><fluidband balance="false" />)"));
    ASSERT_EQ(made.code, 0) << made.output;
    EXPECT_TRUE(contains(made.output, "Lattice moved by (0.025, 0.025, 0.025) m"));
    double off = 0;
    for (const Vec3& p : made.fluid())
        for (const double x : {p.x, p.y, p.z})
        {
            const double at = (x - 0.025) / dp;
            off = std::max(off, std::abs(at - std::round(at)));
        }
    EXPECT_LT(off, 0.1);
    EXPECT_EQ(made.fluid().size(), 19u * 11 * 8);
    // So do the particles of the floor.
    std::size_t floor = 0;
    for (const Vec3& p : made.bound())
        if (std::abs(p.z - 0.025) < 1e-9 && p.x > 0.05 && p.x < 1 && p.y > 0.05 && p.y < 0.6)
        {
            EXPECT_LT(std::abs(std::remainder(p.x - 0.025, dp)), 1e-6);
            EXPECT_LT(std::abs(std::remainder(p.y - 0.025, dp)), 1e-6);
            ++floor;
        }
    EXPECT_EQ(floor, 19u * 11);
}

/// Fluid that is drawn a little more than a step off its walls lacked its first row on the moved
/// lattice, as the row lies beyond its end; the nearest node is taken on one that stays.
TEST(DrawnFluid, HasTheRowBesideAWallThatItEndsShortOf)
{
    const std::string walls =
        R"(<setmkbound mk="0" /><drawbox><boxfill>bottom | left | right | front | back</boxfill><point x="0.025" y="0.025" z="0.025" /><size x="1" y="0.6" z="0.8" /></drawbox><setmkfluid mk="0" />)";
    const std::string fluid = fmt::format(
        R"(<drawbox><boxfill>solid</boxfill><point x="{0}" y="{0}" z="{0}" /><size x="{1}" y="{2}" z="0.35" /></drawbox>)",
        0.025 + 1.2 * dp, 1 - 2.4 * dp, 0.6 - 2.4 * dp);
    const Result made =
        make(case_of(walls + fluid, R"(<bodyfitted layers="1" /><fluidband balance="false" />)"));
    ASSERT_EQ(made.code, 0) << made.output;
    EXPECT_TRUE(contains(made.output, "Lattice moved by (0.025, 0.025, 0.025) m"));
    EXPECT_EQ(made.fluid().size(), 19u * 11 * 8);
}

/// Walls that are no whole number of dp apart: rows of dp fit to one side alone, and those beside
/// the other were pushed together or pulled apart (solver: 0.0043 m/s after 0.1 s in such a tank 20
/// dp deep, 0.0020 stretched).
TEST(DrawnFluid, StandsInStepWithTheWallsOfBothSides)
{
    struct Walls
    {
        std::string fppg;
        double depth; ///< of their first particles, metres
    };
    for (const Walls& walls :
         {Walls{"<bodyfitted /><fluidband balance=\"false\" />", 0},
          Walls{"<bodyfitted boundary=\"mdbc\" /><fluidband balance=\"false\" />", dp / 2}})
    {
        const double wide = 20.3 * dp;
        const double deep = 12.4 * dp;
        const Result made = make(case_of(
            fmt::format(
                R"(<setmkbound mk="0" /><drawbox><boxfill>solid</boxfill><point x="-0.2" y="-0.2" z="-0.2" /><size x="{}" y="{}" z="0.8" /></drawbox>
<setmkvoid /><drawbox><boxfill>solid</boxfill><point x="0" y="0" z="0" /><size x="{}" y="{}" z="1" /></drawbox>
<setmkfluid mk="0" /><drawbox><boxfill>solid</boxfill><point x="0" y="0" z="0" /><size x="{}" y="{}" z="0.4" /></drawbox>)",
                wide + 0.4, deep + 0.4, wide, deep, wide, deep),
            walls.fppg));
        ASSERT_EQ(made.code, 0) << made.output;
        ASSERT_TRUE(contains(made.output, "Lattice stretched by")) << made.output;
        // A whole number of rows between the particles of both walls, and a particle has dp^3.
        const double step_x =
            (wide + 2 * walls.depth) / std::round(wide / dp + 2 * walls.depth / dp);
        const double step_y =
            (deep + 2 * walls.depth) / std::round(deep / dp + 2 * walls.depth / dp);
        EXPECT_NEAR(made.step(0), step_x, 1e-9);
        EXPECT_NEAR(made.step(1), step_y, 1e-9);
        EXPECT_NEAR(made.step(0) * made.step(1) * made.step(2) / (dp * dp * dp), 1, 0.005);
        double off = 0;
        for (const Vec3& p : made.fluid())
            for (int axis = 0; axis < 3; ++axis)
            {
                const double at =
                    (p[axis] + walls.depth) / made.step(static_cast<std::size_t>(axis));
                off = std::max(off, std::abs(at - std::round(at)));
            }
        EXPECT_LT(off, 0.12) << walls.fppg;
        // Beside walls of DBC, whose particles stand on the surface, a row less.
        EXPECT_EQ(made.fluid().size(), (walls.depth > 0 ? 20u * 12 : 19u * 11) * 8) << walls.fppg;
    }
}

/// A ramp whose sides alone are drawn, open at its ends: at its toe of 34 degrees layers of both
/// faces come together. They left it out as far as their first one was from its edge, 1.7 dp, and
/// water came in there.
TEST(SheetLayers, OfMdbcReachASharpEdge)
{
    const Result made = make(case_of(
        R"(<setmkbound mk="0" /><drawextrude closed="true"><extrude x="0" y="0.75" z="0" /><point x="0.2" y="0.1" z="0" /><point x="0.95" y="0.1" z="0" /><point x="0.95" y="0.1" z="0.5" /></drawextrude>)",
        R"(<bodyfitted boundary="mdbc" side="behind" />)"));
    ASSERT_EQ(made.code, 0) << made.output;
    for (double y = 0.2; y < 0.76; y += dp)
    {
        double nearest = 1;
        for (const Vec3& p : made.bound())
            nearest = std::min(nearest, fppg::norm(p - Vec3{0.2, y, 0}));
        EXPECT_LT(nearest, dp) << y;
    }
}

} // namespace
