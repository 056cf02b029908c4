// fppg batch, run as users run it; FPPG_PROGRAM is the program's path.

#include "batch/batch_cases.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>
#include <sstream>

namespace
{

namespace fs = std::filesystem;
using namespace fppg::test;
using nlohmann::json;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

const Arguments template_names{"DrawBox",   "DrawCylinder", "DrawEllipsoid", "DrawFileStl",
                               "DrawPrism", "DrawSphere",   "Lists",         "Redraw"};

/// Runs a batch of `source` into out/.
RunResult batch(const TemporaryFolder& folder, const std::string& source, const Arguments& more)
{
    Arguments words{"batch", source, "--out", "out", "--threads", "1"};
    words.insert(words.end(), more.begin(), more.end());
    return run(folder, words);
}

std::map<std::string, json> runs_of(const TemporaryFolder& folder)
{
    std::map<std::string, json> out;
    const json summary = read_json(folder.path() / "out/summary.json");
    for (const json& one : summary.at("runs")) out[one.at("run")] = one;
    return out;
}

/// How often something happened to each run, from lines of --log-json.
std::map<std::string, int> count_events(const std::string& output, const std::string& event)
{
    std::map<std::string, int> out;
    std::istringstream lines(output);
    for (std::string line; std::getline(lines, line);)
    {
        const json one = json::parse(line, nullptr, false);
        if (one.is_object() && one.at("event") == event) ++out[one.at("run")];
    }
    return out;
}

/// When each result file of the runs that are done was written.
std::map<std::string, fs::file_time_type> times_of_results(const TemporaryFolder& folder)
{
    std::map<std::string, fs::file_time_type> out;
    for (const auto& entry : fs::recursive_directory_iterator(folder.path() / "out"))
        if (entry.path().extension() == ".bi4")
            out[entry.path().string()] = fs::last_write_time(entry);
    return out;
}

TEST(Batch, KilledInTheMiddleIsResumedWithNothingLostAndNothingDoneTwice)
{
    const TemporaryFolder folder;
    copy_templates(folder.path() / "cases", template_names);
    write_text(folder / "cases/Broken_Def.xml", "<case><open>" + box_case().text());
    const Arguments options{"batch",        "cases",
                            "--out",        "out",
                            "--threads",    "1",
                            "--jobs",       "2",
                            "--set",        "Dp=0.1,0.09,0.08,0.07,0.06",
                            "--log-json",   "--resume",
                            "--no-pictures"};
    constexpr std::size_t all = 45;
    Process first(FPPG_PROGRAM, options, folder.path().string());
    wait_until([&] { return count_events(first.output_so_far(), "finished").size() >= 12; });
    first.send(SIGKILL);
    const RunResult killed = first.wait();
    ASSERT_EQ(killed.code, 128 + SIGKILL);
    // A child may be between its last output file and its end when the batch is killed.
    std::set<std::string> done;
    for (const auto& [name, count] : count_events(killed.output, "finished")) done.insert(name);
    ASSERT_LT(done.size(), all);

    const RunResult second = run(folder, options);
    EXPECT_EQ(second.code, 1) << second.output;
    const auto started = count_events(second.output, "started");
    for (const std::string& name : done)
        EXPECT_EQ(started.count(name), contains(name, "Broken") ? 1U : 0U) << name;
    const auto runs = runs_of(folder);
    EXPECT_EQ(runs.size(), all);
    for (const auto& [name, one] : runs)
        EXPECT_EQ(one.at("state"), contains(name, "Broken") ? "failed" : "done") << name;
    const json summary = read_json(folder.path() / "out/summary.json");
    EXPECT_EQ(summary.at("done"), 40);
    EXPECT_EQ(summary.at("failed"), 5);
    EXPECT_EQ(summary.at("open"), 0);
    for (const auto& [path, bytes] : contents(folder.path() / "out"))
        EXPECT_THAT(path, Not(HasSubstr(".part-")));

    const auto before = times_of_results(folder);
    EXPECT_EQ(before.size(), 40U);
    run(folder, options);
    EXPECT_EQ(times_of_results(folder), before);
}

TEST(Batch, RemovesWhatAKilledRunHadBegunToWrite)
{
    const TemporaryFolder folder;
    copy_templates(folder.path() / "cases", {"DrawFileStl"});
    const fs::path result = folder.path() / "out/DrawFileStl";
    const std::string part = result / "data/.block.stl.part-1";
    fs::create_directories(result / "data");
    write_text(part, "solid");
    write_text((result / ".DrawFileStl.bi4.part-1").string(), "half");
    ASSERT_EQ(batch(folder, "cases", {}).code, 0);
    EXPECT_FALSE(fs::exists(part));
    EXPECT_FALSE(fs::exists(result / ".DrawFileStl.bi4.part-1"));
    // And where the run itself was done, but what came after it was killed.
    write_text(part, "solid");
    ASSERT_EQ(batch(folder, "cases", {"--resume"}).code, 0);
    EXPECT_FALSE(fs::exists(part));
}

TEST(Batch, GivesTheBytesOfSingleRuns)
{
    const TemporaryFolder folder;
    copy_templates(folder.path() / "cases", {"DrawBox", "DrawFileStl"});
    ASSERT_EQ(batch(folder, "cases", {"--set", "Dp=0.1,0.08", "--", "-save:all"}).code, 0);
    for (const std::string name : {"DrawBox", "DrawFileStl"})
    {
        run(folder, {fmt::format("cases/{}_Def", name), fmt::format("single/{0}/{0}", name),
                     "-dp:0.08", "-save:all"});
        auto of_batch = results(folder.path() / "out" / (name + "_Dp0.08"));
        std::erase_if(of_batch, [&](const auto& file)
                      { return file.first == name + ".png" || contains(file.first, ".batch."); });
        EXPECT_EQ(of_batch, results(folder.path() / "single" / name)) << name;
    }
}

TEST(Batch, RunsACaseAgainWhenItsMeshHasChanged)
{
    const TemporaryFolder folder;
    copy_templates(folder.path() / "cases", {"DrawBox", "DrawFileStl"});
    ASSERT_EQ(batch(folder, "cases", {}).code, 0);
    const json inputs =
        read_json(folder.path() / "out/DrawFileStl/DrawFileStl.batch.json").at("inputs");
    ASSERT_GE(inputs.size(), 2U);
    const std::string mesh = inputs[1].at("path");
    write_text(mesh, read_text(mesh) + " ");
    const std::string output = batch(folder, "cases", {"--resume", "--log-json"}).output;
    const auto started = count_events(output, "started");
    EXPECT_EQ(started.size(), 1U);
    EXPECT_EQ(started.count("DrawFileStl"), 1U);
}

TEST(Batch, RunsACaseAgainWhenOptionsOrOutputsAreOthers)
{
    const TemporaryFolder folder;
    write_text(folder / "Case_Def.xml", box_case().text());
    const auto starts = [&](const Arguments& more)
    {
        Arguments words{"--resume", "--log-json", "--no-pictures"};
        words.insert(words.end(), more.begin(), more.end());
        return count_events(batch(folder, "Case_Def.xml", words).output, "started").size();
    };
    EXPECT_EQ(starts({}), 1U);
    EXPECT_EQ(starts({}), 0U);
    EXPECT_EQ(starts({"--", "-save:all"}), 1U);
    EXPECT_EQ(starts({"--", "-save:all"}), 0U);
    fs::resize_file(folder / "out/Case/Case.bi4", 100);
    EXPECT_EQ(starts({"--", "-save:all"}), 1U);
    write_text(folder / "Case_Def.xml", box_case("0.7").text());
    EXPECT_EQ(starts({"--", "-save:all"}), 1U);
}

TEST(Batch, DrawsMissingPicturesWithoutRunningAgain)
{
    const TemporaryFolder folder;
    write_text(folder / "Case_Def.xml", box_case().text());
    ASSERT_EQ(batch(folder, ".", {"--no-pictures"}).code, 0);
    const auto before = times_of_results(folder);
    const std::string output = batch(folder, ".", {"--resume", "--log-json"}).output;
    EXPECT_EQ(count_events(output, "started").size(), 0U);
    EXPECT_EQ(times_of_results(folder), before);
    EXPECT_TRUE(fs::exists(folder / "out/Case/Case.png"));
    EXPECT_THAT(read_text(folder / "out/report.html"), HasSubstr("data:image/png"));
    ASSERT_EQ(batch(folder, ".", {"--resume"}).code, 0);
    EXPECT_THAT(read_text(folder / "out/report.html"), HasSubstr("data:image/png"));
}

TEST(Batch, StopsItsChildrenOnCtrlCAndGoesOnLater)
{
    const TemporaryFolder folder;
    CaseText slow = box_case();
    slow.mainlist =
        R"(<setdrawmode mode="full" /><setmkbound mk="0" /><drawsphere radius="0.4"><point x="0.5" y="0.5" z="0.5" /></drawsphere>)";
    write_text(folder / "A_Def.xml", slow.text());
    const Arguments options{"batch",    "A_Def.xml", "--out",        "out", "--log-json",
                            "--resume", "--set",     "Dp=0.01,0.05", "--",  "-fit"};
    Process first(FPPG_PROGRAM, options, folder.path().string());
    wait_until([&] { return !count_events(first.output_so_far(), "started").empty(); });
    first.send(SIGINT);
    const RunResult stopped = first.wait();
    EXPECT_EQ(stopped.code, 130);
    const json summary = read_json(folder.path() / "out/summary.json");
    EXPECT_GE(summary.at("open"), 1);
    EXPECT_EQ(summary.at("failed"), 0);
    EXPECT_FALSE(fs::exists(folder / "out/A_Dp0.01/A.bi4"));
}

TEST(Batch, KeepsRunsWithinItsMemory)
{
    const TemporaryFolder folder;
    CaseText large = box_case();
    large.dp = "0.002";
    // A lattice with a hole in every column, so that there are many runs.
    large.mainlist +=
        R"(<setmkvoid /><drawsphere radius="0.3"><point x="0.4" y="0.4" z="0.4" /></drawsphere>)";
    write_text(folder / "Large_Def.xml", large.text());
    write_text(folder / "Small_Def.xml", box_case().text());
    EXPECT_EQ(batch(folder, ".", {"--jobs", "2", "--memory", "0.02", "--no-pictures"}).code, 1);
    const auto runs = runs_of(folder);
    EXPECT_EQ(runs.at("Large").at("state"), "refused");
    const std::string error = runs.at("Large").at("error");
    EXPECT_THAT(error, HasSubstr("--memory allows more, dp="));
    EXPECT_EQ(runs.at("Small").at("state"), "done");
    const std::size_t begin = error.find("dp=") + 3;
    const std::string dp = error.substr(begin, error.find(' ', begin) - begin);
    EXPECT_EQ(batch(folder, ".", {"--set", "Dp=" + dp, "--memory", "0.02", "--no-pictures"}).code,
              0)
        << error;
}

TEST(Batch, DoesNotRunSideBySideWhatNeedsMoreMemoryTogether)
{
    const TemporaryFolder folder;
    write_text(folder / "Case_Def.xml", box_case().text());
    const std::string output = batch(folder, "Case_Def.xml",
                                     {"--set", "Dp=0.1,0.09,0.08,0.07", "--jobs", "4", "--memory",
                                      "0.05", "--log-json", "--no-pictures"})
                                   .output;
    // Each is counted with 32 MB at least.
    int running = 0;
    std::istringstream lines(output);
    for (std::string line; std::getline(lines, line);)
    {
        const std::string event = json::parse(line).at("event");
        running += event == "started" ? 1 : event == "finished" ? -1 : 0;
        EXPECT_LE(running, 1) << output;
    }
    EXPECT_EQ(count_events(output, "finished").size(), 4U);
}

TEST(Batch, SweepsOverAllCombinationsOfVariables)
{
    const TemporaryFolder folder;
    CaseText text = box_case("#Size");
    text.predefinition.clear();
    text.mainlist = R"(<newvarcte Size="0.8" _rem="edge" />)" + text.mainlist;
    write_text(folder / "Case_Def.xml", text.text());
    const RunResult result =
        batch(folder, "Case_Def.xml", {"--set", "Dp=0.1,0.05", "--set", "Size=0.4,0.8"});
    ASSERT_EQ(result.code, 0) << result.output;
    const auto runs = runs_of(folder);
    EXPECT_EQ(runs.size(), 4U);
    EXPECT_EQ(runs.at("Case_Dp0.1_Size0.4").at("particles"), 125);
    EXPECT_EQ(runs.at("Case_Dp0.05_Size0.8").at("particles"), 4913);
    EXPECT_EQ(runs.at("Case_Dp0.05_Size0.8").at("settings").at("Size"), "0.8");
}

TEST(Batch, ReadsAListAndNamesTheLineOfAMissingCase)
{
    const TemporaryFolder folder;
    fs::create_directories(folder.path() / "a");
    write_text(folder / "a/Case_Def.xml", box_case().text());
    write_text(folder / "list.txt", "# two\n\na/Case_Def\na/Case_Def.xml\n");
    EXPECT_EQ(batch(folder, "list.txt", {"--no-pictures"}).code, 0);
    EXPECT_EQ(runs_of(folder).size(), 2U);
    write_text(folder / "list.txt", "a/Case_Def\nb/Case_Def\n");
    const RunResult result = batch(folder, "list.txt", {});
    EXPECT_EQ(result.code, 4);
    EXPECT_THAT(result.output, HasSubstr("list.txt:2: there is no file"));
}

TEST(Batch, WritesAReportThatNeedsNoOtherFile)
{
    const TemporaryFolder folder;
    write_text(folder / "Case_Def.xml", box_case().text());
    write_text(folder / "Broken_Def.xml", "<case>");
    EXPECT_EQ(batch(folder, ".", {}).code, 1);
    const std::string html = read_text(folder / "out/report.html");
    EXPECT_THAT(html, HasSubstr("<h1>2 runs: 1 done, 1 failed, 0 open</h1>"));
    EXPECT_THAT(html, HasSubstr("src=\"data:image/png;base64,iVBORw0KGgo"));
    for (const char* outside : {"src=\"http", "href=\"http", "<link", "@import"})
        EXPECT_THAT(html, Not(HasSubstr(outside)));
    EXPECT_THAT(read_text(folder / "out/summary.csv"),
                HasSubstr("\nCase," + folder / "Case_Def.xml"));
}

TEST(Batch, SaysNothingWhenQuietAndALineARunInALog)
{
    const TemporaryFolder folder;
    write_text(folder / "Case_Def.xml", box_case().text());
    EXPECT_EQ(batch(folder, ".", {"--quiet"}).output, "");
    EXPECT_THAT(batch(folder, ".", {}).output, HasSubstr("[1/1] Case: done, 729 particles"));
}

TEST(Batch, RefusesWrongUsageBeforeAnythingRuns)
{
    const TemporaryFolder folder;
    write_text(folder / "Case_Def.xml", box_case().text());
    EXPECT_EQ(batch(folder, ".", {"--set", "Dp"}).code, 2);
    EXPECT_EQ(batch(folder, ".", {"--set", "Dp=0"}).code, 2);
    EXPECT_EQ(batch(folder, ".", {"--", "-nonsense"}).code, 2);
    EXPECT_EQ(batch(folder, "nowhere", {}).code, 4);
    EXPECT_FALSE(fs::exists(folder / "out/Case"));
}

} // namespace
