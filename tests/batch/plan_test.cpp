// Plans for Slurm and GNU parallel; FPPG_PROGRAM is the program's path.

#include "batch/batch_cases.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>

namespace
{

namespace fs = std::filesystem;
using namespace fppg::test;
using nlohmann::json;
using testing::HasSubstr;

void write_two_cases(const TemporaryFolder& folder)
{
    write_text(folder / "A_Def.xml", box_case().text());
    write_text(folder / "B_Def.xml", "<case>");
}

TEST(BatchPlan, WritesAJobArrayForSlurm)
{
    const TemporaryFolder folder;
    write_two_cases(folder);
    const RunResult result = run(folder, {"batch", ".", "--out", "out it", "--slurm", "--jobs", "3",
                                          "--threads", "2", "--set", "Dp=0.1,0.05"});
    EXPECT_EQ(result.code, 0) << result.output;
    const std::string script = read_text(folder / "out it/batch.sbatch");
    EXPECT_THAT(script, HasSubstr("\n#SBATCH --array=1-4%3\n"));
    EXPECT_THAT(script, HasSubstr("\n#SBATCH --cpus-per-task=2\n"));
    EXPECT_THAT(script,
                HasSubstr(" batch --task \"$SLURM_ARRAY_TASK_ID\" '" + folder / "out it" + "'\n"));
    EXPECT_THAT(read_text(folder / "out it/submit.sh"), HasSubstr("--dependency=afterany:\"$id\""));
    EXPECT_FALSE(fs::exists(folder / "out it/A_Dp0.1/A.bi4"));
}

/// Stands in for sbatch: does the array at once, one task after the other, and the summary.
constexpr const char* sbatch = R"(#!/bin/sh
for script; do :; done
tasks=$(sed -n 's/^#SBATCH --array=1-\([0-9]*\).*/\1/p' "$script")
for i in $(seq ${tasks:-1}); do SLURM_ARRAY_TASK_ID=$i sh "$script" >>sbatch.log 2>&1; done
echo "17;cluster"
)";

TEST(BatchPlan, SubmitsTheArrayAndItsSummary)
{
    const TemporaryFolder folder;
    write_two_cases(folder);
    fs::create_directories(folder.path() / "bin");
    write_text(folder / "bin/sbatch", sbatch);
    fs::permissions(folder / "bin/sbatch", fs::perms::owner_all);
    const RunResult result =
        Process(FPPG_PROGRAM, {"batch", ".", "--slurm", "--submit"}, folder.path().string(),
                {{"PATH", folder / "bin" + ":" + std::getenv("PATH")}})
            .wait();
    EXPECT_THAT(result.output, HasSubstr("job array 17 (2 tasks), summary 17"));
    const json summary = read_json(folder.path() / "batch_out/summary.json");
    EXPECT_EQ(summary.at("done"), 1);
    EXPECT_EQ(summary.at("failed"), 1);
    EXPECT_TRUE(fs::exists(folder / "batch_out/report.html"));
}

TEST(BatchPlan, PrintsACommandARunForGnuParallel)
{
    const TemporaryFolder folder;
    write_two_cases(folder);
    const RunResult result = run(folder, {"batch", ".", "--plan", "parallel", "--quiet"});
    EXPECT_EQ(result.output, std::string(FPPG_PROGRAM) + " batch --task 1 " + folder / "batch_out" +
                                 "\n" + FPPG_PROGRAM + " batch --task 2 " + folder / "batch_out" +
                                 "\n");
    EXPECT_EQ(run(folder, {"batch", "--task", "1", "batch_out"}).code, 0);
    EXPECT_EQ(run(folder, {"batch", "--task", "2", "batch_out"}).code, 1);
    EXPECT_EQ(run(folder, {"batch", "--task", "3", "batch_out"}).code, 2);
    EXPECT_EQ(run(folder, {"batch", "--summary", "batch_out"}).code, 1);
    EXPECT_EQ(read_json(folder.path() / "batch_out/summary.json").at("done"), 1);
}

TEST(BatchPlan, SaysThatAFolderHasNoPlan)
{
    const TemporaryFolder folder;
    const RunResult result = run(folder, {"batch", "--task", "1", "."});
    EXPECT_EQ(result.code, 4);
    EXPECT_THAT(result.output, HasSubstr("plan.json"));
}

} // namespace
