// fppg estimate, run as users run it; FPPG_PROGRAM is the program's path.

#include "batch/batch_cases.h"

#include "fppg/read_particles.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <string>

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

/// A ball with three layers in front of fluid, about 7,000 particles in them.
CaseText layered_ball()
{
    CaseText text;
    text.dp = "0.02";
    text.mainlist =
        R"(<setdrawmode mode="full" /><setmkbound mk="0" /><drawsphere radius="0.3"><point x="0.5" y="0.5" z="0.5" /></drawsphere><setmkfluid mk="0" /><fillbox x="0.05" y="0.05" z="0.05"><modefill>void</modefill><point x="0" y="0" z="0" /><size x="1" y="1" z="1" /></fillbox>)";
    text.after_geometry = R"(<fppg><bodyfitted boundary="mdbc" /></fppg>)";
    return text;
}

TEST(Estimate, CountsLayersAndTakesTheirTimeIn)
{
    const TemporaryFolder folder;
    write_text(folder / "Case_Def.xml", layered_ball().text());
    const json found = estimate(folder);
    run(folder, {"Case_Def", "out/Case"});
    const double particles =
        static_cast<double>(fppg::read_particles(folder / "out/Case", false, 1).positions.size());
    EXPECT_NEAR(found.at("particles").get<double>(), particles, 0.03 * particles);
    EXPECT_NEAR(found.at("wall_particles").get<double>(), 7050, 350)
        << "4 pi of (0.29, 0.27 and 0.25 m) / dp, squared";
}

/// Half of a ball is beyond the domain, but all of it is laid: memory was that of the half.
TEST(Estimate, TakesInWhatIsLaidBeyondTheDomain)
{
    const TemporaryFolder folder;
    CaseText text = layered_ball();
    text.mainlist.resize(text.mainlist.find("<setmkfluid"));
    write_text(folder / "Case_Def.xml", text.text());
    const json whole = estimate(folder);
    text.pointmin = R"(<pointmin x="0.5" y="-0.5" z="-0.5" />)";
    write_text(folder / "Case_Def.xml", text.text());
    const json half = estimate(folder);
    const auto ratio = [&](const char* of)
    { return half.at(of).get<double>() / whole.at(of).get<double>(); };
    EXPECT_NEAR(ratio("wall_particles"), 0.5, 0.03);
    EXPECT_GT(ratio("memory_bytes"), 0.85);
}

/// Layers outside of a vessel of faces grow with the distance from it: each was counted by the area
/// of the vessel, and of two round ones a third was missing.
TEST(Estimate, CountsTheLayersOutsideOfVessels)
{
    const std::string vessel = R"(<setdrawmode mode="face" /><setmkbound mk="0" />)";
    const std::string water =
        R"(<setmkfluid mk="0" /><fillbox x="0.5" y="0.5" z="0.4"><modefill>void</modefill><point x="0" y="0" z="0" /><size x="1" y="1" z="0.5" /></fillbox>)";
    for (
        const char* draw :
        {R"(<drawbox><boxfill>all^top</boxfill><point x="0.2" y="0.2" z="0.2" /><size x="0.6" y="0.6" z="0.6" /></drawbox>)",
         R"(<drawsphere radius="0.3"><point x="0.5" y="0.5" z="0.5" /></drawsphere>)"})
        for (const char* boundary : {"dbc", "mdbc"})
        {
            const TemporaryFolder folder;
            CaseText text;
            text.dp = "0.025";
            text.mainlist = vessel;
            text.mainlist += draw;
            text.mainlist += water;
            text.after_geometry = R"(<fppg><bodyfitted boundary=")";
            text.after_geometry += boundary;
            text.after_geometry += R"(" /></fppg>)";
            write_text(folder / "Case_Def.xml", text.text());
            const json found = estimate(folder);
            run(folder, {"Case_Def", "out/Case"});
            const fppg::ParticleCloud cloud = fppg::read_particles(folder / "out/Case", false, 1);
            const auto walls = static_cast<double>(
                std::count_if(cloud.mk.begin(), cloud.mk.end(), [](auto mk) { return mk >= 10; }));
            EXPECT_NEAR(found.at("wall_particles").get<double>() / walls, 1, 0.06)
                << draw << " " << boundary;
        }
}

TEST(Estimate, IsFittedToTheMachineByCalibrating)
{
    const TemporaryFolder folder;
    write_text(folder / "Case_Def.xml", layered_ball().text());
    setenv("XDG_CONFIG_HOME", folder.path().c_str(), 1);
    const double before = estimate(folder).at("seconds");
    const RunResult calibrated = run(folder, {"estimate", "--calibrate"});
    EXPECT_EQ(calibrated.code, 0) << calibrated.output;
    const json measured = json::parse(read_text(folder / "fppg/speed.json"));
    EXPECT_GT(measured.at("factor").get<double>(), 0);
    write_text(folder / "fppg/speed.json", R"({"factor": 100})");
    const double slow = estimate(folder).at("seconds");
    EXPECT_GT(slow, 20 * before);
    // Cut short, it counts as none.
    write_text(folder / "fppg/speed.json", R"({"factor":)");
    EXPECT_LT(estimate(folder).at("seconds").get<double>(), slow / 4);
    unsetenv("XDG_CONFIG_HOME");
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
