// The program as its callers start it; FPPG_PROGRAM is its path.

#include "helpers/bi4_array.h"
#include "helpers/case_text.h"
#include "helpers/run_fppg.h"

#include <gtest/gtest.h>
#ifdef FPPG_JSON
#include <nlohmann/json.hpp>
#endif

#include <array>
#include <cctype>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <map>
#include <set>
#include <sstream>
#include <vector>

namespace
{

namespace fs = std::filesystem;
using namespace fppg::test;

RunResult shell(const TemporaryFolder& folder, const std::string& command)
{
    return Process("/bin/sh", {"-c", command, FPPG_PROGRAM}, folder.path().string()).wait();
}

/// Names of temporary files below a folder.
std::vector<std::string> temporary_files(const fs::path& folder)
{
    std::vector<std::string> out;
    for (const auto& entry : fs::recursive_directory_iterator(folder))
        if (contains(entry.path().filename().string(), ".part-"))
            out.push_back(entry.path().string());
    return out;
}

// -- bad inputs
// -------------------------------------------------------------------------------------------

/// What a test folder holds and how the program is called there; Case_Def.xml is the tank.
struct Setting
{
    CaseText text = tank();
    std::string definition; ///< in place of `text`
    Arguments arguments{"Case_Def", "out/Case"};
    std::map<std::string, std::string> files;
};

struct BadInput
{
    const char* name;
    std::function<void(Setting&)> make;
    int code;
    const char* message;
};

void PrintTo(const BadInput& input, std::ostream* out)
{
    *out << input.name;
}

class Fppg : public testing::TestWithParam<BadInput>
{
};

TEST_P(Fppg, SaysWhatIsWrongAndLeavesOlderResultsAlone)
{
    const TemporaryFolder folder;
    write_text(folder / "Case_Def.xml", tank().text());
    ASSERT_EQ(run(folder, {"Case_Def", "out/Case", "-save:all"}).code, 0);
    const auto before = contents(folder / "out");
    ASSERT_TRUE(before.contains("Case.bi4") && before.contains("Case.xml") &&
                before.contains("Case.out"));

    Setting setting;
    GetParam().make(setting);
    const bool is_given = setting.definition.empty() && GetParam().name != std::string("EmptyFile");
    write_text(folder / "Case_Def.xml", is_given ? setting.text.text() : setting.definition);
    for (const auto& [name, bytes] : setting.files) write_text(folder / name, bytes);
    const RunResult result = run(folder, setting.arguments);
    EXPECT_EQ(result.code, GetParam().code) << result.output;
    EXPECT_TRUE(contains(result.output, GetParam().message)) << result.output;
    EXPECT_TRUE(contains(result.output, "\n*** Error: ")) << result.output;
    EXPECT_TRUE(contains(result.output,
                         "Finished execution (code=" + std::to_string(GetParam().code) + ")."))
        << result.output;
    EXPECT_EQ(contents(folder / "out"), before);
    EXPECT_EQ(temporary_files(folder.path()), std::vector<std::string>());
}

std::string name_of(const testing::TestParamInfo<BadInput>& info)
{
    return info.param.name;
}

BadInput mainlist(const char* name, const char* commands, const char* message)
{
    return {name, [commands](Setting& s) { s.text.mainlist = commands; }, 3, message};
}

BadInput arguments(const char* name, const Arguments& words, const char* message)
{
    return {name,
            [words](Setting& s)
            { s.arguments.insert(s.arguments.end(), words.begin(), words.end()); },
            2, message};
}

/// A binary STL of `count` triangles (0, 0, 0), (1, 0, 0), (0, 1, 0), with `bytes` of its triangles
/// there.
std::string binary_stl(std::uint32_t count, std::size_t bytes, float value)
{
    std::string out(80, ' ');
    out.append(reinterpret_cast<const char*>(&count), 4);
    const float triangle[12] = {0, 0, 1, value, 0, 0, 1, 0, 0, 0, 1, 0};
    for (std::uint32_t t = 0; t < count; ++t)
    {
        out.append(reinterpret_cast<const char*>(triangle), 48);
        out.append(2, '\0');
    }
    return out.substr(0, 84 + bytes);
}

BadInput stl(const char* name, const std::string& bytes, const char* message)
{
    return {name,
            [bytes](Setting& s)
            {
                s.text.mainlist = R"(<setmkbound mk="0" /><drawfilestl file="mesh.stl" />)";
                s.files["mesh.stl"] = bytes;
            },
            3, message};
}

/// Long runs, so that few of them hold more particles than fit.
void draw_too_many(Setting& s)
{
    s.text.pointmax = R"(<pointmax x="0.5" y="0.5" z="4000" />)";
    s.text.mainlist = R"(<setmkfluid mk="0" /><redraw />)";
    s.text.dp = "0.002";
}

const std::vector<BadInput> bad_cases{
    BadInput{"MissingFile", [](Setting& s) { s.arguments[0] = "Nowhere_Def"; }, 4,
             "Nowhere_Def.xml: cannot open the file: No such file or directory"},
    BadInput{"MalformedXml", [](Setting& s) { s.definition = "<case>\n<casedef>\n</case>"; }, 3,
             "this is not well-formed XML"},
    BadInput{"EmptyFile", [](Setting&) {}, 3, "Case_Def.xml: the file is empty"},
    BadInput{"OtherRoot", [](Setting& s) { s.definition = "<model/>"; }, 3,
             "Case_Def.xml:1: <model>: the root must be <case>"},
    mainlist("UnknownCommand", "<drawteapot />", "Case_Def.xml:7: <drawteapot>: is not a command"),
    mainlist("BadNumber", R"(<drawpoint x="a" y="0" z="0" />)",
             "Case_Def.xml:7: <drawpoint>: attribute x=\"a\""),
    mainlist("DivisionByZero", R"(<drawpoint x="#1/0" y="0" z="0" />)",
             "Case_Def.xml:7: <drawpoint>: attribute x=\"#1/0\""),
    BadInput{"MissingStl",
             [](Setting& s) { s.text.mainlist = R"(<drawfilestl file="gone.stl" />)"; }, 4,
             "gone.stl"},
    BadInput{"ZeroDp", [](Setting& s) { s.text.dp = "0.0"; }, 3, "<definition>: dp is 0"},
    BadInput{"FolderBelowAFile", [](Setting& s) { s.arguments[1] = "Case_Def.xml/out/Case"; }, 4,
             "Case_Def.xml/out: cannot create the folder: Not a directory"},
    BadInput{"TooManyParticles", draw_too_many, 3, "the file format holds at most 4,294,967,294"}};

INSTANTIATE_TEST_SUITE_P(Case, Fppg, testing::ValuesIn(bad_cases), name_of);

const std::vector<BadInput> bad_command_lines{
    arguments("ZeroDp", {"-dp:0"}, "-dp: \"0\" is invalid, expected a particle distance above 0"),
    arguments("NegativeDp", {"-dp:-1"}, "-dp: \"-1\" is invalid"),
    arguments("NotANumberDp", {"-dp:nan"}, "-dp: \"nan\" is invalid"),
    arguments("InfiniteDp", {"-dp:inf"}, "-dp: \"inf\" is invalid"),
    arguments("BadDp", {"-dp:0.1m"}, "-dp: \"0.1m\" is invalid"),
    arguments("UnknownOption", {"-sav:all"}, "the option -sav:all is unknown"),
    arguments("UnknownFit", {"-fit:cooked"}, "-fit: \"cooked\" is invalid, expected -fit, "),
    arguments("UnknownSaveWord", {"-save:all,pictures"}, "-save: \"pictures\" is unknown"),
    arguments("BadThreads", {"-threads:many"}, "-threads: \"many\" is invalid"),
    arguments("NegativeThreads", {"-threads:-1"}, "-threads: -1 is out of range"),
    arguments("ThirdName", {"third"}, "\"third\" is one name too many"),
    arguments("EvarsWithoutValue", {"-evars:A"}, "-evars: \"A\" is invalid, expected NAME=VALUE"),
    arguments("EvarsOfNoVariable", {"-evars:A=1"}, "-evars: the case defines no variable \"A\""),
    BadInput{"NoName", [](Setting& s) { s.arguments = {"-save:all"}; }, 2,
             "the name of the case definition is missing"}};

INSTANTIATE_TEST_SUITE_P(CommandLine, Fppg, testing::ValuesIn(bad_command_lines), name_of);

const std::vector<BadInput> bad_meshes{
    stl("Empty", "", "mesh.stl"), stl("Truncated", binary_stl(3, 120, 0), "mesh.stl"),
    stl("AllNan", binary_stl(2, 100, std::numeric_limits<float>::quiet_NaN()), "mesh.stl"),
    stl("NoStl", "this is no mesh", "mesh.stl")};

INSTANTIATE_TEST_SUITE_P(Mesh, Fppg, testing::ValuesIn(bad_meshes), name_of);

TEST(FppgDisk, SaysThatAFileIsTooLargeAndLeavesOlderResultsAlone)
{
    const TemporaryFolder folder;
    write_text(folder / "Case_Def.xml", tank().text());
    ASSERT_EQ(run(folder, {"Case_Def", "out/Case", "-save:all"}).code, 0);
    const auto before = contents(folder / "out");
    // No file above 64 blocks of 512 bytes; the output of this test stays below.
    const RunResult result = shell(folder, R"(ulimit -f 64; "$0" Case_Def out/Case -dp:0.05)");
    EXPECT_EQ(result.code, 4) << result.output;
    EXPECT_TRUE(contains(result.output, "*** Error: cannot write 'out/Case.bi4': File too large"))
        << result.output;
    EXPECT_EQ(contents(folder / "out"), before);
    EXPECT_EQ(temporary_files(folder.path()), std::vector<std::string>());
}

TEST(FppgDisk, SaysThatAFolderCannotBeWritten)
{
    if (::geteuid() == 0) GTEST_SKIP() << "root writes into every folder";
    const TemporaryFolder folder;
    write_text(folder / "Case_Def.xml", tank().text());
    fs::create_directory(folder / "out");
    fs::permissions(folder / "out", fs::perms::owner_read | fs::perms::owner_exec);
    const RunResult result = run(folder, {"Case_Def", "out/Case"});
    EXPECT_EQ(result.code, 4);
    EXPECT_TRUE(contains(result.output, "Permission denied")) << result.output;
    fs::permissions(folder / "out", fs::perms::owner_all);
}

TEST(FppgDisk, RefusesToCreateFoldersWhenAskedNotTo)
{
    const TemporaryFolder folder;
    write_text(folder / "Case_Def.xml", tank().text());
    EXPECT_EQ(run(folder, {"Case_Def", "out/Case", "-createdirs:0"}).code, 4);
    EXPECT_FALSE(fs::exists(folder / "out"));
}

TEST(FppgLog, OfAFailedRunIsKeptWhereThereIsNoOlderOne)
{
    const TemporaryFolder folder;
    CaseText text;
    text.mainlist = "<drawteapot />";
    write_text(folder / "Case_Def.xml", text.text());
    EXPECT_EQ(run(folder, {"Case_Def", "out/Case"}).code, 3);
    const auto files = contents(folder / "out");
    ASSERT_EQ(files.size(), 1u);
    EXPECT_TRUE(contains(files.at("Case.out"), "<drawteapot>: is not a command"));
}

TEST(FppgLog, WarnsOfACaseWithoutParticles)
{
    const TemporaryFolder folder;
    write_text(folder / "Case_Def.xml", CaseText().text());
    const RunResult result = run(folder, {"Case_Def", "out/Case"});
    EXPECT_EQ(result.code, 0);
    EXPECT_TRUE(contains(
        result.output,
        "*** WARNING: No particles were created in the defined domain. The solver refuses"))
        << result.output;
    EXPECT_TRUE(contains(result.output, "Total particles: 0 (bound=0")) << result.output;
}

// -- what it writes
// ---------------------------------------------------------------------------------------

TEST(FppgFiles, AreTheSameWithOneTwoAndEightThreads)
{
    for (const std::string name :
         {"combo_2d_wavetank", "combo_floating_piston", "combo_stl_tank", "combo_tank_obstacle"})
    {
        const TemporaryFolder folder;
        fs::copy(fs::path(FPPG_RECORDED_CASES) / name, folder.path(), fs::copy_options::recursive);
        for (const std::string threads : {"1", "2", "8"})
            ASSERT_EQ(
                run(folder, {name + "_Def", threads + "/Case", "-save:all", "-threads:" + threads})
                    .code,
                0)
                << name;
        const auto one = results(folder / "1");
        EXPECT_GE(one.size(), 4u);
        EXPECT_EQ(results(folder / "2") == one, true) << name;
        EXPECT_EQ(results(folder / "8") == one, true) << name;
    }
}

TEST(FppgFiles, AreTheSameWithAnyNumberOfThreadsForManyParticles)
{
    for (const char* gravity :
         {R"(<gravity x="0" y="0" z="-9.81" />)", R"(<gravity x="1" y="0" z="-9.81" />)"})
    {
        const TemporaryFolder folder;
        CaseText text = tank();
        text.gravity = gravity;
        text.mainlist +=
            R"(<setmkbound mk="1" /><drawsphere radius="0.2"><point x="0.5" y="0.5" z="0.5" /></drawsphere>
<setmkbound mk="2" /><drawcylinder radius="0.1"><point x="0.1" y="0.1" z="0.1" /><point x="0.9" y="0.8" z="0.7" /></drawcylinder>)";
        text.after_geometry = R"(<floatings><floating mkbound="1-2" rhopbody="500" /></floatings>)";
        write_text(folder / "Case_Def.xml", text.text());
        for (const std::string threads : {"1", "8"})
            ASSERT_EQ(run(folder, {"Case_Def", threads + "/Case", "-save:all", "-dp:0.02",
                                   "-threads:" + threads})
                          .code,
                      0);
        EXPECT_EQ(results(folder / "1") == results(folder / "8"), true);
    }
}

TEST(FppgFiles, CarryTheDateOfTheEnvironment)
{
    const TemporaryFolder folder;
    write_text(folder / "Case_Def.xml", tank().text());
    ASSERT_EQ(run(folder, {"Case_Def", "out/Case"}).code, 0);
    EXPECT_TRUE(contains(read_text(folder / "out/Case.xml"), "02-01-1970 00:00:00"));
    const RunResult bad = Process(FPPG_PROGRAM, {"Case_Def", "out/Case"}, folder.path().string(),
                                  {{"SOURCE_DATE_EPOCH", "yesterday"}})
                              .wait();
    EXPECT_EQ(bad.code, 2);
    EXPECT_TRUE(contains(bad.output, "SOURCE_DATE_EPOCH=\"yesterday\" is invalid")) << bad.output;
}

/// Endings of the files in out/.
std::set<std::string> endings(const TemporaryFolder& folder)
{
    std::set<std::string> out;
    for (const auto& [name, bytes] : contents(folder / "out"))
        out.insert(name.substr(std::string("Case").size()));
    return out;
}

struct Saved
{
    const char* option;
    std::set<std::string> files;
};

class FppgSave : public testing::TestWithParam<Saved>
{
};

TEST_P(FppgSave, WritesTheFilesThatAreAskedFor)
{
    const TemporaryFolder folder;
    write_text(folder / "Case_Def.xml", tank().text());
    Arguments words{"Case_Def", "out/Case"};
    if (*GetParam().option != 0) words.push_back(GetParam().option);
    ASSERT_EQ(run(folder, words).code, 0);
    EXPECT_EQ(endings(folder), GetParam().files);
}

std::string name_of_saved(const testing::TestParamInfo<Saved>& tested)
{
    std::string name;
    for (const char c : std::string_view(tested.param.option))
        if (c == '+')
            name += "Plus";
        else if (c == '-')
            name += "Minus";
        else if (std::isalnum(static_cast<unsigned char>(c)) != 0)
            name += c;
    return name.empty() ? "NoOption" : name;
}

INSTANTIATE_TEST_SUITE_P(
    Options, FppgSave,
    testing::Values(
        Saved{"", {".xml", ".out", ".bi4", "_MkCells.vtk"}}, Saved{"-save:-all", {".xml", ".out"}},
        Saved{"-save:all",
              {".xml", ".out", ".bi4", "_MkCells.vtk", "_All.vtk", "_Bound.vtk", "_Fluid.vtk"}},
        Saved{"-save:+all",
              {".xml", ".out", ".bi4", "_MkCells.vtk", "_All.vtk", "_Bound.vtk", "_Fluid.vtk"}},
        Saved{"-save:-vtkcells", {".xml", ".out", ".bi4"}},
        Saved{"-save:-all,+vtkfluid", {".xml", ".out", "_Fluid.vtk"}},
        Saved{"-save:+vtkbound", {".xml", ".out", ".bi4", "_MkCells.vtk", "_Bound.vtk"}}),
    name_of_saved);

TEST(FppgFiles, CopyPicturesThriceWithSave3vtk)
{
    const TemporaryFolder folder;
    write_text(folder / "Case_Def.xml", tank().text());
    ASSERT_EQ(run(folder, {"Case_Def", "out/Case", "-save:-all,+vtkfluid", "-save3vtk:1"}).code, 0);
    EXPECT_EQ(endings(folder),
              (std::set<std::string>{".xml", ".out", "_Fluid.vtk", "_Fluid_r00.vtk",
                                     "_Fluid_r01.vtk", "_Fluid_r02.vtk"}));
}

TEST(FppgFiles, HoldPicturesOfTheRelaxationThatTheCaseAsksFor)
{
    const TemporaryFolder folder;
    CaseText text;
    text.mainlist = R"(<setdrawmode mode="full" /><setmkbound mk="0" />
<drawsphere radius="0.6"><point x="0.5" y="0.5" z="0.5" /></drawsphere>)";
    text.after_geometry = R"(<fppg><bodyfitted><relax iterations="25" snapshots="10" />
</bodyfitted></fppg>)";
    write_text(folder / "Case_Def.xml", text.text());
    const RunResult result = run(folder, {"Case_Def", "out/Case"});
    ASSERT_EQ(result.code, 0) << result.output;
    EXPECT_TRUE(contains(result.output, "Case_Relax_*.vtk: 2 VTK files of the relaxation"));
    EXPECT_TRUE(fs::exists(folder / "out/Case_Relax_0010.vtk"));
    EXPECT_TRUE(fs::exists(folder / "out/Case_Relax_0020.vtk"));
    EXPECT_FALSE(fs::exists(folder / "out/Case_Relax_0030.vtk"));
}

TEST(FppgFiles, KeepADefinitionThatIsAlsoTheOutput)
{
    const TemporaryFolder folder;
    write_text(folder / "Case.xml", tank().text());
    ASSERT_EQ(run(folder, {"Case"}).code, 0);
    EXPECT_EQ(read_text(folder / "Case.xml.orig"), tank().text());
    EXPECT_TRUE(contains(read_text(folder / "Case.xml"), "<particles "));
    // The generated case is a definition again, of the same particles.
    const std::string first = read_text(folder / "Case.bi4");
    ASSERT_EQ(run(folder, {"Case"}).code, 0);
    EXPECT_EQ(read_text(folder / "Case.bi4") == first, true);
    EXPECT_EQ(read_text(folder / "Case.xml.orig"), tank().text());
}

TEST(FppgNames, TakeAStarForTheNameOfTheDefinition)
{
    const TemporaryFolder folder;
    write_text(folder / "Case_Def.xml", tank().text());
    ASSERT_EQ(run(folder, {"./Case_Def", "out/a_*_b"}).code, 0);
    EXPECT_TRUE(fs::exists(folder / "out/a_Case_Def_b.bi4"));
}

TEST(FppgNames, MayHoldBlanksAndAnyLetters)
{
    const TemporaryFolder folder;
    fs::create_directory(folder / "bassin d'été");
    write_text(folder / "bassin d'été/Vague é_Def.xml", tank().text());
    const RunResult result = run(folder, {"bassin d'été/Vague é_Def", "sortie à 2/Vague é"});
    ASSERT_EQ(result.code, 0) << result.output;
    EXPECT_TRUE(fs::exists(folder / "sortie à 2/Vague é.bi4"));
    EXPECT_EQ(
        run(folder, {(folder / "bassin d'été/Vague é_Def"), (folder / "sortie à 3/Vague é")}).code,
        0);
}

TEST(FppgFiles, AreMadeWithNewValuesOfVariables)
{
    const TemporaryFolder folder;
    CaseText text = tank();
    text.predefinition =
        R"(<predefinition><newvarcte Height="0.6" /><newvarcte Tag="1" /></predefinition>)";
    text.mainlist = R"(<setdrawmode mode="full" /><setmkfluid mk="0" />)" +
                    box_command(R"(x="0" y="0" z="0")", R"(x="1" y="1" z="#Height")");
    write_text(folder / "Case_Def.xml", text.text());
    const RunResult low = run(folder, {"Case_Def", "out/Case", "-evars:Height=0.3:Tag=2"});
    const RunResult high = run(folder, {"Case_Def", "out/Case"});
    EXPECT_TRUE(contains(low.output, "Total particles: 484 (")) << low.output;
    EXPECT_TRUE(contains(high.output, "Total particles: 847 (")) << high.output;
}

// -- what callers read
// ------------------------------------------------------------------------------------

std::string between(const std::string& text, const std::string& begin, const std::string& end)
{
    const std::size_t from = text.find(begin);
    if (from == std::string::npos) return "";
    const std::size_t start = from + begin.size();
    return text.substr(start, text.find(end, start) - start);
}

TEST(FppgOutput, IsReadAsDesignSphysicsReadsIt)
{
    const TemporaryFolder folder;
    write_text(folder / "Case_Def.xml", tank().text());
    const RunResult result =
        run(folder, {folder / "Case_Def", folder / "Case_out/Case", "-save:+all", "-dp:0.05"});
    ASSERT_EQ(result.code, 0);
    std::string count = between(result.output, "Total particles: ", " (bound=");
    std::erase(count, ',');
    EXPECT_EQ(std::stoi(count), 21 * 21 * 21 - 19 * 19 * 8);
    const std::string limits = between(result.output, "Particle limits:", "Time of execution");
    std::vector<std::string> fields;
    std::istringstream in(limits);
    for (std::string field; std::getline(in, field, ':');) fields.push_back(field);
    ASSERT_GE(fields.size(), 4u) << limits;
    for (std::size_t axis = 1; axis < 4; ++axis)
    {
        double low = -1;
        double high = -1;
        ASSERT_EQ(std::sscanf(fields[axis].c_str(), " %lf to %lf [m]", &low, &high), 2)
            << limits; // NOLINT
        EXPECT_NEAR(low, 0, 1e-9);
        EXPECT_NEAR(high, 1, 1e-9);
    }
    EXPECT_TRUE(contains(result.output, "\nTime of execution"));
    EXPECT_EQ(read_text(folder / "Case_out/Case.out"), result.output);
}

TEST(FppgOutput, NamesGenCaseInItsVersion)
{
    const TemporaryFolder folder;
    for (const char* option : {"-ver", "--version"})
    {
        const RunResult result = run(folder, {option});
        EXPECT_EQ(result.code, 0);
        EXPECT_TRUE(contains(result.output, "GenCase")) << result.output;
    }
}

TEST(FppgOutput, ShowsTheHelpWithoutArguments)
{
    const TemporaryFolder folder;
    EXPECT_EQ(run(folder, {}).output, run(folder, {"-h"}).output);
    EXPECT_TRUE(contains(run(folder, {}).output, "Usage:"));
}

#ifdef FPPG_JSON
TEST(FppgOutput, DescribesItselfAsJson)
{
    const TemporaryFolder folder;
    const auto info = nlohmann::json::parse(run(folder, {"-info"}).output);
    EXPECT_TRUE(info.at("FullName").is_string());
    EXPECT_TRUE(info.at("Features").is_object());
}
#endif

TEST(FppgName, MayBeGenCase_linux64)
{
    const TemporaryFolder folder;
    write_text(folder / "Case_Def.xml", tank().text());
    fs::create_symlink(FPPG_PROGRAM, folder / "GenCase_linux64");
    ASSERT_EQ(run(folder, {"Case_Def", "a/Case", "-save:all"}).code, 0);
    ASSERT_EQ(run(folder, {"Case_Def", "b/Case", "-save:all"}, folder / "GenCase_linux64").code, 0);
    EXPECT_EQ(results(folder / "a") == results(folder / "b"), true);
}

TEST(FppgTemplates, WriteACaseThatRuns)
{
    const TemporaryFolder folder;
    ASSERT_EQ(run(folder, {"-templates"}).code, 0);
    const RunResult result = run(folder, {"FppgCaseTemplate", "out/Case"});
    EXPECT_EQ(result.code, 0) << result.output;
}

TEST(FppgTemplates, AreThoseOfTheSourceWithFilesAndSchema)
{
    const TemporaryFolder folder;
    ASSERT_EQ(run(folder, {"templates", "a/b"}).code, 0);
    ASSERT_EQ(run(folder, {"-templates", "c"}).code, 0);
    const auto written = contents(folder / "a/b");
    EXPECT_GT(written.size(), 80u);
    EXPECT_TRUE(written.contains("fppg.xsd") && written.contains("DrawSphere_Def.xml"));
    for (const auto& [name, bytes] : written)
        EXPECT_EQ(bytes == read_text(fs::path(FPPG_TEMPLATES) / name), true) << name;
    EXPECT_EQ(written == contents(folder / "c"), true);
    const RunResult result =
        shell(folder, "cd a/b && '" FPPG_PROGRAM "' DrawFileStl_Def out/DrawFileStl");
    EXPECT_EQ(result.code, 0) << result.output;
}

TEST(FppgTemplates, ReplaceNoFileUnlessTold)
{
    const TemporaryFolder folder;
    write_text(folder / "DrawSphere_Def.xml", "mine");
    const RunResult first = run(folder, {"templates", "."});
    EXPECT_EQ(first.code, 0);
    EXPECT_TRUE(contains(first.output, "\n  DrawSphere_Def.xml\n")) << first.output;
    EXPECT_EQ(read_text(folder / "DrawSphere_Def.xml"), "mine");
    const RunResult second = run(folder, {"templates", ".", "--overwrite"});
    EXPECT_TRUE(contains(second.output, "1 files written")) << second.output;
    EXPECT_TRUE(contains(read_text(folder / "DrawSphere_Def.xml"), "<drawsphere"));
}

TEST(FppgTemplates, SayWhereTheyCannotBeWritten)
{
    const TemporaryFolder folder;
    write_text(folder / "file", "");
    const RunResult result = run(folder, {"templates", "file/below"});
    EXPECT_EQ(result.code, 4) << result.output;
    EXPECT_TRUE(contains(result.output, "file")) << result.output;
    EXPECT_EQ(run(folder, {"templates"}).code, 2);
    EXPECT_EQ(run(folder, {"-templates", "a", "b"}).code, 2);
}

CaseText tank_with_normals(const std::string& file)
{
    CaseText text = tank();
    const std::string list = text.mainlist;
    text.mainlist =
        "<setshapemode>actual | bound</setshapemode>" + list + R"(<shapeout file="wall" />)";
    text.after_geometry = R"(<normals><norgeometry><geometryfile file=")" + file +
                          R"(" /><svshapes v="true" /></norgeometry></normals>)";
    return text;
}

TEST(FppgNormals, ComeFromTheShapeFileOfTheSameRun)
{
    const TemporaryFolder folder;
    write_text(folder / "Case_Def.xml", tank_with_normals("[CaseName]_wall_Actual.vtk").text());
    const RunResult result = run(folder, {"Case_Def", "out/Case", "-save:all"});
    ASSERT_EQ(result.code, 0) << result.output;
    EXPECT_TRUE(contains(result.output, "Computing normals..."));
    EXPECT_TRUE(contains(read_text(folder / "out/Case.bi4"), "BoundNor"));
    EXPECT_TRUE(contains(read_text(folder / "out/Case_Bound.vtk"), "NormalSize 1"));
    EXPECT_TRUE(fs::exists(folder / "out/Case_GeometryShapes.vtk"));
}

TEST(FppgNormals, ComeFromAFileBesideTheDefinitionToo)
{
    const TemporaryFolder folder;
    write_text(folder / "Case_Def.xml", tank_with_normals("[CaseName]_wall_Actual.vtk").text());
    ASSERT_EQ(run(folder, {"Case_Def", "out/Case"}).code, 0);
    fs::copy_file(folder / "out/Case_wall_Actual.vtk", folder / "mine.vtk");
    write_text(folder / "Other_Def.xml", tank_with_normals("mine.vtk").text());
    const RunResult result = run(folder, {"Other_Def", "other/Case"});
    ASSERT_EQ(result.code, 0) << result.output;
    EXPECT_EQ(read_text(folder / "out/Case.bi4") == read_text(folder / "other/Case.bi4"), true);
}

TEST(FppgNormals, NameTheShapeFilesThatThereAreWhenTheirsIsMissing)
{
    const TemporaryFolder folder;
    write_text(folder / "Case_Def.xml", tank_with_normals("none.vtk").text());
    const RunResult result = run(folder, {"Case_Def", "out/Case"});
    EXPECT_EQ(result.code, 4);
    EXPECT_TRUE(contains(result.output,
                         "<geometryfile file=\"none.vtk\">: no such shape file; "
                         "this case writes Case_wall_Actual.vtk"))
        << result.output;
    EXPECT_FALSE(fs::exists(folder / "out/Case.bi4"));
}

/// Whether a coordinate is one of the lattice that goes through the origin.
bool is_of_lattice(double x, double dp)
{
    return std::fabs(x - std::round(x / dp) * dp) < 1e-9;
}

TEST(FppgNormals, AreThoseOfEveryBoundaryParticleOfAFittedWallToo)
{
    const TemporaryFolder folder;
    CaseText text;
    text.mainlist = R"(<setdrawmode mode="full" /><setmkbound mk="0" />)"
                    R"(<drawsphere radius="0.43"><point x="0.5" y="0.5" z="0.5" /></drawsphere>)"
                    R"(<setmkbound mk="1" />)" +
                    box_command(R"(x="0" y="0" z="-0.3")", R"(x="1" y="1" z="0.1")");
    text.after_geometry =
        R"(<fppg><bodyfitted mkbound="0" /></fppg>)"
        R"(<normals><norsphere><center x="0.51" y="0.52" z="0.53" /><radius v="2" />)"
        R"(<inside v="true" /><maxdisth v="100" /></norsphere></normals>)";
    write_text(folder / "Case_Def.xml", text.text());
    const RunResult result = run(folder, {"Case_Def", "out/Case", "-save:all"});
    ASSERT_EQ(result.code, 0) << result.output;
    const std::string file = read_text(folder / "out/Case.bi4");
    const auto places = bi4_array<double>(file, "Posd");
    const auto normals = bi4_array<float>(file, "BoundNor");
    ASSERT_EQ(normals.size(), places.size());
    int off_lattice = 0;
    for (std::size_t i = 0; i < places.size(); i += 3)
    {
        const std::array<double, 3> d{places[i] - 0.51, places[i + 1] - 0.52, places[i + 2] - 0.53};
        const double q = std::hypot(d[0], d[1], d[2]);
        for (std::size_t axis = 0; axis < 3; ++axis)
            ASSERT_NEAR(normals[i + axis], (2 / q - 1) * d[axis], 1e-5) << "particle " << i / 3;
        if (!is_of_lattice(places[i], 0.1)) ++off_lattice;
    }
    EXPECT_GT(off_lattice, 200);
    const std::string picture = read_text(folder / "out/Case_Bound.vtk");
    for (const char* array : {"\nNormal 3 ", "\nNormalSize 1 ", "\nWallNormal 3 ", "\nKind 1 "})
        EXPECT_TRUE(contains(picture, array)) << array;
}

TEST(FppgInitials, StartTheRelaxedFluidBesideAFittedWallToo)
{
    const TemporaryFolder folder;
    CaseText text = tank();
    text.mainlist += R"(<setmkbound mk="1" />)"
                     R"(<drawsphere radius="0.23"><point x="0.5" y="0.5" z="0.3" /></drawsphere>)";
    text.after_geometry =
        R"(<fppg><bodyfitted mkbound="1" /><fluidband mkfluid="0" width="3" /></fppg>)"
        R"(<initials><velocity mkfluid="0" x="1" y="2" z="3"><onlypos><posmin z="0.33" />)"
        R"(</onlypos></velocity><densitygradient mkfluid="0"><pos1 x="0" y="0" z="0" rhop="1100" />)"
        R"(<pos2 x="0" y="0" z="1" rhop="1000" /></densitygradient></initials>)";
    write_text(folder / "Case_Def.xml", text.text());
    const RunResult result = run(folder, {"Case_Def", "out/Case"});
    ASSERT_EQ(result.code, 0) << result.output;
    const std::string file = read_text(folder / "out/Case.bi4");
    const auto places = bi4_array<double>(file, "Posd");
    const auto velocities = bi4_array<float>(file, "Vel");
    const auto densities = bi4_array<float>(file, "Rhop");
    ASSERT_EQ(velocities.size(), places.size());
    // Boundary particles come first and rest at 1000.
    std::size_t i = 0;
    for (; densities.at(i) == 1000; ++i) ASSERT_EQ(velocities[3 * i], 0);
    int off_lattice = 0;
    for (; i < densities.size(); ++i)
    {
        const double z = places[3 * i + 2];
        const std::array<float, 3> fast{1, 2, 3};
        for (std::size_t axis = 0; axis < 3; ++axis)
            ASSERT_EQ(velocities[3 * i + axis], z >= 0.33 ? fast[axis] : 0) << "particle " << i;
        ASSERT_NEAR(densities[i], 1100 - 100 * z, 1e-3) << "particle " << i;
        if (z >= 0.33 && !is_of_lattice(z, 0.1)) ++off_lattice;
    }
    EXPECT_GT(off_lattice, 30);
}

TEST(FppgClean, WritesOnlyATidyDefinitionThatRunsTheSame)
{
    const TemporaryFolder folder;
    CaseText text = tank();
    text.mainlist += "<!-- kept -->";
    write_text(folder / "Case_Def.xml", text.text());
    ASSERT_EQ(run(folder, {"Case_Def", "Tidy_Def", "-clean"}).code, 0);
    EXPECT_EQ(contents(folder.path()).size(), 2u);
    EXPECT_TRUE(contains(read_text(folder / "Tidy_Def.xml"), "<!-- kept -->"));
    ASSERT_EQ(run(folder, {"Case_Def", "a/Case"}).code, 0);
    ASSERT_EQ(run(folder, {"Tidy_Def", "b/Case"}).code, 0);
    EXPECT_EQ(read_text(folder / "a/Case.bi4") == read_text(folder / "b/Case.bi4"), true);
}

// -- Ctrl-C
// -----------------------------------------------------------------------------------------------

/// Runs the tank with many particles and sends `signal` as soon as is_time says so.
RunResult stopped(const TemporaryFolder& folder, int signal, const std::function<bool()>& is_time)
{
    Process process(FPPG_PROGRAM, {"Case_Def", "out/Case", "-save:all", "-dp:0.003"},
                    folder.path().string());
    wait_until(is_time);
    process.send(signal);
    return process.wait();
}

TEST(FppgStopped, LeavesNoTemporaryFileAndTheOldOnes)
{
    const TemporaryFolder folder;
    write_text(folder / "Case_Def.xml", tank().text());
    ASSERT_EQ(run(folder, {"Case_Def", "out/Case", "-save:all"}).code, 0);
    const auto before = contents(folder / "out");
    const auto is_writing = [&] { return !temporary_files(folder.path()).empty(); };
    for (const int signal : {SIGINT, SIGTERM})
    {
        const RunResult result = stopped(folder, signal, is_writing);
        EXPECT_EQ(result.code, 128 + signal) << result.output;
        EXPECT_TRUE(contains(result.output, signal == SIGINT
                                                ? "Stopped by the user; no output file was changed"
                                                : "Stopped by SIGTERM; no output file was changed"))
            << result.output;
        EXPECT_EQ(contents(folder / "out") == before, true);
        EXPECT_EQ(temporary_files(folder.path()), std::vector<std::string>());
    }
}

} // namespace
