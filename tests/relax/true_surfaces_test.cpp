// Walls for mDBC that a case draws twice: as the surface that normals lead to, and on nodes behind
// it.

#include "relax/fluid_case.h"

#include <gtest/gtest.h>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

namespace
{

using namespace fluid_case;

/// A tank of 1 m with water 0.5 m deep. Its surface is drawn for normals so many dp before its
/// walls.
CaseText drawn_twice(double before_dp, bool is_2d = false)
{
    const std::string box =
        R"(<drawbox><boxfill>{}</boxfill><point x="0" y="{}" z="0" /><size x="1" y="1" z="1" /><layers vdp="{}" /></drawbox>)";
    const std::string sides = is_2d ? "bottom|left|right" : "bottom|left|right|front|back";
    const std::string y = is_2d ? "-0.3" : "0";
    CaseText text = case_of(
        R"(<setactive drawpoints="0" drawshapes="1" /><setshapemode>actual | bound</setshapemode><setnormalinvert invert="true" /><setmkbound mk="0" />)" +
            fmt::format(fmt::runtime(box), sides, y, -before_dp) +
            R"(<shapeout file="hdp" /><resetdraw /><setactive drawpoints="1" drawshapes="1" /><setnormalinvert invert="false" /><setmkbound mk="0" />)" +
            fmt::format(fmt::runtime(box), sides, y, "0,1,2") +
            R"(<setmkfluid mk="0" /><fillbox x="0.5" y="0.5" z="0.2"><modefill>void</modefill><point x="-0.1" y="-0.1" z="-0.1" /><size x="1.2" y="1.2" z="0.6" /></fillbox>)",
        R"(<bodyfitted /><fluidband packing="cubic" />)"); // whose rows keep their level
    text.after_geometry +=
        R"(<normals><norgeometry><distanceh v="2" /><geometryfile file="[CaseName]_hdp_Actual.vtk" /></norgeometry></normals>)";
    text.execution =
        R"(<parameters><parameter key="Boundary" value="2" /><parameter key="SlipMode" value="2" /><parameter key="NoPenetration" value="1" /></parameters>)";
    if (is_2d)
    {
        text.pointmin = R"(<pointmin x="-0.4" y="0.5" z="-0.4" />)";
        text.pointmax = R"(<pointmax x="1.7" y="0.5" z="1.5" />)";
    }
    return text;
}

/// As the public cases for mDBC draw them. With walls on the surface of their nodes there was room
/// for a tenth more water, in a tank of 20 dp.
TEST(TrueSurfaces, AreThoseThatWallsDrawForNormals)
{
    for (const bool is_2d : {false, true})
    {
        const Result made = make(drawn_twice(0.5, is_2d));
        ASSERT_EQ(made.code, 0) << made.output;
        EXPECT_TRUE(contains(made.log, "its surface is that for normals")) << made.log;
        EXPECT_FALSE(contains(made.log, "is not where the walls are drawn")) << made.log;
        ASSERT_GT(made.fluid().size(), 100u);
        double lowest = 1, bound = -1;
        for (const Vec3& p : made.fluid())
        {
            lowest = std::min(lowest, p.z);
            // The two highest rows, whose height is kept, are balanced a little nearer: 0.87 dp.
            const bool is_high = p.z > made.level() - 2 * dp;
            EXPECT_GT(std::min(p.x, 1 - p.x), (is_high ? 0.85 : 0.9) * dp);
        }
        for (const Vec3& p : made.bound())
            if (std::abs(p.x - 0.5) < 0.3) bound = std::max(bound, p.z);
        EXPECT_NEAR(lowest, dp, 0.1 * dp) << is_2d;
        if (is_2d)
        {
            EXPECT_NEAR(bound, 0, 0.01 * dp);
        }
        const double width = 1 - dp;
        const double cells = is_2d ? width / dp : width * width / (dp * dp);
        const double depth = static_cast<double>(made.fluid().size()) / cells * dp;
        EXPECT_NEAR(depth, made.level() - 0.5 * dp, 0.05 * dp) << is_2d;
    }
}

/// A solid block stands in the tank, of which the surface has the sides alone.
TEST(TrueSurfaces, OfSolidsMayBeDrawnAsFaces)
{
    const std::string block =
        R"(<setnormalinvert invert="false" /><setmkbound mk="1" /><drawbox><boxfill>{}</boxfill><point x="0.3" y="0.3" z="0.25" /><size x="0.4" y="0.4" z="0.4" />{}</drawbox>)";
    for (const char* sides : {"solid", "all", "all^bottom"})
    {
        CaseText text = drawn_twice(0.5);
        const auto insert = [&](const std::string& before, const std::string& part)
        { text.mainlist.insert(text.mainlist.find(before), part); };
        insert("<shapeout", fmt::format(fmt::runtime(block), sides, R"(<layers vdp="0.5" />)"));
        insert("<setmkfluid", fmt::format(fmt::runtime(block), "solid", ""));
        const Result made = make(text);
        ASSERT_EQ(made.code, 0) << made.output;
        EXPECT_FALSE(contains(made.log, "is not where the walls are drawn")) << made.log;
        fppg::Box3 box;
        for (std::size_t i = 0; i < made.cloud.positions.size(); ++i)
            if (made.cloud.mk[i] == first_bound + 1) box.add(made.cloud.positions[i]);
        for (const int axis : {0, 1})
        {
            EXPECT_NEAR(box.min[axis], 0.3, 0.01 * dp) << sides;
            EXPECT_NEAR(box.max[axis], 0.7, 0.01 * dp) << sides;
        }
        EXPECT_NEAR(box.max.z, 0.65, 0.01 * dp) << sides;
    }
}

/// The piston of the public CaseWavesFrCylinder has its surface in another file than the tank.
TEST(TrueSurfaces, MayBeInAnotherShapeFile)
{
    CaseText text = drawn_twice(0.5);
    const auto insert = [&](const std::string& before, const std::string& part)
    { text.mainlist.insert(text.mainlist.find(before), part); };
    const std::string block =
        R"(<setnormalinvert invert="false" /><setmkbound mk="1" /><drawbox><boxfill>solid</boxfill><point x="0.3" y="0.3" z="0.25" /><size x="0.4" y="0.4" z="0.4" />{}</drawbox>)";
    insert("<resetdraw", fmt::format(fmt::runtime(block), R"(<layers vdp="0.5" />)") +
                             R"(<shapeout file="other" />)");
    insert("<setmkfluid", fmt::format(fmt::runtime(block), ""));
    const Result made = make(text);
    ASSERT_EQ(made.code, 0) << made.output;
    fppg::Box3 box;
    for (std::size_t i = 0; i < made.cloud.positions.size(); ++i)
        if (made.cloud.mk[i] == first_bound + 1) box.add(made.cloud.positions[i]);
    EXPECT_NEAR(box.min.x, 0.3, 0.01 * dp);
    EXPECT_NEAR(box.max.z, 0.65, 0.01 * dp);
}

/// A post without a surface for normals, drawn onto the nodes of the floor, stood half a dp deep in
/// it and lacked its lowest row: fluid went under it.
TEST(TrueSurfaces, CarryWhatIsDrawnOntoTheirNodes)
{
    const std::string block =
        R"(<drawbox><boxfill>solid</boxfill><point x="0.3" y="0.3" z="0" /><size x="0.4" y="0.4" z="0.8" /></drawbox>)";
    const std::string pile =
        R"(<drawcylinder radius="0.2"><point x="0.5" y="0.5" z="0" /><point x="0.5" y="0.5" z="0.8" /></drawcylinder>)";
    for (const auto& [post, is_2d] :
         {std::pair{block, false}, std::pair{block, true}, std::pair{pile, false}})
    {
        CaseText text = drawn_twice(0.5, is_2d);
        text.mainlist.insert(text.mainlist.find("<setmkfluid"), R"(<setmkbound mk="1" />)" + post);
        const Result made = make(text);
        ASSERT_EQ(made.code, 0) << made.output;
        fppg::Box3 box;
        for (std::size_t i = 0; i < made.cloud.positions.size(); ++i)
            if (made.cloud.mk[i] == first_bound + 1) box.add(made.cloud.positions[i]);
        EXPECT_TRUE(contains(made.log, "it ends at that surface")) << made.log;
        EXPECT_NEAR(box.min.z, dp, 0.01 * dp) << post << is_2d;
        EXPECT_NEAR(box.max.z, 0.8 - 0.5 * dp, 0.01 * dp) << post << is_2d;
    }
}

/// A ball has no corners that could go along.
TEST(TrueSurfaces, WarnOfRoundShapesOnTheirNodes)
{
    for (const double height : {0.2, 0.3})
    {
        CaseText text = drawn_twice(0.5);
        text.mainlist.insert(
            text.mainlist.find("<setmkfluid"),
            fmt::format(
                R"(<setmkbound mk="1" /><drawsphere radius="0.2"><point x="0.5" y="0.5" z="{}" /></drawsphere>)",
                height));
        const Result made = make(text);
        ASSERT_EQ(made.code, 0) << made.output;
        EXPECT_EQ(contains(made.log, "Draw its surface for normals too."), height == 0.2)
            << made.log;
    }
}

/// A channel whose walls begin a step off its water, with planes halfway, as the public Poiseuille
/// flows have it: without the planes there is room for a row more.
TEST(TrueSurfaces, AreThePlanesThatNormalsLeadTo)
{
    CaseText text = case_of(
        R"(<setdrawmode mode="full" /><setmkfluid mk="0" /><drawbox><boxfill>solid</boxfill><point x="0" y="0" z="0.1" /><size x="1.5" y="0" z="0.8" /></drawbox>
<setmkbound mk="0" /><drawbox><boxfill>solid</boxfill><point x="0" y="0" z="-0.3" /><size x="1.5" y="0" z="0.3" /></drawbox>
<drawbox><boxfill>solid</boxfill><point x="0" y="0" z="-1" /><size x="1.5" y="0" z="0.4" /></drawbox>
<setmkbound mk="1" /><drawbox><boxfill>solid</boxfill><point x="0" y="0" z="1" /><size x="1.5" y="0" z="0.3" /></drawbox>)",
        R"(<bodyfitted />)");
    text.dp = "0.1";
    text.pointmin = R"(<pointmin x="0" y="0" z="-1.1" />)";
    text.pointmax = R"(<pointmax x="1.5" y="0" z="1.5" />)";
    text.after_geometry +=
        R"(<normals><norplane mkbound="0"><point auto="true" /><normal x="0" y="0" z="1" /></norplane><norplane mkbound="1"><point x="0" y="0" z="0.95" /><normal x="0" y="0" z="-1" /></norplane></normals>)";
    text.execution =
        R"(<parameters><parameter key="Boundary" value="2" /><parameter key="XPeriodicIncZ" value="0" /></parameters>)";
    const Result made = make(text);
    ASSERT_EQ(made.code, 0) << made.output;
    EXPECT_TRUE(contains(made.log, "its surface is the plane of <norplane>")) << made.log;
    fppg::Box3 fluid, lower, lowest, upper;
    for (std::size_t i = 0; i < made.cloud.positions.size(); ++i)
    {
        const fppg::Vec3& p = made.cloud.positions[i];
        const auto mk = made.cloud.mk[i];
        (mk < first_bound    ? fluid
         : mk != first_bound ? upper
         : p.z < -0.45       ? lowest
                             : lower)
            .add(p);
    }
    EXPECT_NEAR(lowest.max.z, -0.65, 1e-6) << "the plane lies before the outermost wall";
    EXPECT_NEAR(lower.max.z, 0.0, 1e-6) << "half a dp behind the plane";
    EXPECT_NEAR(upper.min.z, 1.0, 1e-6);
    EXPECT_NEAR(fluid.min.z, 0.1, 0.02);
    EXPECT_NEAR(fluid.max.z, 0.9, 0.02);
}

/// A surface farther off is another thing.
TEST(TrueSurfaces, AreNotThoseFarFromTheWalls)
{
    const Result made = make(drawn_twice(1.5));
    ASSERT_EQ(made.code, 0) << made.output;
    EXPECT_FALSE(contains(made.log, "its surface is that for normals")) << made.log;
    EXPECT_TRUE(contains(made.log, "is not where the walls are drawn (mkbound 0: 1.5 dp)"))
        << made.log;
}

} // namespace
