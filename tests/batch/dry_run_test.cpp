// fppg batch --dry-run, run as users run it; FPPG_PROGRAM is the program's path.

#include "batch/batch_cases.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <sstream>

namespace
{

namespace fs = std::filesystem;
using namespace fppg::test;
using nlohmann::json;
using testing::HasSubstr;
using testing::Not;

/// Two cases that run; one with a command that nobody knows, one without its mesh, one that is no
/// XML.
void write_cases(const TemporaryFolder& folder)
{
    fs::create_directories(folder / "cases/deep");
    write_text(folder / "cases/A_Def.xml", box_case().text());
    write_text(folder / "cases/deep/B_Def.xml", box_case("0.5").text());
    CaseText unknown = box_case();
    unknown.mainlist += "\n<drawteapot />";
    write_text(folder / "cases/C_Def.xml", unknown.text());
    CaseText meshless = box_case();
    meshless.mainlist += "\n<drawfilestl file=\"gone.stl\" />";
    write_text(folder / "cases/deep/D_Def.xml", meshless.text());
    write_text(folder / "cases/E_Def.xml", "<case><open>" + box_case().text());
}

TEST(DryRun, SaysWhichDefinitionsAreRefusedAndWritesNothing)
{
    const TemporaryFolder folder;
    write_cases(folder);
    const auto before = contents(folder.path());
    const RunResult result = run(folder, {"batch", "--dry-run", "cases"});
    EXPECT_EQ(result.code, 1);
    EXPECT_THAT(result.output, HasSubstr("cases/C_Def.xml:8: <drawteapot>: "));
    EXPECT_THAT(result.output, HasSubstr("cases/deep/D_Def.xml:8: <drawfilestl"));
    EXPECT_THAT(result.output, HasSubstr("gone.stl"));
    EXPECT_THAT(result.output, HasSubstr("cases/E_Def.xml:"));
    EXPECT_THAT(result.output, Not(HasSubstr("A_Def")));
    EXPECT_THAT(result.output, HasSubstr("\n5 definitions: 2 can be run, 3 are refused\n"));
    EXPECT_EQ(contents(folder.path()), before);

    const RunResult quiet = run(folder, {"batch", "--dry-run", "--quiet", "cases"});
    EXPECT_EQ(quiet.code, 1);
    EXPECT_EQ(std::count(quiet.output.begin(), quiet.output.end(), '\n'), 3);
}

TEST(DryRun, IsContentWithCasesThatRun)
{
    const TemporaryFolder folder;
    copy_templates(folder.path() / "cases", {"DrawBox", "DrawFileStl", "Lists"});
    const RunResult result = run(folder, {"batch", "--dry-run", "cases"});
    EXPECT_EQ(result.code, 0);
    EXPECT_EQ(result.output, "3 definitions: 3 can be run, 0 are refused\n");
    fs::remove_all(folder / "cases/data");
    const RunResult without = run(folder, {"batch", "--dry-run", "cases"});
    EXPECT_EQ(without.code, 1);
    EXPECT_THAT(without.output, HasSubstr("2 can be run, 1 is refused"));
}

TEST(DryRun, TellsEveryDefinitionAsJson)
{
    const TemporaryFolder folder;
    write_cases(folder);
    const RunResult result = run(folder, {"batch", "--dry-run", "--log-json", "cases"});
    EXPECT_EQ(result.code, 1);
    std::istringstream lines(result.output);
    std::map<std::string, json> told;
    for (std::string line; std::getline(lines, line);)
    {
        json one = json::parse(line);
        EXPECT_EQ(one.at("event"), "checked");
        told[one.at("definition")] = one;
    }
    ASSERT_EQ(told.size(), 5U);
    EXPECT_EQ(told["cases/A_Def.xml"].at("refused"), false);
    EXPECT_EQ(told["cases/C_Def.xml"].at("refused"), true);
    EXPECT_THAT(told["cases/C_Def.xml"].at("error").get<std::string>(), HasSubstr("drawteapot"));
}

TEST(DryRun, ChecksEveryRunOfASweepWithItsOptions)
{
    const TemporaryFolder folder;
    fs::create_directory(folder / "cases");
    CaseText box = box_case("#Size");
    box.predefinition = "<predefinition><newvarcte Size=\"0.8\" /></predefinition>";
    box.mainlist += "\n<abort if=\"Size>1\" text=\"too large\" />";
    write_text(folder / "cases/Box_Def.xml", box.text());
    const RunResult result =
        run(folder, {"batch", "--dry-run", "cases", "--set", "Size=0.5,1.5", "--set", "Dp=0.1"});
    EXPECT_EQ(result.code, 1);
    EXPECT_THAT(result.output, HasSubstr("too large"));
    EXPECT_THAT(result.output, HasSubstr("(Size=1.5, Dp=0.1)\n"));
    EXPECT_THAT(result.output, HasSubstr("2 runs: 1 can be run, 1 is refused\n"));

    for (const char* other : {"--resume", "--slurm", "--summary"})
        EXPECT_EQ(run(folder, {"batch", "--dry-run", "cases", other}).code, 2) << other;
    EXPECT_EQ(run(folder, {"batch", "--dry-run", "nowhere"}).code, 4);
    EXPECT_EQ(run(folder, {"batch", "--dry-run", "cases", "--", "-nonsense"}).code, 2);
}

TEST(DryRun, TakesWarningsOfReadingForErrorsWhereStrict)
{
    const TemporaryFolder folder;
    fs::create_directory(folder / "cases");
    CaseText box = box_case();
    box.after_geometry =
        "<normals><norplane><point x=\"0\" y=\"0\" z=\"0\" /><normal x=\"0\" "
        "y=\"0\" z=\"1\" /></norplane></normals>";
    write_text(folder / "cases/Box_Def.xml", box.text());
    EXPECT_EQ(run(folder, {"batch", "--dry-run", "cases"}).code, 0);
    const RunResult strict = run(folder, {"batch", "--dry-run", "cases", "--", "-strict"});
    EXPECT_EQ(strict.code, 1);
    EXPECT_THAT(strict.output, HasSubstr("without mkbound it selects no particle"));
}

} // namespace
