// fppg upgrade and fppg batch --dry-run, run as users run them; FPPG_PROGRAM is the program's path.

#include "helpers/case_text.h"
#include "helpers/run_fppg.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>

namespace
{

namespace fs = std::filesystem;
using namespace fppg::test;
using testing::HasSubstr;

/// A tank; the shapes are on line 8.
std::string tank_case(const std::string& shapes, const std::string& normals)
{
    CaseText out = tank();
    out.mainlist += "\n" + shapes + "<shapeout file=\"hdp\" />";
    out.after_geometry = normals;
    return out.text();
}

const std::string old_case =
    tank_case("<setshapemode>real | bound</setshapemode>",
              "<normals><geometryfile file=\"[CaseName]_hdp_Real.vtk\" /></normals>");

TEST(UpgradeCommand, WritesNothingUnlessAsked)
{
    const TemporaryFolder folder;
    write_text(folder / "Tank_Def.xml", old_case);
    const auto before = contents(folder.path());
    const RunResult result = run(folder, {"upgrade", "Tank_Def.xml"});
    EXPECT_EQ(result.code, 0);
    EXPECT_THAT(result.output, HasSubstr("Tank_Def.xml:8: <setshapemode>real | bound  ->  "
                                         "<setshapemode>actual | bound\n"));
    EXPECT_THAT(result.output,
                HasSubstr("Tank_Def.xml: 3 changes; nothing is written, --in-place or -o FILE"));
    EXPECT_EQ(contents(folder.path()), before);
}

TEST(UpgradeCommand, WritesANewFileButNeverAnOldOne)
{
    const TemporaryFolder folder;
    write_text(folder / "Tank_Def.xml", old_case);
    EXPECT_EQ(run(folder, {"upgrade", "Tank_Def", "-o", "New_Def.xml"}).code, 0);
    EXPECT_EQ(read_text(folder / "Tank_Def.xml"), old_case);
    const std::string upgraded = read_text(folder / "New_Def.xml");
    EXPECT_THAT(upgraded,
                HasSubstr("<norgeometry><geometryfile file=\"[CaseName]_hdp_Actual.vtk\""));
    for (const char* there : {"New_Def.xml", "Tank_Def.xml"})
    {
        const RunResult again = run(folder, {"upgrade", "Tank_Def", "-o", there});
        EXPECT_EQ(again.code, 4);
        EXPECT_THAT(again.output, HasSubstr("exists already"));
    }
    EXPECT_EQ(read_text(folder / "Tank_Def.xml"), old_case);
    EXPECT_EQ(read_text(folder / "New_Def.xml"), upgraded);
    const RunResult twice = run(folder, {"upgrade", "New_Def"});
    EXPECT_EQ(twice.output, "New_Def.xml: 0 changes\n");
}

TEST(UpgradeCommand, KeepsTheDefinitionThatItWritesOver)
{
    const TemporaryFolder folder;
    write_text(folder / "Tank_Def.xml", old_case);
    write_text(folder / "Tank_Def.xml.bak", "older");
    fs::permissions(folder / "Tank_Def.xml", fs::perms::owner_read | fs::perms::owner_write);
    fs::create_symlink("Tank_Def.xml", folder / "Link_Def.xml");
    const RunResult result = run(folder, {"upgrade", "Link_Def.xml", "Tank_Def.xml", "--in-place"});
    EXPECT_EQ(result.code, 0) << result.output;
    EXPECT_THAT(result.output, HasSubstr("the old file is Link_Def.xml.bak"));
    EXPECT_THAT(result.output, HasSubstr("Tank_Def.xml: 0 changes"));
    EXPECT_TRUE(fs::is_symlink(folder / "Link_Def.xml"));
    EXPECT_EQ(fs::status(folder / "Tank_Def.xml").permissions(),
              fs::perms::owner_read | fs::perms::owner_write);
    EXPECT_EQ(read_text(folder / "Link_Def.xml.bak"), old_case);

    write_text(folder / "Tank_Def.xml", old_case);
    EXPECT_EQ(run(folder, {"upgrade", "Tank_Def.xml", "--in-place"}).code, 0);
    EXPECT_EQ(read_text(folder / "Tank_Def.xml.bak"), "older");
    EXPECT_EQ(read_text(folder / "Tank_Def.xml.bak2"), old_case);
    EXPECT_NE(read_text(folder / "Tank_Def.xml"), old_case);
}

TEST(UpgradeCommand, GivesACaseThatRunsAsOneWrittenAnew)
{
    const TemporaryFolder folder;
    for (const char* name : {"old", "new"}) fs::create_directory(folder / name);
    write_text(folder / "old/Tank_Def.xml", old_case);
    EXPECT_EQ(run(folder, {"upgrade", "old/Tank_Def.xml", "--in-place"}).code, 0);
    write_text(folder / "new/Tank_Def.xml",
               tank_case("<setshapemode>actual | bound</setshapemode>",
                         "<normals><norgeometry><geometryfile file=\"[CaseName]_hdp_Actual.vtk\" "
                         "/></norgeometry></normals>"));
    for (const std::string name : {"old", "new"})
    {
        const RunResult result = run(folder, {name + "/Tank_Def", name + "_out/Tank", "-save:all"});
        ASSERT_EQ(result.code, 0) << result.output;
    }
    EXPECT_EQ(results(folder / "old_out"), results(folder / "new_out"));
}

TEST(UpgradeCommand, TellsWhatItCannotRead)
{
    const TemporaryFolder folder;
    write_text(folder / "Broken_Def.xml", "<case>\n<casedef></case>");
    EXPECT_EQ(run(folder, {"upgrade", "Missing_Def.xml"}).code, 4);
    const RunResult broken = run(folder, {"upgrade", "Broken_Def"});
    EXPECT_EQ(broken.code, 3);
    EXPECT_THAT(broken.output, HasSubstr("Broken_Def.xml:2: </case> closes nothing"));
    EXPECT_EQ(run(folder, {"upgrade"}).code, 2);
    EXPECT_EQ(run(folder, {"upgrade", "A", "B", "-o", "C"}).code, 2);
    EXPECT_EQ(run(folder, {"upgrade", "A", "-o", "C", "--in-place"}).code, 2);
}

} // namespace
