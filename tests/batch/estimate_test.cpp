// fppg estimate, run as users run it; FPPG_PROGRAM is the program's path.

#include "batch/batch_cases.h"

#include "fppg/read_particles.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

namespace
{

using namespace fppg::test;
using nlohmann::json;
using testing::HasSubstr;

json estimate(const TemporaryFolder& folder, const Arguments& more = {})
{
    Arguments words{"estimate", "Case_Def", "--json"};
    words.insert(words.end(), more.begin(), more.end());
    return json::parse(run(folder, words).output);
}

TEST(Estimate, CountsALatticeCaseExactlyAndWritesNothing)
{
    const TemporaryFolder folder;
    write_text(folder / "Case_Def.xml", box_case().text());
    const json found = estimate(folder, {"-dp:0.05"});
    EXPECT_TRUE(found.at("exact"));
    EXPECT_EQ(contents(folder.path()).size(), 1U);
    const std::string printed = run(folder, {"Case_Def", "out/Case", "-dp:0.05"}).output;
    EXPECT_THAT(printed, HasSubstr("Total particles: 4,913 "));
    EXPECT_EQ(found.at("particles"), 4913);
    EXPECT_EQ(found.at("fluid"), 4913);
}

TEST(Estimate, IsNearTheCountsOfBodyFittedWalls)
{
    const TemporaryFolder folder;
    CaseText text;
    text.dp = "0.03";
    text.mainlist =
        R"(<setdrawmode mode="full" /><setmkbound mk="0" /><drawsphere radius="0.4"><point x="0.5" y="0.5" z="0.5" /></drawsphere>)";
    write_text(folder / "Case_Def.xml", text.text());
    const json found = estimate(folder, {"-fit"});
    EXPECT_FALSE(found.at("exact"));
    run(folder, {"Case_Def", "out/Case", "-fit"});
    const double particles =
        static_cast<double>(fppg::read_particles(folder / "out/Case", false, 1).positions.size());
    EXPECT_NEAR(found.at("particles").get<double>(), particles, 0.05 * particles);
}

TEST(Estimate, LeavesOutTheSurfaceBeyondTheDomain)
{
    const TemporaryFolder folder;
    CaseText text;
    text.dp = "0.02";
    text.pointmin = R"(<pointmin x="0.5" y="-0.5" z="-0.5" />)";
    text.mainlist =
        R"(<setdrawmode mode="face" /><setmkbound mk="0" /><drawsphere radius="0.4"><point x="0.5" y="0.5" z="0.5" /></drawsphere>)";
    write_text(folder / "Case_Def.xml", text.text());
    const double whole = 4 * M_PI * 0.4 * 0.4;
    EXPECT_NEAR(estimate(folder, {"-fit"}).at("wall_area").get<double>(), whole / 2, whole * 0.03);
}

TEST(Estimate, NamesTheFilesThatACaseReads)
{
    const TemporaryFolder folder;
    copy_templates(folder.path(), {"DrawFileStl"});
    const RunResult result = run(folder, {"estimate", "DrawFileStl_Def.xml", "--json"});
    EXPECT_THAT(json::parse(result.output).at("files").dump(), HasSubstr("/data/"));
}

TEST(Estimate, RefusesABrokenCaseAsARunDoes)
{
    const TemporaryFolder folder;
    write_text(folder / "Case_Def.xml", "<case>");
    EXPECT_EQ(run(folder, {"estimate", "Case_Def"}).code, run(folder, {"Case_Def", "Out"}).code);
}

TEST(Estimate, TellsPeopleInALineEach)
{
    const TemporaryFolder folder;
    write_text(folder / "Case_Def.xml", box_case().text());
    const std::string text = run(folder, {"estimate", "Case_Def"}).output;
    EXPECT_THAT(text, HasSubstr("Particles   729 (fixed 0, moving 0, floating 0, fluid 729)"));
    EXPECT_THAT(text, HasSubstr("\nMemory      about "));
    EXPECT_THAT(text, HasSubstr("\nTime        about "));
}

} // namespace
