// What the program says where GenCase says nothing, -strict, floating bodies in the log, the files
// of shapeout, cellsout and pointsmkout, and forms of definitions; FPPG_PROGRAM is its path.

#include "helpers/case_text.h"
#include "helpers/run_program.h"

#include <gtest/gtest.h>

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <sstream>

namespace
{

namespace fs = std::filesystem;
using fppg::test::box_command;
using fppg::test::CaseText;
using fppg::test::Process;
using fppg::test::read_text;
using fppg::test::RunResult;
using fppg::test::tank;
using fppg::test::TemporaryFolder;
using fppg::test::write_text;

bool contains(const std::string& text, const std::string& part)
{
    return text.find(part) != std::string::npos;
}

/// A cube as ASCII STL; `facets` of its twelve.
std::string cube_stl(double low, double high, int facets = 12)
{
    const std::array<std::array<int, 3>, 12> corners{{{0, 2, 3},
                                                      {0, 3, 1},
                                                      {4, 5, 7},
                                                      {4, 7, 6},
                                                      {0, 1, 5},
                                                      {0, 5, 4},
                                                      {2, 6, 7},
                                                      {2, 7, 3},
                                                      {0, 4, 6},
                                                      {0, 6, 2},
                                                      {1, 3, 7},
                                                      {1, 7, 5}}};
    std::ostringstream out;
    out << "solid cube\n";
    for (int f = 0; f < facets; ++f)
    {
        out << "facet normal 0 0 0\nouter loop\n";
        for (const int c : corners[static_cast<std::size_t>(f)])
            out << "vertex " << ((c & 1) != 0 ? high : low) << ' ' << ((c & 2) != 0 ? high : low)
                << ' ' << ((c & 4) != 0 ? high : low) << '\n';
        out << "endloop\nendfacet\n";
    }
    out << "endsolid cube\n";
    return out.str();
}

/// A case in a folder of its own, with cube.stl (0 to 0.5) and part.stl (the same without a facet).
struct Scene
{
    TemporaryFolder folder;
    CaseText text;

    Scene()
    {
        write_text(folder / "cube.stl", cube_stl(0, 0.5));
        write_text(folder / "part.stl", cube_stl(0, 0.5, 11));
        write_text(folder / "mm.stl", cube_stl(0, 500));
        write_text(folder / "small.stl", cube_stl(0, 0.0005));
    }
    explicit Scene(const std::string& commands, const std::string& after_geometry = "") : Scene()
    {
        text.after_geometry = after_geometry;
        text.mainlist = R"(<setdrawmode mode="full" /><setmkbound mk="0" />)" + commands;
    }

    RunResult run(std::vector<std::string> options = {}) const
    {
        write_text(folder / "Case_Def.xml", text.text());
        options.insert(options.begin(), {"Case_Def", "out/Case"});
        return Process(FPPG_PROGRAM, options, folder.path().string()).wait();
    }
    std::string out(const std::string& name) const
    {
        return read_text(folder / ("out/Case" + name));
    }
    bool has(const std::string& name) const { return fs::exists(folder / ("out/Case" + name)); }
};

/// Whether the case runs, warns in these words, and fails with -strict.
void expect_diagnostic(const Scene& scene, const std::string& words)
{
    const RunResult usual = scene.run();
    EXPECT_EQ(usual.code, 0) << usual.output;
    EXPECT_TRUE(contains(usual.output, "Case_Def.xml:")) << usual.output;
    EXPECT_TRUE(contains(usual.output, words)) << usual.output;
    fs::remove_all(scene.folder / "out");
    const RunResult strict = scene.run({"-strict"});
    EXPECT_EQ(strict.code, 3) << strict.output;
    EXPECT_TRUE(contains(strict.output, words)) << strict.output;
    EXPECT_FALSE(scene.has(".bi4"));
}

TEST(Diagnostic, AMeshFileInMillimetresIsTold)
{
    expect_diagnostic(Scene(R"(<drawfilestl file="mm.stl" />)"),
                      "mm.stl is 500 m wide in a domain of 2");
    expect_diagnostic(Scene(R"(<drawfilestl file="small.stl" />)"), R"(<drawscale x="1000")");
}

TEST(Diagnostic, AFillThatLeaksIsTold)
{
    expect_diagnostic(
        Scene(box_command(R"(x="0" y="0" z="0")", R"(x="1" y="1" z="1")", "bottom") +
              R"(<fillpoint x="0.5" y="0.5" z="0.5"><modefill>void</modefill></fillpoint>)"),
        "the fill reached the border of the domain (lowest x, highest x");
}

TEST(Diagnostic, AFillsSeedInASolidIsTold)
{
    expect_diagnostic(
        Scene(box_command(R"(x="0" y="0" z="0")", R"(x="1" y="1" z="1")") +
              R"(<fillpoint x="0.5" y="0.5" z="0.5"><modefill>void</modefill></fillpoint>)"),
        "lies in the solid of mkbound 0");
}

TEST(Diagnostic, AFillsSeedOutsideTheDomainIsTold)
{
    expect_diagnostic(
        Scene(box_command(R"(x="0" y="0" z="0")", R"(x="1" y="1" z="1")") +
              R"(<fillpoint x="7" y="0.5" z="0.5"><modefill>void</modefill></fillpoint>)"),
        "is outside the domain");
}

TEST(Diagnostic, AFilledMeshWithAHoleIsTold)
{
    expect_diagnostic(Scene(R"(<drawfilestl file="part.stl" autofill="true" />)"),
                      "part.stl has 3 open edges");
}

TEST(Diagnostic, ABodyThinnerThanDpIsTold)
{
    expect_diagnostic(Scene(box_command(R"(x="0" y="0" z="0")", R"(x="1" y="1" z="0.04")")),
                      "the body is 0.04 m thick, less than dp = 0.1 m");
}

TEST(Diagnostic, AShapeBeyondTheNodesIsTold)
{
    // The node at pointmax 1.5 is not part of the lattice.
    expect_diagnostic(Scene(box_command(R"(x="0" y="0" z="0")", R"(x="1.5" y="1" z="1")")),
                      "it reaches from x = 0 to 1.5, the nodes of the domain from -0.5 to 1.4");
}

TEST(Diagnostic, AnAutofillOfTheWrongSpaceIsTold)
{
    // The cube's lid is missing: nothing is inside it, and the flood fills it all the same.
    Scene scene(R"(<drawfilestl file="open.stl" autofill="true" />)");
    write_text(scene.folder / "open.stl", cube_stl(0, 0.5, 10));
    EXPECT_TRUE(contains(scene.run().output, "open.stl has 4 open edges"));
}

/// A motion of mkbound 0.
std::string motion_of_walls(const std::string& movement)
{
    return R"(<motion><objreal ref="0"><begin mov="1" start="0" />)" + movement +
           "</objreal></motion>";
}

/// About an axis along y.
std::string turn_about(double x)
{
    return motion_of_walls(fmt::format(
        R"(<mvrot id="1" duration="5"><vel ang="360" /><axisp1 x="{0}" y="0" z="0.5" /><axisp2 x="{0}" y="1" z="0.5" /></mvrot>)",
        x));
}

std::string domain_of_solver(const std::string& from, const std::string& to)
{
    return R"(<parameters><simulationdomain><posmin x=")" + from +
           R"(" y="default" z="default - 5%" /><posmax x=")" + to +
           R"(" y="default" z="default + 50%" /></simulationdomain></parameters>)";
}

TEST(Diagnostic, AMovingPartThatLeavesTheDomainIsTold)
{
    Scene scene(box_command(R"(x="0" y="0" z="0")", R"(x="0.3" y="0.3" z="0.3")"));
    scene.text.after_geometry =
        motion_of_walls(R"(<mvrect id="1" duration="-1"><vel x="0.01" y="0" z="0" /></mvrect>)");
    // The domain is that of the particles and 0.05 h, within which it stays for 0.9 s.
    expect_diagnostic(scene, R"(<objreal ref="0">: by t = 0.8)");
    const std::string usual = scene.text.execution;
    scene.text.execution =
        R"(<parameters><parameter key="XPeriodicIncZ" value="0" /></parameters>)";
    EXPECT_FALSE(contains(scene.run().output, "<objreal")) << "it comes back at the other end";
    scene.text.execution = usual;
    // Where other particles are there is room.
    scene.text.mainlist += R"(<setmkbound mk="1" />)" +
                           box_command(R"(x="-0.4" y="0" z="0.5")", R"(x="1.2" y="0.3" z="0.3")");
    scene.text.after_geometry =
        motion_of_walls(R"(<mvrect id="1" duration="2"><vel x="0.2" y="0" z="0" /></mvrect>)");
    EXPECT_FALSE(contains(scene.run().output, "<objreal"));
    scene.text.after_geometry = turn_about(1.2);
    expect_diagnostic(scene, R"(<objreal ref="0">: by t =)");
}

TEST(Diagnostic, AMovingPartStaysInTheDomainThatTheCaseGivesTheSolver)
{
    Scene scene(box_command(R"(x="0" y="0" z="0")", R"(x="0.3" y="0.3" z="0.3")"));
    scene.text.after_geometry = motion_of_walls(
        R"(<mvrectsinu id="1" duration="50"><freq x="1" y="0" z="0" /><ampl x="0.1" y="0" z="0" /><phase x="0" y="0" z="0" /></mvrectsinu>)");
    for (const auto& [from, to] :
         {std::pair{"default - 50%", "default + 50%"}, std::pair{"default - 0.11", "default+0.11"},
          std::pair{"-0.2", "0.5"}})
    {
        scene.text.execution = domain_of_solver(from, to);
        EXPECT_FALSE(contains(scene.run().output, "<objreal")) << from;
    }
    for (const auto& [from, to] :
         {std::pair{"default", "default + 50%"}, std::pair{"default - 50%", "default"},
          std::pair{"default - 0.05", "default + 1"}, std::pair{"-0.2", "0.35"}})
    {
        scene.text.execution = domain_of_solver(from, to);
        EXPECT_TRUE(contains(scene.run().output, "it has left the domain of the solver")) << from;
    }
}

TEST(Diagnostic, AWheelThatTurnsInTheDomainDoesNotLeaveIt)
{
    // The corners of its box would.
    Scene scene(
        R"(<drawcylinder radius="0.9"><point x="0.5" y="0" z="0.5" /><point x="0.5" y="0.3" z="0.5" /></drawcylinder>)");
    scene.text.execution = domain_of_solver("default - 5%", "default + 5%");
    scene.text.after_geometry = turn_about(0.5);
    EXPECT_FALSE(contains(scene.run().output, "<objreal"));
    scene.text.after_geometry = turn_about(0.75);
    expect_diagnostic(scene, R"(<objreal ref="0">: by t =)");
}

TEST(Diagnostic, NothingIsToldOfASoundCase)
{
    Scene scene;
    scene.text = tank();
    const RunResult result = scene.run({"--strict"});
    EXPECT_EQ(result.code, 0) << result.output;
    EXPECT_FALSE(contains(result.output, "WARNING")) << result.output;
}

// -- floating bodies
// ------------------------------------------------------------------------------

std::string floats(const std::string& floating, const std::string& fppg = "")
{
    return "<floatings>" + floating + "</floatings>" + fppg;
}

constexpr const char* half_dense = R"(<floating mkbound="0" rhopbody="500" />)";
constexpr const char* take_exact = R"(<fppg><floatings exact="true" mkbound="0" /></fppg>)";

TEST(ExactFloating, IsShownBesideThatOfTheParticles)
{
    const Scene scene(box_command(R"(x="0.1" y="0.1" z="0.1")", R"(x="0.4" y="0.5" z="0.6")"),
                      floats(half_dense));
    const RunResult result = scene.run();
    EXPECT_TRUE(contains(result.output, "mkbound 0: mass 105 kg")) << result.output;
    EXPECT_TRUE(contains(result.output,
                         "volume 0.12 m^3, mass 60 kg, centre (0.3, 0.35, 0.4) m, "
                         "inertia xx yy zz (3.05, 2.6, 2.05)"))
        << result.output;
    EXPECT_TRUE(contains(scene.out(".xml"), "<massbody value=\"105"));
}

TEST(ExactFloating, IsTakenIntoTheCaseOnRequest)
{
    const Scene scene =
        Scene(R"(<drawsphere radius="0.4"><point x="0.5" y="0.5" z="0.5" /></drawsphere>)",
              floats(half_dense, take_exact));
    const RunResult result = scene.run();
    EXPECT_EQ(result.code, 0) << result.output;
    const std::string xml = scene.out(".xml");
    const std::size_t at = xml.find("<massbody value=\"") + 17;
    const double mass = 500 * 4.0 / 3 * M_PI * 0.064;
    EXPECT_NEAR(std::stod(xml.substr(at)), mass, 1e-9);
    const std::size_t inertia = xml.find("<inertia x=\"") + 12;
    EXPECT_NEAR(std::stod(xml.substr(inertia)), 0.4 * mass * 0.16, 1e-9);
}

TEST(ExactFloating, OfATurnedMeshIsThatOfTheMeshTurned)
{
    const Scene scene(
        R"(<drawfilestl file="cube.stl"><drawscale x="1" y="1" z="2" /><drawrotate angx="0" angy="90" angz="0" /><drawmove x="0" y="0.2" z="0.7" /></drawfilestl>)",
        floats(half_dense, take_exact));
    const RunResult result = scene.run();
    EXPECT_EQ(result.code, 0) << result.output;
    // 0.5 x 0.5 x 1 turned about y lies along x.
    EXPECT_TRUE(contains(result.output,
                         "volume 0.25 m^3, mass 125 kg, centre (0.5, 0.45, 0.45) m, "
                         "inertia xx yy zz (5.208"))
        << result.output;
    EXPECT_TRUE(contains(result.output, "13.0208333, 13.0208333)")) << result.output;
}

TEST(ExactFloating, OfSeveralShapesIsNone)
{
    const std::string two = box_command(R"(x="0" y="0" z="0")", R"(x="0.4" y="0.5" z="0.6")") +
                            box_command(R"(x="1" y="0" z="0")", R"(x="0.2" y="0.5" z="0.6")");
    const RunResult usual = Scene(two, floats(half_dense)).run();
    EXPECT_EQ(usual.code, 0);
    EXPECT_TRUE(contains(usual.output, "there is no single closed shape of it: 2 draws make it"));
    const RunResult asked = Scene(two, floats(half_dense, take_exact)).run();
    EXPECT_EQ(asked.code, 3);
    EXPECT_TRUE(contains(asked.output, "<floatings exact=\"true\">: mkbound 0")) << asked.output;
}

// -- pictures
// ----------------------------------------------------------------------------------------

std::string shown_box(const std::string& out)
{
    return "<setshapemode>actual | bound</setshapemode>" +
           box_command(R"(x="0" y="0" z="0")", R"(x="0.3" y="0.2" z="0.4")") + out;
}

TEST(ShapeOut, WritesEveryFormat)
{
    const Scene scene(shown_box(
        R"(<shapeout file="a" reset="false" /><shapeout file="a" format="vtp" reset="false" /><shapeout file="a" format="VTU" reset="false" /><shapeout file="a" format="Stl" savenormal="1" />)"));
    const RunResult result = scene.run();
    ASSERT_EQ(result.code, 0) << result.output;
    EXPECT_TRUE(contains(scene.out("_a_Actual.vtp"), R"(NumberOfPoints="8" NumberOfVerts="0")"));
    EXPECT_TRUE(contains(scene.out("_a_Actual.vtu"), R"(NumberOfCells="6")"));
    EXPECT_EQ(scene.out("_a_Actual.stl").size(), 84U + 12 * 50);
    EXPECT_TRUE(scene.has("_a_Actual_Nor.stl"));
    const std::string xml = scene.out(".xml");
    EXPECT_TRUE(contains(xml, "Case_a_Actual.vtp"));
    EXPECT_FALSE(contains(xml, "Actual.stl")); // GenCase lists no STL
}

TEST(ShapeOut, IsReadBackAsItWasDrawn)
{
    Scene scene(shown_box(
        R"(<shapeout file="a" format="vtp" reset="false" /><shapeout file="b" format="vtu" reset="false" /><shapeout file="c" format="stl" />)"));
    ASSERT_EQ(scene.run().code, 0);
    const std::string whole = scene.run().output;
    const auto count = [](const std::string& output)
    {
        const std::size_t at = output.find("Total particles: ");
        return output.substr(at, output.find('(', at) - at);
    };
    for (const char* file : {"drawfilevtk file=\"out/Case_a_Actual.vtp\"",
                             "drawfilevtk file=\"out/Case_b_Actual.vtu\"",
                             "drawfilestl file=\"out/Case_c_Actual.stl\""})
    {
        Scene again(std::string("<") + file + " />");
        fs::copy(scene.folder / "out", again.folder / "out");
        const RunResult result = again.run();
        EXPECT_EQ(result.code, 0) << result.output;
        // The shell of 4 x 3 x 5 nodes has 54.
        EXPECT_TRUE(contains(count(result.output), "54")) << file << result.output;
    }
}

TEST(ShapeOut, ShowsNormalsAsLines)
{
    const Scene scene(shown_box(R"(<shapeout file="n" savenormal="1.5" />)"));
    ASSERT_EQ(scene.run().code, 0);
    EXPECT_FALSE(contains(scene.out("_n_Actual.vtk"), "LINES"));
    EXPECT_TRUE(contains(scene.out("_n_Actual_Nor.vtk"), "LINES 6 18"));
    EXPECT_TRUE(contains(scene.out("_n_Actual_Nor.vtk"), "POINTS 20 float"));
}

TEST(ShapeOut, RefusesAnUnknownFormat)
{
    const RunResult result = Scene(shown_box(R"(<shapeout file="n" format="obj" />)")).run();
    EXPECT_EQ(result.code, 3);
    EXPECT_TRUE(contains(result.output, "expected vtk, vtp, vtu or stl")) << result.output;
}

TEST(CellsOut, WritesTheCellsOfNow)
{
    const Scene scene(
        shown_box(
            R"(<cellsout file="a" /><cellsout file="b" mkbound="0" /><cellsout file="e" mkfluid="3" /><setmkbound mk="1" />)") +
        box_command(R"(x="1" y="1" z="1")", R"(x="0.2" y="0.2" z="0.2")"));
    const RunResult result = scene.run();
    ASSERT_EQ(result.code, 0) << result.output;
    EXPECT_TRUE(contains(scene.out("_a_MkCells.vtk"), "SCALARS Mk int"));
    EXPECT_TRUE(contains(scene.out("_b_MkCells_mkbound0.vtk"), "ObjId 1 6 int"));
    EXPECT_FALSE(scene.has("_e_MkCells_mkfluid3.vtk"));
}

TEST(PointsMkOut, WritesTheNodesAtTheBorderOfTheMk)
{
    const Scene scene(
        shown_box(R"(<pointsmkout file="p" /><setmkbound mk="7" /><pointsmkout file="p" />)"));
    ASSERT_EQ(scene.run().code, 0);
    // 54 of 60 nodes; of an mk without nodes GenCase writes the origin.
    EXPECT_TRUE(contains(scene.out("_p_mk10.vtk"), "POINTS 54 float"));
    EXPECT_TRUE(contains(scene.out("_p_mk17.vtk"), "POINTS 1 float"));
}

// -- forms of definitions
// ----------------------------------------------------------------------------

std::string with_windows_ends(const std::string& text)
{
    std::string out;
    for (const char c : text) out += c == '\n' ? std::string("\r\n") : std::string(1, c);
    return out;
}

TEST(Definition, MayHaveWindowsLineEndsAndAByteOrderMark)
{
    const TemporaryFolder folder;
    write_text(folder / "a.xml", tank().text());
    write_text(folder / "b.xml", "\xEF\xBB\xBF" + with_windows_ends(tank().text()));
    for (const char* name : {"a", "b"})
        ASSERT_EQ(Process(FPPG_PROGRAM, {name, std::string(name) + "/Case"}, folder.path().string())
                      .wait()
                      .code,
                  0);
    EXPECT_EQ(read_text(folder / "a/Case.bi4"), read_text(folder / "b/Case.bi4"));
}

TEST(Definition, CountsLinesOfWindowsFilesToo)
{
    const TemporaryFolder folder;
    CaseText text = tank();
    text.mainlist = "<setmkbound mk=\"0\" />\n<drawfoo />";
    write_text(folder / "a.xml", with_windows_ends(text.text()));
    const RunResult result =
        Process(FPPG_PROGRAM, {"a", "out/Case"}, folder.path().string()).wait();
    EXPECT_EQ(result.code, 3);
    EXPECT_TRUE(contains(result.output, "a.xml:8: <drawfoo>")) << result.output;
}

TEST(Definition, MayLieInFoldersWithBlanksAndAccents)
{
    const TemporaryFolder folder;
    const std::string name = "mon d\xC3\xA9versoir n\xC2\xB0 1";
    fs::create_directory(folder / name);
    CaseText text = tank();
    text.mainlist +=
        "<drawfilestl file=\"pi\xC3\xA8"
        "ce une.stl\" />";
    write_text(folder / (name + "/pi\xC3\xA8"
                                "ce une.stl"),
               cube_stl(0.2, 0.6));
    write_text(folder / (name + "/Case_Def.xml"), text.text());
    const RunResult result =
        Process(FPPG_PROGRAM, {name + "/Case_Def", name + "/out dir/Case \xC3\xA9"},
                folder.path().string())
            .wait();
    EXPECT_EQ(result.code, 0) << result.output;
    EXPECT_TRUE(fs::exists(folder / (name + "/out dir/Case \xC3\xA9.bi4")));
    EXPECT_TRUE(fs::exists(folder / (name + "/out dir/pi\xC3\xA8"
                                            "ce une.stl")));
}

TEST(Definition, MayHoldCommentsAnywhere)
{
    const TemporaryFolder folder;
    CaseText text = tank();
    text.mainlist = "<!-- one --><!-- <drawfoo /> -->" + text.mainlist + "<!-- last -->";
    write_text(folder / "a.xml", "<!-- before -->\n" + text.text() + "<!-- after -->\n");
    EXPECT_EQ(Process(FPPG_PROGRAM, {"a", "out/Case"}, folder.path().string()).wait().code, 0);
}

struct Spelling
{
    std::string commands;
    bool is_accepted;
};

class UpperCase : public testing::TestWithParam<Spelling>
{
};

TEST_P(UpperCase, IsTreatedAsByGenCase)
{
    const Scene scene(GetParam().commands);
    const RunResult result = scene.run();
    EXPECT_EQ(result.code, GetParam().is_accepted ? 0 : 3) << GetParam().commands << result.output;
}

// Each tried with GenCase v5.4.354.
INSTANTIATE_TEST_SUITE_P(
    Of, UpperCase,
    testing::Values(
        Spelling{R"(<setdrawmode mode="FULL" />)", false},
        Spelling{R"(<SetDrawMode mode="full" />)", false},
        Spelling{box_command(R"(x="0" y="0" z="0")", R"(x="1" y="1" z="1")", "SOLID"), false},
        Spelling{box_command(R"(x="0" y="0" z="0")", R"(x="1" y="1" z="1")", " solid "), true},
        Spelling{R"(<drawpoint X="0" y="0" z="0" />)", false},
        Spelling{R"(<drawpoint x=" 0.02 " y="+0" z="2e-2" />)", true},
        Spelling{R"(<drawpoint x="0,02" y="0" z="0" />)", false},
        Spelling{R"(<drawpoint x=".02" y="0" z="0" />)", true},
        Spelling{R"(<setmkbound mk=" 1 " />)", true}, Spelling{R"(<setmkbound mk="01" />)", true},
        Spelling{R"(<setmkbound mk="+1" />)", true}, Spelling{R"(<setmkbound mk="1.0" />)", true},
        Spelling{R"(<setshapemode>DP | bound</setshapemode>)", false},
        Spelling{R"(<setboxlimitmode mode="Full" />)", false},
        Spelling{R"(<fillpoint x="1" y="1" z="1"><modefill>VOID</modefill></fillpoint>)", false},
        Spelling{R"(<redrawnear targettp="Void" bordertp="bound" times="1" />)", true},
        Spelling{R"(<setactive drawpoints="False" drawshapes="1" />)", true},
        Spelling{R"(<setnormalinvert invert="TRUE" />)", true},
        Spelling{R"x(<drawpoint x="#PI()" y="0" z="0" />)x", false},
        Spelling{R"(<newvar A="1" /><newvar a="0" /><drawpoint x="#A" y="#a" z="0" />)", true}));

// -- motion, properties, parameters
// ------------------------------------------------------------------

struct Section
{
    std::string text;    ///< behind `<geometry>`
    std::string message; ///< empty: accepted
};

class Sections : public testing::TestWithParam<Section>
{
};

TEST_P(Sections, AreRefusedWhereGenCaseRefusesThem)
{
    Scene scene(box_command(R"(x="0" y="0" z="0")", R"(x="0.3" y="0.3" z="0.3")"));
    scene.text.after_geometry = GetParam().text;
    const RunResult result = scene.run();
    EXPECT_EQ(result.code, GetParam().message.empty() ? 0 : 3) << result.output;
    EXPECT_TRUE(contains(result.output, GetParam().message)) << result.output;
}

std::string motion(const std::string& movements)
{
    return "<motion><objreal ref=\"0\"><begin mov=\"1\" start=\"0\" />" + movements +
           "</objreal></motion>";
}

constexpr const char* even = R"(<mvrect id="1" duration="1"><vel x="0" y="0" z="0" /></mvrect>)";

// Each tried with GenCase v5.4.354.
INSTANTIATE_TEST_SUITE_P(
    Of, Sections,
    testing::Values(
        Section{motion(even), ""},
        Section{motion(R"(<mvrect id="1" duration="1" />)"), "<vel> is missing"},
        Section{motion(R"(<mvrect id="1"><vel x="0" y="0" z="0" /></mvrect>)"), "'duration'"},
        Section{motion(R"(<mvrect duration="1"><vel x="0" y="0" z="0" /></mvrect>)"), "'id'"},
        Section{motion(R"(<mvrect id="1" duration="1"><vel x="0" /></mvrect>)"), "'y' is missing"},
        Section{motion(std::string(even) + even), "is given twice"},
        Section{motion(R"(<wait id="2" duration="1" />)"), "names no movement"},
        Section{motion(R"(<wait id="1" duration="1" next="7" />)"), "names no movement"},
        Section{motion(R"(<mvrot id="1" duration="1"><vel ang="1" /></mvrot>)"), "<axisp1>"},
        Section{
            motion(
                R"(<mvrot id="1" duration="1" anglesunits="deg"><vel ang="1" /><axisp1 x="0" y="0" z="0" /><axisp2 x="0" y="0" z="1" /></mvrot>)"),
            "expected degrees or radians"},
        Section{motion(R"(<mvpredef id="1" duration="1" />)"), "<file> is missing"},
        Section{motion(R"(<mvfoo id="1" duration="1" />)"), "not known in <motion>"},
        Section{motion(R"(<mvnull id="1" anglesunits="x" duration="y" />)"), ""},
        Section{motion(R"(<mvnull />)"), "'id' is missing"},
        Section{motion(R"(<wait id="1" duration="1" anglesunits="deg" />)"),
                "expected degrees or radians"},
        Section{motion(R"(<mvfile id="1" duration="1"><file name="m.dat" /></mvfile>)"),
                "'fields' is missing"},
        Section{
            motion(
                R"(<mvpredef id="1" duration="1"><file name="m.dat" fields="2" fieldtime="0" /></mvpredef>)"),
            "at least one of the attributes fieldx, fieldy and fieldz"},
        Section{motion(R"(<mvpathfile id="1" duration="1"><file name="m.dat" /></mvpathfile>)"),
                "<center> is missing"},
        Section{"<motion><objreal ref=\"0\"><begin mov=\"1\" />" + std::string(even) +
                    "</objreal></motion>",
                "'start' is missing"},
        Section{"<motion><objreal ref=\"0\">" + std::string(even) + "</objreal></motion>", ""},
        Section{R"(<motion><objreal ref="0" /><objreal ref="0" /></motion>)",
                "has a motion already"},
        Section{R"(<properties><foo /></properties>)", "not known in <properties>"},
        Section{R"(<properties><links><link mkbound="0" property="A" /></links></properties>)",
                "no property named \"A\""},
        Section{
            R"(<properties><links><link property="A" /></links><property name="A" /></properties>)",
            "'mkbound' or 'mkfluid' is missing"},
        Section{R"(<properties><links><foo /></links></properties>)", ""},
        Section{
            R"(<properties><property name="A" v="1" /><property name="A" v="2" /></properties>)",
            "has a value v already"},
        Section{R"(<floatings><Floating mkbound="0" rhopbody="1" /></floatings>)", ""},
        Section{R"(<vres active="false" />)", ""},
        Section{R"(<vres><bufferbox /></vres>)", "the element <dpratio> is missing in it"},
        Section{R"(<vres active="#1"><bufferbox active="#0" /></vres>)", "not a valid boolean"},
        Section{R"(<vres><bufferbox active="#0" /></vres>)", "no region is defined"}));

// The counts are those of GenCase v5.4.354; the lattice line removes the point of mk 11.
TEST(Regions, TakeOutParticlesOffTheLatticeNearTheirNodes)
{
    Scene scene(R"(<setfrdrawmode auto="true" />
<drawline><point x="0.31" y="0" z="0.27" /><point x="4.61" y="0" z="4.43" /></drawline>
<drawline><point x="0.3" y="0" z="2.53" /><point x="4.61" y="0" z="2.53" /></drawline>
<setmkbound mk="1" /><drawpoint x="2.5" y="0" z="2.1" /><setfrdrawmode auto="false" />
<setmkbound mk="2" /><drawline><point x="0.3" y="0" z="4" /><point x="4.6" y="0" z="0.3" /></drawline>)",
                R"(<vres><bufferbox><point x="1" y="0" z="1" /><size x="3" y="0" z="3" />
<dpratio v="2" /></bufferbox></vres>)");
    scene.text.pointmin = R"(<pointmin x="0" y="0" z="0" />)";
    scene.text.pointmax = R"(<pointmax x="5" y="0" z="5" />)";
    const RunResult result = scene.run();
    ASSERT_EQ(result.code, 0) << result.output;
    const std::string outer = scene.out("_vres00.xml");
    EXPECT_TRUE(contains(outer, R"(<fixed mkbound="0" mk="10" begin="0" count="51")")) << outer;
    EXPECT_TRUE(contains(outer, R"(<fixed mkbound="2" mk="12" begin="51" count="37")")) << outer;
    const std::string inner = scene.out("_vres01.xml");
    EXPECT_TRUE(contains(inner, R"(<fixed mkbound="0" mk="10" begin="0" count="152")")) << inner;
    EXPECT_TRUE(contains(inner, R"(<fixed mkbound="2" mk="12" begin="152" count="102")")) << inner;
}

/// They would not meet across the period.
TEST(Regions, AreRefusedInPeriodicCasesWithParticlesOffTheLattice)
{
    Scene scene(R"(<setfrdrawmode auto="true" />
<drawline><point x="0.31" y="0" z="0.27" /><point x="4.61" y="0" z="4.43" /></drawline>)",
                R"(<vres><bufferbox><point x="1" y="0" z="1" /><size x="3" y="0" z="3" />
<dpratio v="2" /></bufferbox></vres>)");
    scene.text.pointmin = R"(<pointmin x="0" y="0" z="0" />)";
    scene.text.pointmax = R"(<pointmax x="5" y="0" z="5" />)";
    scene.text.execution =
        R"(<parameters><parameter key="XPeriodicIncZ" value="0" /></parameters>)";
    const RunResult result = scene.run();
    EXPECT_NE(result.code, 0);
    EXPECT_TRUE(contains(result.output, "regions of other resolution in a periodic case"))
        << result.output;
}

TEST(PropertyFile, GivesPropertiesToLinkedMks)
{
    Scene scene(box_command(R"(x="0" y="0" z="0")", R"(x="0.3" y="0.3" z="0.3")"));
    write_text(
        scene.folder / "steel.xml",
        R"(<case><properties><property name="A" x="1"><k v="2" /></property></properties></case>)");
    scene.text.after_geometry =
        R"(<properties><links><link mkbound="0" property="A" /></links><propertyfile file="steel.xml" path="case.properties" /></properties>)";
    const RunResult result = scene.run();
    ASSERT_EQ(result.code, 0) << result.output;
    EXPECT_TRUE(contains(scene.out(".xml"), R"(<property name="A" x="1">)"));
    EXPECT_TRUE(fs::exists(scene.folder / "out/steel.xml"));
    scene.text.after_geometry.replace(scene.text.after_geometry.find("case.prop"), 9, "case.grop");
    EXPECT_TRUE(contains(scene.run().output, "has no element case.groperties"));
}

TEST(Parameters, RefuseWhatGenCaseRefuses)
{
    Scene scene;
    scene.text = tank();
    scene.text.execution = "<parameters><foo /></parameters>";
    EXPECT_TRUE(contains(scene.run().output, "<foo>: is not known in <parameters>"));
    scene.text.execution = R"(<parameters><parameter key="A" /></parameters>)";
    EXPECT_TRUE(contains(scene.run().output, "'value' is missing"));
    scene.text.execution =
        R"(<special><anything /></special><parameters><parameter key="A" value="#1+1" /></parameters>)";
    EXPECT_EQ(scene.run().code, 0);
    EXPECT_TRUE(contains(scene.out(".xml"), R"(key="A" value="2")"));
}

// As GenCase v5.4.354 writes them.
TEST(Motion, IsWrittenInTheNamesThatTheSolverReads)
{
    Scene scene(box_command(R"(x="0" y="0" z="0")", R"(x="0.3" y="0.3" z="0.3")"));
    write_text(scene.folder / "m.dat", "0 0\n1 1\n");
    const std::string file = R"(<file name="m.dat" fields="2" fieldtime="0" fieldx="1" />)";
    scene.text.after_geometry =
        motion(R"(<mvfile id="1.0" duration="25" next="2" anglesunits="radians">)" + file +
               R"(</mvfile><mvpredef id="2" duration="3" next="3">)" + file +
               R"(</mvpredef><mvnull id="3" duration="5" next="4" /><wait id="4" duration="1" />)");
    const RunResult result = scene.run();
    ASSERT_EQ(result.code, 0) << result.output;
    std::string xml = scene.out(".xml");
    xml = xml.substr(xml.rfind("<motion>"));
    xml = xml.substr(0, xml.find("</motion>"));
    EXPECT_TRUE(contains(xml, R"(<mvrectfile id="1" duration="25" next="2">)")) << xml;
    EXPECT_TRUE(contains(xml, R"(<mvrectfile id="2" duration="3" next="3">)")) << xml;
    EXPECT_TRUE(contains(xml, R"(<mvnull id="3" />)")) << xml;
    EXPECT_FALSE(contains(xml, "<wait")) << xml;
}

TEST(DataFiles, OfMotionsGoBesideTheResult)
{
    Scene scene(box_command(R"(x="0" y="0" z="0")", R"(x="0.3" y="0.3" z="0.3")"));
    scene.text.after_geometry = motion(
        R"(<mvrectfile id="1" duration="1"><file name="m.dat" fields="2" fieldtime="0" fieldx="1" /></mvrectfile>)");
    EXPECT_TRUE(contains(scene.run().output, "file 'm.dat' was not found"));
    write_text(scene.folder / "m.dat", "0 0\n1 1\n");
    EXPECT_EQ(scene.run().code, 0);
    EXPECT_TRUE(fs::exists(scene.folder / "out/m.dat"));
}

} // namespace
