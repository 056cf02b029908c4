#include "batch/plan.h"

#include "fppg/error.h"
#include "fppg/files.h"
#include "fppg/version.h"

#include "batch/rates.h"
#include "core/json.h"
#include "platform/processes.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <fstream>

namespace fppg
{
namespace
{

namespace fs = std::filesystem;
/// Estimates may be off by a factor of two, and a task also draws a picture.
constexpr double memory_factor = 2;
constexpr double least_task_bytes = 256e6;

void write_script(const fs::path& path, const std::string& text)
{
    OutputFile file(path.string());
    file.append(text);
    file.commit();
    std::error_code ignored;
    fs::permissions(path, fs::perms::owner_exec | fs::perms::group_exec | fs::perms::others_exec,
                    fs::perm_options::add, ignored);
}

/// Scripts for Slurm and lines for GNU parallel end where a line ends, also between quotes.
void expect_one_line(const std::string& name)
{
    if (name.find_first_of("\r\n") != std::string::npos)
        throw UsageError(
            fmt::format("'{}' has a line break in its name, which no script for a "
                        "scheduler can hold; expected another name",
                        name));
}

/// A path behind `#SBATCH --output=`, where '%' begins a pattern.
std::string slurm_log(const fs::path& folder, const std::string& pattern)
{
    std::string path;
    for (const char c : (folder / "slurm/").string()) path.append(c == '%' ? 2 : 1, c);
    return shell_word(path + pattern);
}

} // namespace

std::string shell_word(const std::string& text)
{
    const auto is_plain = [](unsigned char c)
    {
        return std::isalnum(c) != 0 ||
               std::string_view("_-./:=,+%@").find(static_cast<char>(c)) != std::string_view::npos;
    };
    if (!text.empty() && std::all_of(text.begin(), text.end(), is_plain)) return text;
    std::string out = "'";
    for (const char c : text) out += c == '\'' ? "'\\''" : std::string(1, c);
    return out + "'";
}

void write_plan(const std::string& folder, const Plan& plan)
{
    Json runs = Json::array();
    for (const BatchRun& run : plan.runs)
        runs.push_back({{"run", run.name},
                        {"definition", run.definition},
                        {"output", run.output},
                        {"settings", run.settings},
                        {"options", run.options}});
    const Json json = {{"program", fmt::format("fppg {}", version)},
                       {"jobs", plan.jobs},
                       {"threads", plan.threads},
                       {"resume", plan.resumes},
                       {"pictures", plan.has_pictures},
                       {"runs", runs}};
    OutputFile file((fs::path(folder) / "plan.json").string());
    file.append(json.text(1) + "\n");
    file.commit();
}

Plan read_plan(const std::string& folder)
{
    const fs::path path = fs::path(folder) / "plan.json";
    std::ifstream in(path);
    if (!in)
        throw IoError(
            fmt::format("cannot read '{}'; fppg batch --slurm or --plan writes it", path.string()));
    try
    {
        const Json json = Json::parse(in);
        Plan plan;
        json.at("jobs").get_to(plan.jobs);
        json.at("threads").get_to(plan.threads);
        json.at("resume").get_to(plan.resumes);
        json.at("pictures").get_to(plan.has_pictures);
        for (const Json& run : json.at("runs").items())
        {
            BatchRun& out = plan.runs.emplace_back();
            run.at("run").get_to(out.name);
            run.at("definition").get_to(out.definition);
            run.at("output").get_to(out.output);
            run.at("settings").get_to(out.settings);
            run.at("options").get_to(out.options);
        }
        return plan;
    }
    catch (const JsonError& error)
    {
        throw IoError(fmt::format("{}: is no plan of a batch: {}", path.string(), error.what()));
    }
}

std::string write_slurm_scripts(const std::string& folder, const Plan& plan,
                                const std::vector<RunRecord>& estimates)
{
    double bytes = least_task_bytes;
    double seconds = 0;
    for (const RunRecord& r : estimates)
    {
        bytes = std::max({bytes, memory_factor * r.estimated_memory_bytes,
                          plan.has_pictures
                              ? rates.picture_bytes_per_particle * static_cast<double>(r.np)
                              : 0.0});
        seconds = std::max(seconds, r.estimated_seconds);
    }
    const fs::path at(folder);
    expect_one_line(folder);
    expect_one_line(program_path());
    const std::string program = shell_word(program_path());
    const std::string place = shell_word(folder);
    std::error_code error;
    fs::create_directories(at / "slurm", error);
    if (error)
        throw IoError(fmt::format("{}: cannot create the folder: {}", (at / "slurm").string(),
                                  error.message()));
    write_script(
        at / "batch.sbatch",
        fmt::format("#!/bin/sh\n"
                    "# {} runs, one per task; plan.json in this folder lists them. The longest is "
                    "estimated at {:.0f} s.\n"
                    "# Site settings (partition, account, time) can be added here or given to "
                    "sbatch.\n"
                    "#SBATCH --job-name=fppg-batch\n"
                    "#SBATCH --array=1-{}%{}\n"
                    "#SBATCH --ntasks=1\n"
                    "#SBATCH --cpus-per-task={}\n"
                    "#SBATCH --mem={:.0f}M\n"
                    "#SBATCH --output={}\n"
                    "exec {} batch --task \"$SLURM_ARRAY_TASK_ID\" {}\n",
                    plan.runs.size(), std::ceil(seconds), plan.runs.size(), plan.jobs, plan.threads,
                    std::ceil(bytes / 1048576), slurm_log(at, "task_%a.log"), program, place));
    write_script(
        at / "summary.sbatch",
        fmt::format("#!/bin/sh\n"
                    "# Gathers the results of all tasks into summary.csv, summary.json and "
                    "report.html.\n"
                    "#SBATCH --job-name=fppg-summary\n"
                    "#SBATCH --ntasks=1\n"
                    "#SBATCH --cpus-per-task=1\n"
                    "#SBATCH --mem=256M\n"
                    "#SBATCH --output={}\n"
                    "exec {} batch --summary {}\n",
                    slurm_log(at, "summary.log"), program, place));
    write_script(
        at / "submit.sh",
        fmt::format("#!/bin/sh\n"
                    "# Submits the job array, and the summary after it; arguments go to both, "
                    "such as -p short.\n"
                    "set -e\n"
                    "id=$(sbatch --parsable \"$@\" {})\n"
                    "id=${{id%%;*}}\n"
                    "sum=$(sbatch --parsable --dependency=afterany:\"$id\" \"$@\" {})\n"
                    "echo \"job array $id ({} tasks), summary ${{sum%%;*}}\"\n",
                    shell_word((at / "batch.sbatch").string()),
                    shell_word((at / "summary.sbatch").string()), plan.runs.size()));
    return (at / "submit.sh").string();
}

std::string task_lines(const std::string& folder, const Plan& plan)
{
    expect_one_line(folder);
    expect_one_line(program_path());
    std::string text;
    for (std::size_t i = 1; i <= plan.runs.size(); ++i)
        text += fmt::format("{} batch --task {} {}\n", shell_word(program_path()), i,
                            shell_word(folder));
    return text;
}

} // namespace fppg
