// What the program says of mistakes in a definition that run through without a word in GenCase
// v5.4, and how it names what was meant; FPPG_PROGRAM is its path.

#include "helpers/case_text.h"
#include "helpers/run_program.h"

#include <gtest/gtest.h>

namespace
{

namespace fs = std::filesystem;
using fppg::test::box_command;
using fppg::test::CaseText;
using fppg::test::Process;
using fppg::test::RunResult;
using fppg::test::tank;
using fppg::test::TemporaryFolder;
using fppg::test::write_text;

bool contains(const std::string& text, const std::string& part)
{
    return text.find(part) != std::string::npos;
}

RunResult run(const TemporaryFolder& folder, const CaseText& text,
              std::vector<std::string> options = {})
{
    write_text(folder / "Case_Def.xml", text.text());
    options.insert(options.begin(), {"Case_Def", "out/Case"});
    return Process(FPPG_PROGRAM, options, folder.path().string()).wait();
}

/// The case runs and warns in these words; with -strict it fails in them and writes nothing.
void expect_warning(const CaseText& text, const std::string& words)
{
    const TemporaryFolder folder;
    const RunResult usual = run(folder, text);
    EXPECT_EQ(usual.code, 0) << usual.output;
    EXPECT_TRUE(contains(usual.output, words)) << usual.output << "\nexpected: " << words;
    fs::remove_all(folder / "out");
    const RunResult strict = run(folder, text, {"-strict"});
    EXPECT_EQ(strict.code, 3) << strict.output;
    EXPECT_TRUE(contains(strict.output, words)) << strict.output;
    EXPECT_FALSE(fs::exists(folder / "out/Case.bi4"));
}

void expect_silence(const CaseText& text)
{
    const TemporaryFolder folder;
    const RunResult strict = run(folder, text, {"-strict"});
    EXPECT_EQ(strict.code, 0) << strict.output;
    EXPECT_FALSE(contains(strict.output, "WARNING")) << strict.output;
}

/// A tank with a box of mkbound 5 over the water.
CaseText tank_with_body(const std::string& after_geometry)
{
    CaseText text = tank();
    text.mainlist += R"(<setmkbound mk="5" />)" +
                     box_command(R"(x="0.4" y="0.4" z="0.7")", R"(x="0.3" y="0.3" z="0.2")");
    text.after_geometry = after_geometry;
    return text;
}

std::string motion_of(int ref)
{
    return R"(<motion><objreal ref=")" + std::to_string(ref) +
           R"("><begin mov="1" start="0" /><mvrect id="1" duration="0.1"><vel x="0" y="0" z="0.1" /></mvrect></objreal></motion>)";
}

TEST(MkWithoutParticles, OfAFloatingBlockIsTold)
{
    expect_warning(
        tank_with_body(R"(<floatings><floating mkbound="6" rhopbody="500" /></floatings>)"),
        "<floating>: mkbound 6 has no particle, so nothing floats; expected a mkbound that is "
        "drawn, those with particles are 0,5");
}

TEST(MkWithoutParticles, OfAMotionIsTold)
{
    expect_warning(tank_with_body(motion_of(6)),
                   R"(<objreal ref="6">: mkbound 6 has no particle, so nothing moves)");
}

TEST(MkWithoutParticles, OfABodyOutsideTheDomainIsTold)
{
    CaseText text = tank();
    text.mainlist += R"(<setmkbound mk="5" />)" +
                     box_command(R"(x="4" y="4" z="4")", R"(x="0.3" y="0.3" z="0.2")");
    text.after_geometry = motion_of(5);
    expect_warning(text, "mkbound 5 has no particle, so nothing moves");
}

TEST(MkWithoutParticles, OfSomeOfAListIsUsual)
{
    expect_silence(tank_with_body(
        R"(<floatings><floating mkbound="5-9"><massbody value="9" /></floating></floatings>)"));
}

TEST(UnknownName, OfAnAttributeIsToldWithTheNearestKnownOne)
{
    CaseText text = tank();
    text.mainlist += R"(<setdrawmode mod="full" mode="full" />)";
    expect_warning(text, R"(<setdrawmode>: attribute mod="full" is not known and has no effect )"
                         "(did you mean mode?), expected mode");
}

TEST(UnknownName, OfAnAttributeIsToldInEverySection)
{
    CaseText text = tank_with_body(
        R"(<floatings><floating mkbound="5" relativewieght="1" rhopbody="1030"><massbod /><center x="0.5" y="0.5" z="0.8" Z="1" /></floating></floatings>)"
        R"(<initials><velocity mkfluid="0" x="1" y="0" z="0" activ="false" /></initials>)");
    text.after_geometry.replace(text.after_geometry.find("<massbod />"), 11, "");
    text.constants.replace(text.constants.find("<hswl "), 6, R"(<hswl aut="1" )");
    text.pointmin.replace(text.pointmin.find(" x="), 1, R"( X="1" )");
    text.execution = R"(<parameters><parameter key="TimeMax" value="1" vaule="2" /></parameters>)";
    const TemporaryFolder folder;
    const RunResult result = run(folder, text);
    EXPECT_EQ(result.code, 0) << result.output;
    for (const char* words : {R"(<floating>: attribute relativewieght="1" is not known and has no )"
                              "effect (did you mean relativeweight?)",
                              R"(<velocity>: attribute activ="false" is not known and has no )"
                              "effect (did you mean active?)",
                              R"(<hswl>: attribute aut="1" is not known and has no effect (did )"
                              "you mean auto?)",
                              R"(<pointmin>: attribute X="1" is not known)",
                              R"(<parameter>: attribute vaule="2" is not known and has no effect )"
                              "(did you mean value?)",
                              R"(<center>: attribute Z="1" is not known)"})
        EXPECT_TRUE(contains(result.output, words)) << words << '\n' << result.output;
}

TEST(UnknownName, OfASectionIsTold)
{
    expect_warning(
        tank_with_body(R"(<floating><floating mkbound="5" rhopbody="500" /></floating>)"),
        "<floating>: is not known in <casedef> and has no effect (did you mean floatings?)");
}

TEST(UnknownName, OfRemarksIsLeftAlone)
{
    CaseText text = tank();
    text.mainlist += R"(<setmkbound mk="1" name="wall" comment="a" /><setdrawmode mode="full" )"
                     R"(cmt="a" objname="b" value_comment="c" _old="d" if="true" />)";
    text.execution = R"(<special><any thing="1" /></special><parameters />)";
    expect_silence(text);
}

TEST(Fluid, WithNoWallBelowItIsTold)
{
    CaseText text = tank();
    text.mainlist += R"(<setmkfluid mk="3" />)" +
                     box_command(R"(x="1.2" y="0" z="0.3")", R"(x="0.2" y="1" z="0.3")");
    expect_warning(text,
                   "particles of mkfluid 3 have no wall below them (x from 1.2 to 1.4, y "
                   "from 0 to 1 m), so gravity takes them out of the domain");
}

TEST(Fluid, OfAFillThatRunsPastItsTankIsTold)
{
    CaseText text = tank();
    text.mainlist =
        R"(<setdrawmode mode="full" /><setmkbound mk="0" />)" +
        box_command(R"(x="0" y="0" z="0")", R"(x="1" y="1" z="1")",
                    "bottom | left | front | back") +
        R"(<setmkfluid mk="0" /><fillbox x="0.5" y="0.5" z="0.3"><modefill>void</modefill>)"
        R"(<point x="0" y="0" z="0" /><size x="1.4" y="1" z="0.5" /></fillbox>)";
    expect_warning(text, "have no wall below them (x from 1.2 to 1.3");
}

TEST(Fluid, ThatFallsOntoAWallIsSound)
{
    CaseText text = tank();
    text.mainlist += R"(<setmkfluid mk="3" />)" +
                     box_command(R"(x="0.3" y="0.3" z="0.9")", R"(x="0.2" y="0.2" z="0.3")");
    expect_silence(text);
}

TEST(Fluid, OfAPeriodicCaseMayHaveNoWall)
{
    CaseText text = tank();
    text.mainlist += R"(<setmkfluid mk="3" />)" +
                     box_command(R"(x="1.2" y="0" z="0.3")", R"(x="0.2" y="1" z="0.3")");
    text.execution = R"(<parameters><parameter key="XPeriodicIncY" value="0" /></parameters>)";
    expect_warning(text, "have no wall below them");
    text.execution = R"(<parameters><parameter key="ZPeriodicIncX" value="0" /></parameters>)";
    expect_silence(text);
}

TEST(FloatingMass, OnTheLatticeIsToldWhereItIsFarFromThatOfTheShape)
{
    const TemporaryFolder folder;
    const CaseText text =
        tank_with_body(R"(<floatings><floating mkbound="5" rhopbody="500" /></floatings>)");
    expect_warning(text,
                   "mkbound 5: +167 %; its particles have 24 kg at 500 kg/m^3, while its "
                   "<drawbox> of line 7 has 0.018 m^3 and 9 kg");
    CaseText exact = text;
    exact.after_geometry += R"(<fppg><floatings exact="true" /></fppg>)";
    expect_silence(exact);
}

/// Two boxes that overlap, united; mkbound 1 is the upper one.
CaseText united_boxes(const std::string& after_geometry)
{
    CaseText text = tank();
    text.mainlist = R"(<setdrawmode mode="full" /><setmkbound mk="0" />)" +
                    box_command(R"(x="0" y="0" z="0")", R"(x="1" y="1" z="0.4")") +
                    R"(<setmkbound mk="1" />)" +
                    box_command(R"(x="0.3" y="0.3" z="0.2")", R"(x="0.4" y="0.4" z="0.8")");
    text.after_geometry = R"(<fppg><bodyfitted mkbound="0-1" /><boolean op="union">)"
                          R"(<part mkbound="0" /><part mkbound="1" /></boolean></fppg>)" +
                          after_geometry;
    return text;
}

/// The case fails with these words.
void expect_error(const CaseText& text, const std::string& words)
{
    const TemporaryFolder folder;
    write_text(folder / "part.stl", "");
    write_text(folder / "wheel.stl", "");
    const RunResult result = run(folder, text);
    EXPECT_NE(result.code, 0) << result.output;
    EXPECT_TRUE(contains(result.output, words)) << result.output << "\nexpected: " << words;
}

void expect_error_of_command(const std::string& command, const std::string& words)
{
    CaseText text = tank();
    text.mainlist += command;
    expect_error(text, words);
}

TEST(DidYouMean, NamesTheNearestCommandElementAndAttribute)
{
    expect_error_of_command("<drawbx />", "<drawbx>: is not a command (did you mean drawbox?)");
    expect_error_of_command("<drawfilestll />", "(did you mean drawfilestl?)");
    expect_error_of_command(R"(<drawfilestl fiel="part.stl" />)",
                            "attribute 'file' is missing; it has fiel, did you mean file?");
    expect_error_of_command(R"(<drawbox><boxfil>solid</boxfil></drawbox>)",
                            "<boxfil>: <drawbox> has no such element (did you mean boxfill?), "
                            "expected boxfill, endpoint, layers, point, size");
    expect_error_of_command(R"(<runlist name="wals" />)", "there is no list named 'wals'");
    expect_error(tank_with_body(R"(<motion><objreel ref="5" /></motion>)"),
                 "<objreel>: is not known in <motion> (did you mean objreal?), expected objreal, "
                 "obj, begin, wait, ");
    expect_error(tank_with_body(R"(<initials><velocty mkfluid="0" /></initials>)"),
                 "(did you mean velocity?)");
    expect_error(tank_with_body(R"(<fppg><bodyfited mkbound="0" /></fppg>)"),
                 "(did you mean bodyfitted?)");
}

TEST(DidYouMean, NamesTheMeshFilesThatLieThere)
{
    expect_error_of_command(R"(<drawfilestl file="weel.stl" />)",
                            "lie part.stl, wheel.stl (did you mean wheel.stl?)");
    expect_error_of_command(R"(<drawfilestl file="parts/wheel.stl" />)",
                            "there is no folder parts");
}

TEST(DidYouMean, NamesTheDefinitionAndTheSubcommand)
{
    const TemporaryFolder folder;
    write_text(folder / "Tank_Def.xml", tank().text());
    const auto output_of = [&](const std::vector<std::string>& arguments)
    { return Process(FPPG_PROGRAM, arguments, folder.path().string()).wait().output; };
    EXPECT_TRUE(contains(output_of({"Tnak_Def", "out"}), "(did you mean Tank_Def.xml?)"))
        << output_of({"Tnak_Def", "out"});
    EXPECT_TRUE(contains(output_of({"inpsect", "part.stl"}),
                         "\"inpsect\" is no subcommand (did you mean inspect?)"))
        << output_of({"inpsect", "part.stl"});
    EXPECT_TRUE(contains(output_of({"Tank_Def.xml", "out"}), "code=0"))
        << output_of({"Tank_Def.xml", "out"});
}

TEST(Subcommands, HaveHelpInWords)
{
    const TemporaryFolder folder;
    for (const char* name : {"batch", "check", "compare", "inspect", "leak", "render", "report",
                             "templates", "upgrade"})
    {
        const std::string help =
            Process(FPPG_PROGRAM, {name, "--help"}, folder.path().string()).wait().output;
        EXPECT_TRUE(contains(help, "Usage: fppg " + std::string(name))) << help;
        for (const char* jargon :
             {"(1x)", "UINT", "INT in", "FLOAT", "REQUIRED", "Excludes", ":TEXT"})
            EXPECT_FALSE(contains(help, jargon)) << name << " has " << jargon << '\n' << help;
    }
}

TEST(Subcommands, SayWhatAnOptionExpects)
{
    const TemporaryFolder folder;
    const auto output_of = [&](const std::vector<std::string>& arguments)
    { return Process(FPPG_PROGRAM, arguments, folder.path().string()).wait().output; };
    EXPECT_TRUE(contains(output_of({"inspect", "a.stl", "--dp", "-1"}),
                         "--dp: \"-1\" is invalid, expected above 0"))
        << output_of({"inspect", "a.stl", "--dp", "-1"});
    EXPECT_TRUE(contains(output_of({"compare", "a", "b", "--quite"}), "(did you mean --quiet?)"));
    for (const std::vector<std::string>& threads :
         {std::vector<std::string>{"--threads", "5000"}, {"-threads:5000"}})
    {
        std::vector<std::string> words{"compare", "a", "b"};
        words.insert(words.end(), threads.begin(), threads.end());
        EXPECT_TRUE(contains(output_of(words), "\"5000\" is invalid, expected 0 to 4096"));
    }
}

TEST(Tags, ThatAreNotClosedAreNamedWithTheirLine)
{
    CaseText text = tank();
    text.mainlist = "<setmkbound mk=\"0\">\n" + text.mainlist;
    expect_error(text,
                 "Case_Def.xml:7: this is not well-formed XML: <setmkbound> is opened here "
                 "and is not closed before </mainlist> of line 9");
    text = tank();
    text.mainlist += "</drawbox>";
    expect_error(text,
                 "Case_Def.xml:7: this is not well-formed XML: </drawbox> closes nothing; the "
                 "tag that is open is <mainlist> of line 6, expected </mainlist>");
    text = tank();
    text.mainlist += "<!-- no end";
    expect_error(text,
                 "Case_Def.xml:7: this is not well-formed XML: the comment that is opened "
                 "here has no end -->");
    text = tank();
    text.mainlist += "<drawbox mk=\"1 >";
    expect_error(text, "this is not well-formed XML: the tag <");
}

TEST(Union, OfAFixedAndAMovingPartIsTold)
{
    expect_warning(united_boxes(motion_of(1)),
                   "<boolean>: it unites mkbound 0, which is fixed, and mkbound 1, which moves: ");
    const TemporaryFolder folder;
    EXPECT_FALSE(contains(run(folder, united_boxes("")).output, "it unites"));
}

} // namespace
