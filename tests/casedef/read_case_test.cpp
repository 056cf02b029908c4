#include "fppg/case_def.h"

#include "fppg/error.h"

#include "casedef/command_table.h"
#include "helpers/case_text.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

#include <algorithm>
#include <cmath>
#include <functional>

namespace fppg
{
namespace
{

using test::CaseText;

CaseDef read(const std::string& text, const CaseOptions& options = {})
{
    const test::TemporaryFolder folder;
    test::write_text(folder / "Case_Def.xml", text);
    return read_case(folder / "Case_Def.xml", options);
}

CaseDef read(const CaseText& text, const CaseOptions& options = {})
{
    return read(text.text(), options);
}

CaseDef run(const std::string& commands)
{
    CaseText text;
    text.mainlist = commands;
    return read(text);
}

/// The message without the folder of the file.
std::string error_of(const CaseText& text, const CaseOptions& options = {})
{
    try
    {
        read(text, options);
    }
    catch (const Error& error)
    {
        const std::string what = error.what();
        const std::size_t at = what.find("Case_Def.xml");
        return at == std::string::npos ? what : what.substr(at);
    }
    return "no error";
}

std::string error_of(const std::string& commands)
{
    CaseText text;
    text.mainlist = commands;
    return error_of(text);
}

void expect_near(const Vec3& found, const Vec3& expected)
{
    for (int axis = 0; axis < 3; ++axis)
        EXPECT_NEAR(found[axis], expected[axis], 1e-12) << "xyz"[axis];
}

/// Where the commands put the point (1, 2, 3).
Vec3 moved(const std::string& transforms)
{
    const CaseDef def = run(transforms + R"(<drawpoint x="1" y="2" z="3" />)");
    return shape_as<PointsOp>(def.ops.back())->points[0];
}

// -- mistakes
// ---------------------------------------------------------------------------------------------

struct Mistake
{
    const char* name;
    std::function<void(CaseText&)> make;
    const char* message;
};

void PrintTo(const Mistake& mistake, std::ostream* out)
{
    *out << mistake.name;
}

Mistake in_mainlist(const char* name, const char* commands, const char* message)
{
    return {name, [commands](CaseText& text) { text.mainlist = commands; }, message};
}

std::string name_of(const testing::TestParamInfo<Mistake>& info)
{
    return info.param.name;
}

class ReadCaseMistake : public testing::TestWithParam<Mistake>
{
};

TEST_P(ReadCaseMistake, IsNamedWithFileLineAndElement)
{
    CaseText text = test::tank();
    GetParam().make(text);
    const std::string message = error_of(text);
    EXPECT_EQ(message.rfind("Case_Def.xml:", 0), 0u) << message;
    EXPECT_NE(message.find(GetParam().message), std::string::npos) << message;
}

INSTANTIATE_TEST_SUITE_P(
    Commands, ReadCaseMistake,
    testing::Values(
        in_mainlist("MissingAttribute", "\n<setmkbound />",
                    ":8: <setmkbound>: attribute 'mk' is missing"),
        in_mainlist("BadNumber", R"(<drawpoint x="1.5m" y="0" z="0" />)",
                    ":7: <drawpoint>: attribute x=\"1.5m\""),
        in_mainlist("BadInteger", R"(<setmkbound mk="1.5" />)",
                    "<setmkbound>: attribute mk=\"1.5\" is not a valid integer number"),
        in_mainlist("Infinite", R"(<drawpoint x="inf" y="0" z="0" />)",
                    "<drawpoint>: attribute x=\"inf\""),
        in_mainlist("UnknownCommand", "<drawteapot />", ":7: <drawteapot>: is not a command"),
        Mistake{"MoreMksThanThereAre",
                [](CaseText& text)
                { text.mkconfig = R"(<mkconfig boundcount="65520" fluidcount="11" />)"; },
                "<mkconfig>: boundcount and fluidcount are 65531 together, expected at most 65530"},
        Mistake{"MoreMksThan16Bits",
                [](CaseText& text)
                { text.mkconfig = R"(<mkconfig boundcount="65531" fluidcount="0" />)"; },
                "<mkconfig>: attribute boundcount=\"65531\" is out of range"},
        in_mainlist("MissingList", R"(<runlist name="Nobody" />)",
                    "<runlist>: there is no list named 'Nobody'"),
        in_mainlist("DivisionByZero", R"(<drawpoint x="#1/0" y="0" z="0" />)",
                    ":7: <drawpoint>: attribute x=\"#1/0\""),
        in_mainlist("UnknownVariable", R"(<drawpoint x="#Width" y="0" z="0" />)",
                    "<drawpoint>: attribute x=\"#Width\""),
        in_mainlist("MkboundOutOfRange", R"(<setmkbound mk="240" />)",
                    "<setmkbound>: mk 240 is invalid, <mkconfig> leaves 0 to 239 for boundary"),
        in_mainlist("MkfluidOutOfRange", R"(<setmkfluid mk="9" />)",
                    "<setmkfluid>: mk 9 is invalid, <mkconfig> leaves 0 to 8 for fluid"),
        in_mainlist("NegativeMk", R"(<setmkbound mk="-1" />)",
                    "<setmkbound>: attribute mk=\"-1\" is out of range"),
        in_mainlist(
            "BadDrawMode", R"(<setdrawmode mode="filled" />)",
            "<setdrawmode>: mode \"filled\" is invalid, expected wire, face, solid or full"),
        in_mainlist("BadBoxLimitMode", R"(<setboxlimitmode mode="outer" />)",
                    "<setboxlimitmode>: mode \"outer\" is invalid, expected inner or full"),
        in_mainlist(
            "WrongBoxfill",
            R"(<drawbox><boxfill>sides</boxfill><point x="0" y="0" z="0" /><size x="1" y="1" z="1" /></drawbox>)",
            "<drawbox>: boxfill \"sides\" is invalid, expected solid, all, bottom"),
        in_mainlist(
            "BoxfillEndsInASign",
            R"(<drawbox><boxfill>all ^</boxfill><point x="0" y="0" z="0" /><size x="1" y="1" z="1" /></drawbox>)",
            "<drawbox>: boxfill \"\" is invalid, expected solid, all, bottom"),
        in_mainlist("ShapeModeInCapitals", "<setshapemode>Real | bound</setshapemode>",
                    "<setshapemode>: shape mode \"Real\" is invalid, expected null, actual, real"),
        in_mainlist("MissingBoxfill",
                    R"(<drawbox><point x="0" y="0" z="0" /><size x="1" y="1" z="1" /></drawbox>)",
                    "<drawbox>: the element <boxfill> is missing in it"),
        in_mainlist("MissingSize",
                    R"(<drawbox><boxfill>all</boxfill><point x="0" y="0" z="0" /></drawbox>)",
                    "<drawbox>: the element <size> is missing in it"),
        in_mainlist("MissingRadius", R"(<drawsphere><point x="0" y="0" z="0" /></drawsphere>)",
                    "<drawsphere>: attribute 'radius' is missing"),
        in_mainlist("TooFewPoints", R"(<drawtriangle><point x="0" y="0" z="0" /></drawtriangle>)",
                    "<drawtriangle>: has 1 points, expected 3"),
        in_mainlist("OnePointOfSeveral", R"(<drawpoints><point x="0" y="0" z="0" /></drawpoints>)",
                    "<drawpoints>: has 1 points, expected at least 2"),
        in_mainlist("OnePointOfLines", R"(<drawlines><point x="0" y="0" z="0" /></drawlines>)",
                    "<drawlines>: has 1 points, expected at least 2"),
        in_mainlist(
            "TwoPointsOfAStrip",
            R"(<drawtrianglesstrip><point x="0" y="0" z="0" /><point x="0" y="0" z="0" /></drawtrianglesstrip>)",
            "<drawtrianglesstrip>: has 2 points, expected at least 3"),
        in_mainlist(
            "TwoPointsOfAFan",
            R"(<drawtrianglesfan><point x="0" y="0" z="0" /><point x="0" y="0" z="0" /></drawtrianglesfan>)",
            "<drawtrianglesfan>: has 2 points, expected at least 3"),
        in_mainlist(
            "TwoPointsOfAPolygon",
            R"(<drawpolygon><point x="0" y="0" z="0" /><point x="0" y="0" z="0" /></drawpolygon>)",
            "<drawpolygon>: has 2 points, expected at least 3"),
        in_mainlist(
            "ThreePointsOfAPyramid",
            R"(<drawpyramid><point x="0" y="0" z="0" /><point x="0" y="0" z="0" /><point x="0" y="0" z="0" /></drawpyramid>)",
            "<drawpyramid>: has 3 points, expected at least 4"),
        in_mainlist(
            "OnePointOfAnExtrusion",
            R"(<drawextrude closed="false"><extrude x="0" y="0" z="1" /><point x="0" y="0" z="0" /></drawextrude>)",
            "<drawextrude>: has 1 points, expected at least 2"),
        in_mainlist(
            "OddPrism",
            R"(<drawprism><point x="0" y="0" z="0" /><point x="0" y="0" z="0" /><point x="0" y="0" z="0" />
<point x="0" y="0" z="0" /><point x="0" y="0" z="0" /><point x="0" y="0" z="0" /><point x="0" y="0" z="0" /></drawprism>)",
            "<drawprism>: has 7 points, expected as many for the bottom as for the top"),
        in_mainlist(
            "BadMask",
            R"(<drawprism mask="a"><point x="0" y="0" z="0" /><point x="1" y="0" z="0" /><point x="0" y="1" z="0" />
<point x="0" y="0" z="1" /><point x="1" y="0" z="1" /><point x="0" y="1" z="1" /></drawprism>)",
            "<drawprism>: mask=\"a\" is invalid"),
        in_mainlist(
            "MaskBeyondTheFaces",
            R"(<drawcylinder radius="1" mask="1 | 33"><point x="0" y="0" z="0" /><point x="0" y="0" z="1" /></drawcylinder>)",
            "<drawcylinder>: mask=\"1 | 33\" is invalid, expected face numbers from 1 to 32"),
        in_mainlist(
            "BadLayers",
            R"(<drawsphere radius="1"><point x="0" y="0" z="0" /><layers vdp="0,x" /></drawsphere>)",
            "<layers>: vdp=\"0,x\" is invalid"),
        in_mainlist("BadModefill",
                    R"(<fillpoint x="0" y="0" z="0"><modefill>air</modefill></fillpoint>)",
                    "<fillpoint>: modefill \"air\" is invalid"),
        in_mainlist(
            "FillOfNoMk",
            R"(<fillpoint x="0" y="0" z="0" mkfluid="10"><modefill>void | fluid</modefill></fillpoint>)",
            "<fillpoint>: mkfluid=\"10\" is invalid, expected 0 to 8 (<mkconfig "
            "fluidcount=\"9\">)"),
        in_mainlist("NearNoMk", R"(<redrawnear targettp="void" bordertp="bound" bordermk="240" />)",
                    "<redrawnear>: bordermk=\"240\" is invalid, expected 0 to 239"),
        in_mainlist("BadNearType", R"(<redrawnear targettp="air" bordertp="bound" />)",
                    "<redrawnear>: attribute targettp=\"air\" is invalid"),
        in_mainlist(
            "UnknownChild",
            R"(<drawellipsoid radius="1"><point x="0" y="0" z="0" /><layers vdp="1" /></drawellipsoid>)",
            "<layers>: <drawellipsoid> has no such element"),
        in_mainlist(
            "TwoSizes",
            R"(<drawbox><boxfill>all</boxfill><point x="0" y="0" z="0" /><size x="1" y="1" z="1" /><size x="1" y="1" z="1" /></drawbox>)",
            "<size>: <drawbox> has it already, expected one"),
        in_mainlist("ChildOfMeshFile",
                    R"(<drawfilestl file="a.stl"><point x="0" y="0" z="0" /></drawfilestl>)",
                    "<point>: <drawfilestl> has no such element"),
        in_mainlist("UnknownActivity", R"(<setactive drawlines="0" />)",
                    "<setactive>: attribute 'drawlines' is not known"),
        in_mainlist(
            "UnsaidClosing",
            R"(<drawextrude><extrude x="0" y="0" z="1" /><point x="0" y="0" z="0" /></drawextrude>)",
            "<drawextrude>: attribute 'closed' is missing"),
        in_mainlist("NoRotationAxis", R"(<rotate ang="10" x="0" y="0" z="0" />)",
                    "<rotate>: the axis (x, y, z) is zero"),
        in_mainlist("BadRotationAxes",
                    R"(<rotateadv axes="XYQ" ang1="1" ang2="0" ang3="0" intrinsic="true" />)",
                    "<rotateadv>: axes \"XYQ\" is invalid"),
        in_mainlist(
            "NoClipNormal",
            R"(<clipplane><point x="0" y="0" z="0" /><vector x="0" y="0" z="0" /></clipplane>)",
            "<clipplane>: the plane has no direction"),
        in_mainlist("Abort", R"(<abort text="[1+1] faults" />)",
                    "<abort>: the case stops itself: 2 faults"),
        in_mainlist("BadCondition", R"(<drawpoint if="#1 +" x="0" y="0" z="0" />)",
                    "<drawpoint>: attribute if=\"#1 +\""),
        in_mainlist("BadFlag", R"(<setactive drawpoints="maybe" />)",
                    "<setactive>: attribute drawpoints=\"maybe\" is not a valid boolean"),
        Mistake{"EndlessLists",
                [](CaseText& text)
                {
                    text.lists = R"(<list name="A"><runlist name="A" /></list>)";
                    text.mainlist = R"(<runlist name="A" />)";
                },
                "lists call one another more than"}),
    name_of);

INSTANTIATE_TEST_SUITE_P(
    Definition, ReadCaseMistake,
    testing::Values(
        Mistake{"ZeroDp", [](CaseText& text) { text.dp = "0.0"; },
                ":5: <definition>: dp is 0, expected a particle distance above 0"},
        Mistake{"NegativeDp", [](CaseText& text) { text.dp = "-0.1"; }, "<definition>: dp is -0.1"},
        Mistake{"PointminAbovePointmax",
                [](CaseText& text) { text.pointmin = R"(<pointmin x="9" y="0" z="0" />)"; },
                "<pointmin>: the lower limit 9 of x is above the upper limit 1.5 in <pointmax>"},
        Mistake{"MissingPointmax", [](CaseText& text) { text.pointmax = ""; },
                "<definition>: the element <pointmax> is missing in it"},
        Mistake{"TooManyNodes", [](CaseText& text) { text.dp = "1e-10"; },
                "<definition>: the domain has"},
        Mistake{"TwoListsOfOneName",
                [](CaseText& text) { text.lists = R"(<list name="A" /><list name="A" />)"; },
                "<list>: there is a list named 'A' already"},
        Mistake{"UserVariableOfAnotherKind",
                [](CaseText& text) {
                    text.predefinition = R"(<predefinition><newvarstrcte H="a" /></predefinition>)";
                },
                "<predefinition>: "},
        Mistake{"ListWithoutName", [](CaseText& text) { text.lists = "<list />"; },
                "<list>: attribute 'name' is missing"},
        Mistake{"MissingGravity", [](CaseText& text) { text.gravity = ""; },
                ":3: <constantsdef>: the element <gravity> is missing in it"},
        Mistake{"MissingCflnumber",
                [](CaseText& text) { text.constants.resize(text.constants.find("<cflnumber")); },
                "<constantsdef>: the element <cflnumber> is missing in it"},
        Mistake{"CoefhAndHdp", [](CaseText& text) { text.constants += R"(<hdp value="2" />)"; },
                "<hdp>: only one constant must be defined, coefh or hdp"},
        Mistake{"BadRhopgradient",
                [](CaseText& text) { text.rhopgradient = R"(<rhopgradient value="4" />)"; },
                "<rhopgradient>: attribute value=\"4\" is out of range, expected 1 to 3"},
        Mistake{
            "BadMkorient",
            [](CaseText& text)
            {
                text.mkconfig =
                    R"(<mkconfig boundcount="9" fluidcount="9"><mkorientbound mk="0" orient="xxz" /></mkconfig>)";
            },
            "<mkorientbound>: orient=\"xxz\" is invalid"},
        Mistake{"MissingMkconfig", [](CaseText& text) { text.mkconfig = ""; },
                "<casedef>: the element <mkconfig> is missing in it"},
        Mistake{"MissingParameters", [](CaseText& text) { text.execution = ""; },
                "<case>: the element <execution><parameters> is missing in it"},
        Mistake{"UnknownMotion",
                [](CaseText& text) {
                    text.after_geometry =
                        R"(<motion><objreal ref="0"><mvjump id="1" /></objreal></motion>)";
                },
                "<mvjump>: is not known in <motion>"}),
    name_of);

// GenCase v5.4.354 passes over all of them without a word.
TEST(ReadCase, WarnsOfWhatHasNoEffect)
{
    CaseText text = test::tank();
    text.lists = "<drawpoint />";
    text.mkconfig = R"(<mkconfig boundcount="20" fluidcount="9"><mkorient /></mkconfig>)";
    text.after_geometry =
        R"(<initials><velocity mkfluid="9" x="1" y="0" z="0" /><velocity mkfluid="8" x="1" y="0" z="0" /></initials>)";
    const std::vector<std::string> warnings = read(text).warnings;
    ASSERT_EQ(warnings.size(), 3U);
    EXPECT_NE(warnings[0].find("<mkorient>: is not known in <mkconfig> and has no effect"),
              std::string::npos);
    EXPECT_NE(warnings[1].find("<drawpoint>: is not known in <commands> and has no effect"),
              std::string::npos);
    EXPECT_NE(warnings[2].find("<velocity>: there is no mkfluid 9, so it has no effect"),
              std::string::npos);
}

TEST(ReadCase, RefusesAMissingMainlistAndAForeignRoot)
{
    const std::string text = CaseText().text();
    const std::size_t begin = text.find("<mainlist>");
    const std::size_t end = text.find("</mainlist>") + 11;
    EXPECT_THROW(read(text.substr(0, begin) + text.substr(end)), CaseError);
    try
    {
        read(std::string("<?xml version=\"1.0\"?>\n\n<model/>"));
        FAIL();
    }
    catch (const CaseError& error)
    {
        EXPECT_NE(
            std::string(error.what()).find("Case_Def.xml:3: <model>: the root must be <case>"),
            std::string::npos)
            << error.what();
    }
}

TEST(ReadCase, RefusesACaseForANewerGenCase)
{
    std::string text = CaseText().text();
    text.replace(text.find("<casedef>"), 9, R"(<casedef requiredversion="v9.0.1">)");
    EXPECT_THROW(read(text), CaseError);
    text.replace(text.find("v9.0.1"), 6, "v5.0.1");
    EXPECT_NO_THROW(read(text));
}

TEST(ReadCase, WarnsOfNormalsThatTheSolverOfTodayRefuses)
{
    CaseText text;
    text.execution +=
        R"(<special><initialize><boundnormal_set mkbound="1" /><boundnormal_curved /><_boundnormal_parts />)"
        "\n"
        R"(<boundnormal_plane mkbound="10"><point auto="true" /></boundnormal_plane>)"
        R"(</initialize></special>)";
    const std::vector<std::string> warnings = read(text).warnings;
    ASSERT_EQ(warnings.size(), 1U);
    EXPECT_NE(warnings[0].find(":12: <boundnormal_plane>: the solver of v5.4 stops at it"),
              std::string::npos)
        << warnings[0];
}

// -- what is ignored
// --------------------------------------------------------------------------------------

TEST(ReadCase, IgnoresUnknownAttributesBlocksAndUnderscoredElements)
{
    CaseText text = test::tank();
    text.mainlist +=
        R"(<_drawteapot /><drawpoint x="0" y="0" z="0" colour="red" /><!-- a comment -->)";
    text.after_geometry = R"(<someblock a="1" />)";
    text.lists = R"(<_list /><list name="Unused"><_x /></list>)";
    EXPECT_EQ(read(text).ops.size(), test::tank().mainlist.empty() ? 0u : 3u);
}

TEST(ReadCase, SkipsCommandsThatAnIfSwitchesOff)
{
    const CaseDef def = run(R"(<newvar a="2" /><drawpoint if="#a>3" x="0" y="0" z="0" />
<drawpoint if="#a==2" x="1" y="0" z="0" /><drawbeach if="#0" />)");
    ASSERT_EQ(def.ops.size(), 1u);
    EXPECT_EQ(shape_as<PointsOp>(def.ops[0])->points[0].x, 1);
}

TEST(ReadCase, RefusesWhatIsNoCommand)
{
    EXPECT_NE(find_command("drawbox"), nullptr);
    EXPECT_EQ(find_command("drawteapot"), nullptr);
    EXPECT_NE(error_of("<drawteapot />").find("<drawteapot>: is not a command"), std::string::npos);
}

const MeshFileOp& mesh_op(const CaseDef& def, std::size_t i)
{
    return *shape_as<MeshFileOp>(def.ops.at(i));
}

TEST(ReadCase, ReadsWhichShapesOfAVtkFileAreDrawn)
{
    const CaseDef def = run(R"(<drawfilevtk file="a.vtk"><polyselec>points | quads</polyselec>
<drawmove x="1" y="0" z="0" /></drawfilevtk><drawfileply file="a.ply" autofill="true" />)");
    EXPECT_EQ(mesh_op(def, 0).reading.shapes, (ShapeSelection{true, false, false, true, false}));
    EXPECT_EQ(mesh_op(def, 0).transform({}), (Vec3{1, 0, 0}));
    EXPECT_EQ(mesh_op(def, 1).reading.format, MeshFormat::Ply);
    EXPECT_TRUE(mesh_op(def, 1).autofill);
    EXPECT_NE(error_of(R"(<drawfilevtk file="a.vtk"><polyselec>dots</polyselec></drawfilevtk>)")
                  .find("polyselec \"dots\" is invalid"),
              std::string::npos);
    EXPECT_NE(error_of(R"(<drawfilecsv file="a.csv" />)").find("mode"), std::string::npos);
}

TEST(ReadCase, TakesADepthOfZeroForNone)
{
    const double dp = run("").grid.dp;
    const auto limits = [](const std::string& depth)
    {
        const CaseDef def =
            run("<drawfilestl file=\"a.stl\" advanced=\"true\">" + depth + "</drawfilestl>");
        return std::pair(mesh_op(def, 0).depth_min, mesh_op(def, 0).depth_max);
    };
    constexpr double infinity = std::numeric_limits<double>::infinity();
    EXPECT_EQ(limits(""), std::pair(0.0, 2 * dp));
    EXPECT_EQ(limits(R"(<depth depthmin="0" depthmax="0" />)"), std::pair(0.0, 2 * dp));
    EXPECT_EQ(limits(R"(<depth depthmin="0" />)"), std::pair(0.0, 2 * dp));
    EXPECT_EQ(limits(R"(<depth depthmin="0.02" depthmax="0" />)"), std::pair(0.02, infinity));
    EXPECT_EQ(limits(R"(<depth depthmax="0.1" />)"), std::pair(0.0, 0.1));
}

TEST(ReadCase, MeansEmptyNodesWithARedrawboxWithoutMk)
{
    const std::string box = R"(<point x="0" y="0" z="0" /><size x="1" y="1" z="1" />)";
    const CaseDef def = run("<redrawbox>" + box + "</redrawbox><redraw />");
    const auto& op = std::get<RedrawOp>(std::get<Edit>(def.ops.at(0).what));
    ASSERT_EQ(op.filters.size(), 1u);
    EXPECT_EQ(op.filters[0].kind, MkKind::Void);
    EXPECT_TRUE(std::get<RedrawOp>(std::get<Edit>(def.ops.at(1).what)).filters.empty());
}

/// A case beside a VTM file of three parts.
CaseDef run_with_vtm(const std::string& selection)
{
    const test::TemporaryFolder folder;
    test::write_text(folder / "a.vtm",
                     R"(<VTKFile type="vtkMultiBlockDataSet"><vtkMultiBlockDataSet><Block>
<DataSet index="0" name="A" file="s0.vtp"/><DataSet index="1" name="B" file="s1.vtp"/>
<DataSet index="2" name="C" file="s2.vtp"/></Block></vtkMultiBlockDataSet></VTKFile>)");
    CaseText text;
    text.mainlist =
        R"(<setmkbound mk="1" /><drawfilevtm file="a.vtm">)" + selection + "</drawfilevtm>";
    test::write_text(folder / "Case_Def.xml", text.text());
    return read_case(folder / "Case_Def.xml", {});
}

TEST(ReadCase, DrawsEveryDataSetOfAVtmFile)
{
    const CaseDef def = run_with_vtm("");
    ASSERT_EQ(def.ops.size(), 3U);
    EXPECT_EQ(mesh_op(def, 2).file, "s2.vtp");
    EXPECT_EQ(mesh_op(def, 2).container, "a.vtm");
}

TEST(ReadCase, GivesSelectedDataSetsTheirMkInTheOrderOfBothLists)
{
    const CaseDef def =
        run_with_vtm(R"(<onlysurfaces index="2,0" mkbound="4-5" /><onlysurfaces name="B" />)");
    ASSERT_EQ(def.ops.size(), 3U);
    EXPECT_EQ(mesh_op(def, 0).file, "s2.vtp");
    EXPECT_EQ(def.ops[0].state->mk.mk_type, 4);
    EXPECT_EQ(def.ops[1].state->mk.mk_type, 5);
    EXPECT_EQ(def.ops[2].state->mk.mk_type, 1);
}

TEST(ReadCase, RefusesSelectionsThatDoNotFitTheVtmFile)
{
    for (const char* wrong :
         {R"(<onlysurfaces name="b" />)", R"(<onlysurfaces index="0-1" mkbound="3" />)",
          R"(<onlysurfaces index="7" />)", R"(<onlysurfaces index="0" name="A" />)",
          R"(<onlysurfaces index="0" /><onlysurfaces name="A" />)", R"(<onlysurfaces />)"})
        EXPECT_THROW(run_with_vtm(wrong), CaseError) << wrong;
}

TEST(ReadCase, ReadsTheGridOfABathymetry)
{
    const CaseDef def = run(R"(<drawbathymetry><zpoints file="p.xyz"><scale x="1" y="1" z="2" />
<move x="0" y="0" z="1" /></zpoints><grid dp="0.5"><expands><xmin size="1" z="3" size2="2" />
</expands><periodicy rampwidth="0.5" /></grid></drawbathymetry>)");
    const BathymetryGrid& grid = *mesh_op(def, 0).reading.bathymetry;
    EXPECT_EQ(grid.transform({0, 0, 2}), (Vec3{0, 0, 5}));
    EXPECT_EQ(grid.expands[0], (BathymetryRamp{1, 3.0, 2, std::nullopt}));
    EXPECT_FALSE(grid.periods[0].has_value());
    EXPECT_EQ(grid.periods[1], (BathymetryPeriod{0.5, 0}));
}

// -- state
// ------------------------------------------------------------------------------------------------

TEST(State, OfADrawIsWhatTheCommandsBeforeItSet)
{
    const CaseDef def =
        run(R"(<setmkbound mk="3" /><setdrawmode mode="face" /><setboxlimitmode mode="full" />
<setdpctes cteline="0.9" /><drawpoint x="0" y="0" z="0" /><setmkvoid /><drawpoint x="0" y="0" z="0" />)");
    const DrawState& first = *def.ops.at(0).state;
    EXPECT_EQ(first.mk, (MkValue{MkKind::Bound, 13, 3}));
    EXPECT_EQ(first.mode, DrawMode::Face);
    EXPECT_TRUE(first.box_limit_full);
    EXPECT_EQ(first.constants.line, 0.9);
    EXPECT_EQ(def.ops.at(1).state->mk.kind, MkKind::Void);
    EXPECT_EQ(def.ops.at(0).source.line, 8);
    EXPECT_EQ(def.ops.at(0).source.command, "drawpoint");
}

TEST(State, ComesBackFromItsStackWithoutTheClips)
{
    const CaseDef def = run(
        R"(<setmkbound mk="1" /><setdrawmode mode="wire" /><move x="1" y="0" z="0" /><statesave />
<setmkfluid mk="0" /><setdrawmode mode="full" /><move x="1" y="0" z="0" />
<clipplane><point x="0" y="0" z="0" /><vector x="1" y="0" z="0" /></clipplane>
<stateload /><drawpoint x="0" y="0" z="0" /><stateload /><drawpoint x="0" y="0" z="0" />)");
    for (const DrawOp& op : def.ops)
    {
        EXPECT_EQ(op.state->mk.mk_type, 1);
        EXPECT_EQ(op.state->mode, DrawMode::Wire);
        EXPECT_EQ(op.state->clips.size(), 1u);
        expect_near(shape_as<PointsOp>(op)->points[0], {1, 0, 0});
    }
}

CaseText with_patterns(const std::string& patterns, const std::string& commands)
{
    CaseText text;
    text.after_geometry = "<patterns>" + patterns + "</patterns>";
    text.mainlist = commands;
    return text;
}

/// A pattern of 2 x 1 x 2 nodes with these attributes and children besides.
std::string pattern_2x1x2(const std::string& cells, const std::string& more = "")
{
    return "<pattern name=\"P\" pattern=\"" + cells + R"("><size x="2" y="1" z="2" />)" + more +
           "</pattern>";
}

TEST(State, TakesAPatternByItsNameAndKeepsItOverAReset)
{
    const CaseDef def =
        read(with_patterns(pattern_2x1x2("6", R"(<gap x="1" y="0" z="0" />)"),
                           R"(<setpattern name="p" /><setmkbackfluid mk="3" /><resetdraw />
<setmkbound mk="0" /><drawpoint x="0" y="0" z="0" />)"));
    const DrawState& state = *def.ops.back().state;
    ASSERT_TRUE(state.pattern);
    EXPECT_EQ(state.pattern->cells, (std::vector<char>{0, 1, 1, 0}));
    EXPECT_EQ(state.pattern->gap, (std::array<std::uint32_t, 3>{1, 0, 0}));
    EXPECT_FALSE(state.mk_back.has_value());
}

TEST(State, KeepsPatternAndMkBackOnTheStackOfMks)
{
    const CaseDef def = read(with_patterns(pattern_2x1x2("X--X"), R"(<setmkbound mk="0" /><mksave />
<setpattern name="P" /><setmkbackfluid mk="3" /><statesave /><mkload />
<drawpoint x="0" y="0" z="0" /><mkload /><drawpoint x="0" y="0" z="0" />)"));
    EXPECT_TRUE(def.ops.at(0).state->pattern);
    EXPECT_EQ(def.ops.at(0).state->mk_back, (MkValue{MkKind::Fluid, 4, 3}));
    EXPECT_FALSE(def.ops.at(1).state->pattern);
    EXPECT_FALSE(def.ops.at(1).state->mk_back.has_value());
}

TEST(ReadCase, RefusesPatternsThatCannotBe)
{
    for (const std::string& wrong :
         {pattern_2x1x2("X-X"), pattern_2x1x2("X- X"), pattern_2x1x2("X--G"), pattern_2x1x2("f9"),
          pattern_2x1x2("X--X") + pattern_2x1x2("X--X"),
          pattern_2x1x2("X--X", R"(<gap x="2" y="0" z="0" />)"),
          pattern_2x1x2("X--X", R"(<scale x="0" y="1" z="1" />)"),
          pattern_2x1x2("X--X", R"(<border x="-1" y="0" z="0" />)")})
        EXPECT_NE(error_of(with_patterns(wrong, "")).find('<'), std::string::npos) << wrong;
    EXPECT_NE(error_of(with_patterns(pattern_2x1x2("X--X"), R"(<setpattern name="q" />)"))
                  .find("there is no pattern named 'q'"),
              std::string::npos);
}

TEST(State, HasStacksOfMksAndDrawConstants)
{
    const CaseDef def =
        run(R"(<setmkbound mk="1" /><mksave /><setmkbound mk="2" /><mksave /><setmkfluid mk="0" />
<mkload /><drawpoint x="0" y="0" z="0" /><mkload /><drawpoint x="0" y="0" z="0" />
<setdpctes ctesphere="2" /><dpctessave /><dpctesreset /><drawpoint x="0" y="0" z="0" /><dpctesload />
<drawpoint x="0" y="0" z="0" />)");
    EXPECT_EQ(def.ops.at(0).state->mk.mk_type, 2);
    EXPECT_EQ(def.ops.at(1).state->mk.mk_type, 1);
    EXPECT_EQ(def.ops.at(2).state->constants.sphere, 0.6);
    EXPECT_EQ(def.ops.at(3).state->constants.sphere, 2);
}

TEST(State, IsForgottenByResetdraw)
{
    const CaseDef def =
        run(R"(<setmkbound mk="1" /><move x="1" y="0" z="0" /><setdrawmode mode="face" />
<clipplane><point x="0" y="0" z="0" /><vector x="1" y="0" z="0" /></clipplane><resetdraw />
<drawpoint x="0" y="0" z="0" />)");
    EXPECT_TRUE(std::holds_alternative<ResetOp>(def.ops.at(0).what));
    const DrawState& state = *def.ops.at(1).state;
    EXPECT_EQ(state.mk.kind, MkKind::Void);
    EXPECT_EQ(state.mode, DrawMode::Solid);
    EXPECT_TRUE(state.clips.empty());
    expect_near(shape_as<PointsOp>(def.ops.at(1))->points[0], {0, 0, 0});
}

TEST(State, CountsMksOnWithSetmknext)
{
    const CaseDef def = run(R"(<setmknextbound /><drawpoint x="0" y="0" z="0" /><setmknextbound />
<drawpoint x="0" y="0" z="0" /><setmknextbound next="false" /><drawpoint x="0" y="0" z="0" />
<setmknextfluid /><drawpoint x="0" y="0" z="0" />)");
    EXPECT_EQ(def.ops.at(0).state->mk, (MkValue{MkKind::Bound, 10, 0}));
    EXPECT_EQ(def.ops.at(1).state->mk, (MkValue{MkKind::Bound, 11, 1}));
    EXPECT_EQ(def.ops.at(2).state->mk, (MkValue{MkKind::Bound, 10, 0}));
    EXPECT_EQ(def.ops.at(3).state->mk, (MkValue{MkKind::Fluid, 1, 0}));
}

TEST(State, RefusesTheMkBeforeTheFirst)
{
    EXPECT_THROW(run(R"(<setmkfluid mk="0" /><setmknextfluid next="false" />)"), CaseError);
}

TEST(State, HidesFacesByABitMaskOrAListOfNumbers)
{
    const std::string points =
        R"(<point x="0" y="0" z="0" /><point x="1" y="0" z="0" /><point x="0" y="1" z="0" />
<point x="0" y="0" z="1" /><point x="1" y="0" z="1" /><point x="0" y="1" z="1" /></drawprism>)";
    const auto visible = [&](const std::string& mask)
    {
        const CaseDef def = run("<drawprism mask=\"" + mask + "\">" + points);
        std::string out;
        for (const PolyhedronFace& face : shape_as<PolyhedronOp>(def.ops.at(0))->faces)
            out += face.is_visible ? '1' : '0';
        return out;
    };
    EXPECT_EQ(visible("5"), "01011");
    EXPECT_EQ(visible("1 | 3"), "01011");
    EXPECT_EQ(visible("0"), "11111");
}

// -- transforms
// -------------------------------------------------------------------------------------------

TEST(State, KnowsTheOldNameOfActualShapesAndSumsOfShapeModes)
{
    const auto shown = [](const std::string& words)
    {
        const CaseDef def =
            run("<setshapemode>" + words + R"(</setshapemode><shapeout file="a" />)");
        const ShapeMode& mode = def.ops.back().state->shape_mode;
        return std::tuple(mode.actual, mode.snapped, mode.kinds);
    };
    using Kinds = std::array<bool, 3>; // void, bound, fluid
    EXPECT_EQ(shown("real | bound"), std::tuple(true, false, Kinds{false, true, false}));
    EXPECT_EQ(shown("real | dp | bound"), std::tuple(true, true, Kinds{false, true, false}));
    EXPECT_EQ(shown("real ^ actual | all ^ bound"),
              std::tuple(false, false, Kinds{true, false, true}));
}

TEST(ReadCase, TakesWholeNumbersWithZerosBehindAPoint)
{
    const CaseDef def = run(R"(<setmkbound mk="1.0" /><drawpoint x="0" y="0" z="0" />
<setmkbound mk="" /><drawpoint x="0" y="0" z="0" /><setmkbound mk=" +2. " /><drawpoint x="0" y="0" z="0" />)");
    ASSERT_EQ(def.ops.size(), 3U);
    EXPECT_EQ(def.ops[0].state->mk.mk_type, 1);
    EXPECT_EQ(def.ops[1].state->mk.mk_type, 0);
    EXPECT_EQ(def.ops[2].state->mk.mk_type, 2);
}

TEST(Texts, BehindADollarHaveTheirVariablesReplaced)
{
    CaseText text;
    text.lists = R"(<list name="abc"><drawpoint x="0" y="0" z="0" /></list>)";
    text.mainlist = R"(<newvarstrcte m="abc" /><newvarcte n="2" /><runlist name="$[m]" />
<shapeout file="$x[n]" format="$vt[vtx]" /><shapeout file="x[n]" /><newvarstr q="$[m][n]" /><printf text="[q]" />)";
    text.predefinition = R"(<predefinition><newvarstrcte vtx="u" /></predefinition>)";
    const CaseDef def = read(text);
    ASSERT_EQ(def.ops.size(), 3U);
    EXPECT_EQ(std::get<ShapeOutOp>(std::get<Output>(def.ops[1].what)).file, "x2");
    EXPECT_EQ(std::get<ShapeOutOp>(std::get<Output>(def.ops[1].what)).format, ShapeFormat::Vtu);
    EXPECT_EQ(std::get<ShapeOutOp>(std::get<Output>(def.ops[2].what)).file, "x[n]");
    EXPECT_NE(std::find(def.list_log.begin(), def.list_log.end(), "abc2"), def.list_log.end());
}

TEST(Special, HasItsExpressionsReplacedForTheSolver)
{
    CaseText text;
    text.mainlist = R"(<newvarcte depth="0.5" /><newvarstrcte m="abc" />)";
    text.execution =
        R"(<special><a v="#depth*2" comment="#depth"><b w="$x[m]" x="[m]" /><_c y="# depth " /></a></special>
<parameters><parameter key="TimeMax" value="$1[depth]" /><parameter key="#Off" value="#depth" /></parameters>)";
    const CaseDef def = read(text);
    const Element& a = *def.execution.at(0).find_child("a");
    EXPECT_EQ(*a.find_attribute("v"), "1");
    EXPECT_EQ(*a.find_child("b")->find_attribute("w"), "xabc");
    EXPECT_EQ(*a.find_child("b")->find_attribute("x"), "[m]");
    // Comments and elements that do not count too.
    EXPECT_EQ(*a.find_attribute("comment"), "0.5");
    EXPECT_EQ(*a.find_child("_c")->find_attribute("y"), "0.5");
    EXPECT_EQ(*def.execution.at(1).find_child("parameter")->find_attribute("value"), "10.5");
    const Element& off = def.execution.at(1).children.at(1);
    EXPECT_EQ(*off.find_attribute("key"), "#Off");
    EXPECT_EQ(*off.find_attribute("value"), "0.5");
    text.execution = R"(<special><a v="#nothing" /></special><parameters />)";
    EXPECT_NE(error_of(text).find("<a>: attribute v=\"#nothing\""), std::string::npos);
}

// The sums are those that GenCase v5.4.354 writes.
TEST(Properties, MayBeSummedWithBlanksAndComeSorted)
{
    CaseText text;
    text.mainlist = R"(<newvarstrcte m="steel" />)";
    text.after_geometry =
        R"(<properties><links><link mkbound="1" property=" u1 " /><link mkbound="2" property="$ [m] + + u 1 +steel" />
</links><property name="u1" /><property name="$[m]" /><links><link mkbound="3" property="u1" /></links></properties>
<floatings><floating mkbound="4-5" rhopbody="500" property="steel" /><floating mkbound="5" rhopbody="500" property="u1 + steel" /></floatings>)";
    const CaseDef def = read(text);
    using Link = std::pair<std::uint16_t, std::string>;
    EXPECT_EQ(
        def.property_links,
        (std::vector<Link>{
            {11, "u1"}, {12, "steel"}, {12, "u1"}, {14, "steel"}, {15, "steel"}, {15, "u1"}}));
    ASSERT_EQ(def.warnings.size(), 1U);
    EXPECT_NE(def.warnings[0].find("<links>: is there twice"), std::string::npos);
    text.after_geometry =
        R"(<floatings><floating mkbound="4" rhopbody="500" property="steel" /></floatings>)";
    EXPECT_NE(error_of(text).find("<floating>: there is no property named \"steel\""),
              std::string::npos);
}

TEST(MkConfig, WarnsOfMksThatGenCaseRefuses)
{
    const auto warnings = [](const char* mkconfig, const char* mainlist)
    {
        CaseText text = test::tank();
        text.mkconfig = mkconfig;
        text.mainlist = mainlist;
        const CaseDef def = read(text);
        EXPECT_LE(def.warnings.size(), 1U);
        return def.warnings.empty() ? std::string() : def.warnings[0];
    };
    const char* const draw = R"(<setmkbound mk="239" /><drawpoint x="0" y="0" z="0" />)";
    EXPECT_EQ(warnings(R"(<mkconfig boundcount="65520" fluidcount="9" />)", draw), "");
    EXPECT_EQ(warnings(R"(<mkconfig boundcount="241" fluidcount="9" />)", draw), "");
    EXPECT_THAT(
        warnings(
            R"(<mkconfig boundcount="65520" fluidcount="9" />)",
            "<setmkbound mk=\"239\" />\n<setmknextbound next=\"true\" /><setmkbound mk=\"999\" />"),
        testing::EndsWith(":8: <setmknextbound>: GenCase v5.4 refuses mk 240, as its mks have 8 "
                          "bits and boundcount=65520 leaves 240 of them there; the solver takes "
                          "mks up to 2047"));
    EXPECT_THAT(warnings(R"(<mkconfig boundcount="244" fluidcount="10" />)", draw),
                testing::HasSubstr("<mkconfig>: GenCase v5.4 refuses boundcount=244 with "
                                   "fluidcount=10"));
    EXPECT_THAT(warnings(R"(<mkconfig boundcount="240" fluidcount="265" />)", draw),
                testing::EndsWith("mkbound 0 is mk 10 there and mk 266 here"));
}

TEST(Normals, MayHaveTheFormOfGenCase50)
{
    CaseText text;
    text.after_geometry =
        R"(<normals><distanceh value="#1+2" /><geometryfile file="[CaseName]_hdp_Real.vtk" /><svshapes value="1" /><svnormals value="1" /><maxsizeh v="3" /></normals>)";
    CaseOptions options;
    options.case_name = "Tank";
    const CaseDef def = read(text, options);
    ASSERT_TRUE(def.normals.geometry);
    EXPECT_EQ(def.normals.geometry->file, "Tank_hdp_Real.vtk");
    EXPECT_EQ(def.normals.geometry->distance_h, 3);
    EXPECT_EQ(def.normals.geometry->max_size_h, 0);
    EXPECT_TRUE(def.normals.geometry->save_shapes);
    ASSERT_EQ(def.warnings.size(), 3U);
    EXPECT_NE(def.warnings[2].find(R"(<maxsizeh>: attribute v="3" is not known)"),
              std::string::npos);
    EXPECT_NE(def.warnings[0].find("<maxsizeh>: has no attribute value, so 0 is taken"),
              std::string::npos);
    EXPECT_NE(
        def.warnings[1].find(
            R"(write <normals><norgeometry><geometryfile file="[CaseName]_hdp_Real.vtk" /><distanceh v="#1+2" /><svshapes v="1" /></norgeometry></normals>)"),
        std::string::npos)
        << def.warnings[1];
    text.after_geometry =
        R"(<normals><geometryfile file="a.vtk" /><computesnormals value="1" /></normals>)";
    EXPECT_NE(error_of(text).find("<computesnormals>: is not known in <normals> (did you mean "
                                  "computenormals?)"),
              std::string::npos);
    text.after_geometry =
        R"(<normals><norplane mk="0"><point x="0" y="0" z="0" /><normal x="1" y="0" z="0" /></norplane></normals>)";
    EXPECT_NE(error_of(text).find("<norplane>: attribute mk=\"0\" is not known, expected mkbound"),
              std::string::npos);
}

TEST(Normals, OfGenCase50MayHaveWordsThatOfGenCase54Refuses)
{
    CaseText text;
    const auto warnings = [&](const std::string& words)
    {
        text.after_geometry = R"(<normals><geometryfile file="a.vtk" />)" + words + "</normals>";
        std::string all;
        for (const std::string& warning : read(text).warnings) all += warning + "\n";
        return all;
    };
    EXPECT_THAT(warnings(R"(<svnormaldata value="1" /><computenormals value="1" />)"
                         R"(<ftsupport value="1" /><dg_svopenshapes value="0" />)"
                         R"(<dg_svpartsnormal value="0" />)"),
                testing::AllOf(testing::HasSubstr("this is the form of GenCase v5.0"),
                               testing::Not(testing::HasSubstr("<ftsupport>"))));
    EXPECT_THAT(warnings(R"(<ftsupport value="0" />)"),
                testing::HasSubstr("<ftsupport>: has no effect, floating bodies have normals"));
}

TEST(Transforms, ActInReverseOrderOfWriting)
{
    expect_near(moved(R"(<move x="10" y="0" z="0" /><scale x="2" y="2" z="2" />)"), {12, 4, 6});
    expect_near(moved(R"(<scale x="2" y="2" z="2" /><move x="10" y="0" z="0" />)"), {22, 4, 6});
}

TEST(Transforms, RotateClockwiseSeenFromTheTipOfTheAxis)
{
    expect_near(moved(R"(<rotate ang="90" x="0" y="0" z="1" />)"), {2, -1, 3});
    expect_near(
        moved(
            R"(<rotateline ang="90"><point x="1" y="0" z="0" /><point x="1" y="0" z="5" /></rotateline>)"),
        {3, 0, 3});
}

TEST(Transforms, RotateadvTurnsAboutItsCentreInTheOrderOfItsAxes)
{
    expect_near(
        moved(
            R"(<rotateadv ang1="90" ang2="0" ang3="0" axes="XYZ" intrinsic="true"><center x="1" y="2" z="0" /></rotateadv>)"),
        {1, -1, 0});
    const Vec3 intrinsic =
        moved(R"(<rotateadv ang1="90" ang2="90" ang3="0" axes="XYZ" intrinsic="true" />)");
    const Vec3 extrinsic =
        moved(R"(<rotateadv ang1="90" ang2="90" ang3="0" axes="XYZ" intrinsic="false" />)");
    expect_near(intrinsic, {3, 1, 2});
    expect_near(extrinsic, {2, -3, -1});
}

TEST(Transforms, HaveAStackAndAReset)
{
    expect_near(
        moved(
            R"(<move x="1" y="0" z="0" /><matrixsave /><move x="1" y="0" z="0" /><matrixload />)"),
        {2, 2, 3});
    expect_near(moved(R"(<move x="1" y="0" z="0" /><matrixreset />)"), {1, 2, 3});
    expect_near(moved(R"(<matrixload />)"), {1, 2, 3});
}

const char* const quarter_turn = R"(<rotate ang="90" x="0" y="0" z="1" />)";
const char* const clip_at_x =
    R"(<clipplane><point x="1" y="0" z="0" /><vector x="1" y="0" z="0" /></clipplane>)";
const char* const a_point = R"(<drawpoint x="0" y="0" z="0" />)";

std::vector<ClipPlane> clips_after(const std::string& commands)
{
    return run(commands + a_point).ops.at(0).state->clips;
}

TEST(Clips, StandWhereTheyAreWrittenWhateverTheMatrixIs)
{
    const ClipPlane clip = clips_after(std::string(quarter_turn) + clip_at_x).at(0);
    EXPECT_EQ(clip.point, (Vec3{1, 0, 0}));
    EXPECT_EQ(clip.normal, (Vec3{1, 0, 0}));
}

TEST(Clips, TurnWithATransformAfterThem)
{
    const ClipPlane clip = clips_after(std::string(clip_at_x) + quarter_turn).at(0);
    expect_near(clip.point, {0, -1, 0});
    expect_near(clip.normal, {0, -1, 0});
}

TEST(Clips, MoveByTheWholeMatrixThatATransformLeaves)
{
    const std::string move = R"(<move x="0" y="0" z="3" />)";
    const ClipPlane clip = clips_after(quarter_turn + (clip_at_x + move)).at(0);
    expect_near(clip.point, {0, -1, 3});
    const ClipPlane reset =
        clips_after(quarter_turn + (clip_at_x + move) + "<matrixreset />").at(0);
    EXPECT_EQ(reset.point, (Vec3{1, 0, 0}));
    EXPECT_EQ(reset.normal, (Vec3{1, 0, 0}));
}

TEST(Clips, BeginUnderTheMatrixThatMovedOthersUntilClipreset)
{
    const std::string two = std::string(clip_at_x) + quarter_turn + clip_at_x;
    expect_near(clips_after(two).at(1).point, {0, -1, 0});
    const std::string again = std::string(clip_at_x) + quarter_turn + "<clipreset />" + clip_at_x;
    expect_near(clips_after(again).at(0).point, {1, 0, 0});
}

TEST(Clips, StayWhereMatrixsaveStands)
{
    const std::string saved = std::string(quarter_turn) + clip_at_x + "<matrixsave />";
    expect_near(clips_after(saved).at(0).point, {1, 0, 0});
}

TEST(Clips, OfABoxMayBeTurnedUnderAMatrix)
{
    const std::string box = R"(<clipbox><point x="0" y="0" z="0" /><size x="1" y="1" z="1" />
<angles x="0" y="0" z="90" /><boxfaces>right</boxfaces></clipbox>)";
    const ClipPlane clip = clips_after(box + R"(<move x="0" y="0" z="3" />)").at(0);
    expect_near(clip.normal, {0, 1, 0});
    expect_near(clip.point, {-1, 1, 4});
}

// -- variables and flow
// -----------------------------------------------------------------------------------

TEST(Expressions, StandInAnyNumber)
{
    const CaseDef def = run(
        R"(<newvar a="1/4" /><drawsphere radius="#a*Dp"><point x="#a" y="#-a" z="#PosMax_x" /></drawsphere>)");
    const auto& sphere = *shape_as<SphereOp>(def.ops.at(0));
    EXPECT_DOUBLE_EQ(sphere.radius, 0.025);
    expect_near(sphere.center, {0.25, -0.25, 1.5});
}

TEST(Evars, ReplaceTheValuesOfTheDefinitionAndShowInItsCopy)
{
    CaseText text;
    text.predefinition = R"(<predefinition><newvarcte Width="1" /></predefinition>)";
    text.mainlist = R"(<drawpoint x="#Width" y="0" z="0" />)";
    CaseOptions options;
    options.evars = {{"Width", "0.5"}};
    const CaseDef def = read(text, options);
    EXPECT_EQ(shape_as<PointsOp>(def.ops.at(0))->points[0].x, 0.5);
    const Element* geometry = def.casedef.find_child("geometry");
    ASSERT_NE(geometry, nullptr);
    EXPECT_EQ(
        *geometry->find_child("predefinition")->find_child("newvarcte")->find_attribute("Width"),
        "0.5");
}

TEST(Evars, MustBeVariablesOfTheCase)
{
    CaseOptions options;
    options.evars = {{"Nowhere", "1"}};
    EXPECT_THROW(read(CaseText(), options), UsageError);
}

TEST(Runlist, RunsAListAsOftenAsItSays)
{
    CaseText text;
    text.lists = R"(<list name="Dots"><drawpoint x="#k" y="0" z="0" /><setvar k="k+1" /></list>)";
    text.mainlist =
        R"(<newvar k="0" /><runlist name="Dots" times="3" /><runlist name="Dots" times="0" />)";
    const CaseDef def = read(text);
    ASSERT_EQ(def.ops.size(), 3u);
    EXPECT_EQ(shape_as<PointsOp>(def.ops[2])->points[0].x, 2);
}

TEST(Runlist, RefusesTooManyCallsEvenOfAnEmptyList)
{
    CaseText text;
    text.lists =
        R"(<list name="A"><runlist name="B" times="1000000000" /></list><list name="B" printcall="false" />)";
    text.mainlist = R"(<runlist name="A" times="1000000000" />)";
    EXPECT_NE(
        error_of(text).find("<runlist>: 1e+18 commands or more would be run, expected at most "
                            "10000000"),
        std::string::npos);
}

TEST(Runlist, StopsAtSomeNumberOfCallsUnderAConditionOrByAVariable)
{
    CaseText text;
    text.lists =
        R"(<list name="A"><runlist name="B" times="#1000*1000" /></list><list name="B" printcall="false" />)";
    text.mainlist = R"(<runlist name="A" times="1000000" />)";
    EXPECT_NE(error_of(text).find(" commands or more would be run"), std::string::npos);
}

TEST(Printf, FillsInVariables)
{
    const CaseDef def = run(R"(<newvar a="3" /><printf text="a is [a], its double [2*a]" />)");
    EXPECT_NE(std::find(def.list_log.begin(), def.list_log.end(), "a is 3, its double 6"),
              def.list_log.end());
}

// -- the lattice
// ------------------------------------------------------------------------------------------

TEST(Definition, GoesThroughPointref)
{
    CaseText text;
    text.pointmin = R"(<pointref x="0" y="0" z="0" /><pointmin x="-0.37" y="0.05" z="0.1" />)";
    const LatticeGrid grid = read(text).grid;
    expect_near(grid.origin, {-0.4, 0, 0.1});
}

TEST(Definition, IsThatOfGenCaseToTheLastBit)
{
    // pointmin, pointref, dp and the lowest node of GenCase v5.4.354; of the last, the node at
    // pointmin is lost to a rounding error.
    const double values[][4] = {{-0.421, -0.493, 0.125, -0.49299999999999994},
                                {0.164, 0.284, 0.125, 0.15899999999999995},
                                {0.122, 0.313, 0.08, 0.07299999999999997},
                                {-0.483, -0.163, 0.08, -0.483},
                                {0.224, 0.464, 0.08, 0.14400000000000007}};
    for (const auto& [low, ref, dp, lowest] : values)
    {
        CaseText text;
        text.pointmin =
            fmt::format(R"(<pointref x="{}" /><pointmin x="{}" y="0" z="0" />)", ref, low);
        CaseOptions options;
        options.dp = dp;
        EXPECT_EQ(read(text, options).grid.origin.x, lowest) << low << " through " << ref;
    }
}

TEST(Definition, TakesDpFromTheCommandLine)
{
    CaseOptions options;
    options.dp = 0.25;
    EXPECT_EQ(read(CaseText(), options).grid.dp, 0.25);
}

TEST(Definition, IsFlatWhereTheLimitsOfYAreEqual)
{
    CaseText text;
    text.pointmin = R"(<pointmin x="0" y="0.3" z="0" />)";
    text.pointmax = R"(<pointmax x="1" y="0.3" z="1" />)";
    const CaseDef def = read(text);
    EXPECT_TRUE(def.grid.is_2d);
    EXPECT_EQ(def.grid.n[1], 1u);
    EXPECT_EQ(def.grid.origin.y, 0.3);
    EXPECT_DOUBLE_EQ(def.mass_fluid, 1000 * 0.1 * 0.1);
    EXPECT_DOUBLE_EQ(def.h, std::sqrt(2.0) * 0.1);
}

// The solver v5.4 turns zones clockwise seen from point2: a zone along x, turned by 90 degrees
// about z, goes to -y, also where its box is told in radians.
TEST(Definition, TurnsZonesOfInOutAsTheSolver)
{
    for (const char* angle : {R"(angle="90" anglesunits="degrees")",
                              R"(angle="1.5707963267948966" anglesunits="radians")"})
    {
        CaseText text;
        text.after_geometry = "<fppg><bodyfitted /></fppg>";
        text.execution += fmt::format(
            R"(<special><inout><inoutzone><zone3d><box><point x="0.7" y="0.5" z="0.1" /><size x="0.2" y="0" z="0.4" />)"
            R"(<direction x="0" y="1" z="0" /><rotateaxis {}><point1 x="0.7" y="0.5" z="0" /><point2 x="0.7" y="0.5" z="1" /></rotateaxis></box></zone3d></inoutzone></inout></special>)",
            angle);
        const CaseDef def = read(text);
        ASSERT_EQ(def.solver.inout.shapes.size(), 1u);
        const Box3& box = def.solver.inout.shapes[0].box;
        EXPECT_LT(norm(box.min - Vec3{0.7, 0.3, 0.1}), 1e-12);
        EXPECT_LT(norm(box.max - Vec3{0.7, 0.5, 0.5}), 1e-12);
        EXPECT_LT(norm(def.solver.inout.shapes[0].way - Vec3{1, 0, 0}), 1e-12);
    }
}

TEST(Definition, TakesARoundZoneForADisk)
{
    CaseText text;
    text.after_geometry = "<fppg><bodyfitted /></fppg>";
    text.execution +=
        R"(<special><inout><inoutzone><zone3d><circle><point x="0.7" y="0.5" z="0.1" /><radius v="0.2" /><direction x="0.6" y="0" z="0.8" /></circle></zone3d></inoutzone></inout></special>)";
    const CaseDef def = read(text);
    ASSERT_EQ(def.solver.inout.shapes.size(), 1u);
    const Box3& box = def.solver.inout.shapes[0].box;
    EXPECT_LT(norm(box.min - Vec3{0.54, 0.3, -0.02}), 1e-12);
    EXPECT_LT(norm(box.max - Vec3{0.86, 0.7, 0.22}), 1e-12);
}

/// As many as the log of DualSPHysics v5.4 says ("InOut points") for these sizes and dp.
TEST(Definition, SetsThePointsOfInletsAsTheSolver)
{
    const auto points = [](const char* dp, const std::string& zone)
    {
        CaseText text;
        text.dp = dp;
        text.after_geometry = "<fppg><bodyfitted /></fppg>";
        text.execution += "<special><inout><inoutzone><zone3d>" + zone +
                          "</zone3d></inoutzone></inout></special>";
        const CaseDef def = read(text);
        EXPECT_EQ(def.solver.inout.shapes.size(), 1u);
        return def.solver.inout.shapes.at(0).points;
    };
    const auto disk = [&](const char* dp, double radius)
    {
        const std::vector<Vec3> found = points(
            dp,
            fmt::format(
                R"(<circle><point x="0.7" y="0.5" z="0.1" /><radius v="{}" /><direction x="0.6" y="0" z="0.8" /></circle>)",
                radius));
        for (const Vec3& p : found)
        {
            EXPECT_NEAR(dot(p - Vec3{0.7, 0.5, 0.1}, Vec3{0.6, 0, 0.8}), 0, 1e-12);
            EXPECT_LE(norm(p - Vec3{0.7, 0.5, 0.1}), radius + 1e-12);
        }
        return found.size();
    };
    EXPECT_EQ(disk("0.0455", 0.17778145), 62u);
    EXPECT_EQ(disk("0.0135", 0.061122538), 71u);
    EXPECT_EQ(disk("0.0266", 0.10844978), 65u);
    EXPECT_EQ(disk("0.00937", 0.043238422), 73u);
    EXPECT_EQ(disk("0.0305", 0.068437578), 22u);
    const auto box = [&](const char* dp, const char* size)
    {
        return points(
                   dp,
                   fmt::format(
                       R"(<box><point x="0" y="0" z="0" /><size x="0" y="{0}" z="{0}" /><direction x="1" y="0" z="0" /></box>)",
                       size))
            .size();
    };
    EXPECT_EQ(box("0.0423", "0.1692423"), 25u);
    EXPECT_EQ(box("0.0465", "0.1395465"), 16u);
    EXPECT_EQ(box("0.01", "0.0396"), 25u); // nearly 4 dp: nearer to one another
}

TEST(Definition, KnowsTheWayInAtThePointsOfAnInlet)
{
    CaseText text;
    text.after_geometry = "<fppg><bodyfitted /></fppg>";
    text.execution +=
        R"(<special><inout><inoutzone><layers value="4" /><zone3d><particles mkfluid="3" direction="back" /></zone3d></inoutzone></inout></special>)";
    const CaseDef def = read(text);
    ASSERT_EQ(def.solver.inout.fluids.size(), 1u);
    EXPECT_EQ(def.solver.inout.fluids.begin()->first, def.mk_fluid_first + 3);
    EXPECT_EQ(def.solver.inout.fluids.begin()->second.way, (Vec3{0, 1, 0}));
    EXPECT_EQ(def.solver.inout.fluids.begin()->second.layers, 4);
}

} // namespace
} // namespace fppg
