#include "app/batch_command.h"

#include "app/command_line.h"
#include "app/drawn_geometry.h"
#include "app/subcommand_line.h"
#include "app/threads.h"
#include "batch/check_case.h"
#include "batch/folder_lock.h"
#include "batch/plan.h"
#include "batch/report.h"
#include "batch/run_batch.h"
#include "core/json.h"
#include "fppg/error.h"
#include "platform/memory.h"
#include "platform/processes.h"
#include "platform/stop_signals.h"
#include "platform/terminal.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <optional>

namespace fppg
{

namespace
{

namespace fs = std::filesystem;

/// Of the memory that is free, what a batch uses unless told otherwise.
constexpr double memory_share = 0.8;

struct BatchCall
{
    std::string source; ///< folder or list; with a task or summary the folder of the plan
    std::string out = "batch_out";
    std::vector<std::string> sets;
    std::vector<std::string> of_runs; ///< options of the program for every run
    int jobs = 0;
    int threads = 0;
    double memory_gb = 0;
    std::size_t task = 0;
    std::string plan;
    bool resumes = false;
    bool slurm = false;
    bool submit = false;
    bool summary = false;
    bool dry_run = false;
    bool no_pictures = false;
    bool quiet = false;
    bool log_json = false;
};

/// The arguments behind "--" are for the runs; false when only the help was asked for.
bool read_arguments(std::vector<std::string> arguments, BatchCall& call)
{
    SubcommandLine app(
        "Runs many cases side by side, and again with other values of variables. Options after -- "
        "are passed to every run, such as -- -save:all -fit.",
        "fppg batch");
    app.add_option("SOURCE", call.source,
                   "a folder, searched for *_Def.xml, or a file that lists them, or one definition")
        .required();
    app.add_option("--out", call.out, "folder of results").shows_default();
    app.add_option("--set", call.sets,
                   "NAME=VALUE,VALUE: one run for every value of a variable; Dp is the particle "
                   "distance; may be repeated, for all combinations")
        .may_be_repeated();
    app.add_option("--jobs", call.jobs, "runs side by side (default: processors / threads)")
        .range(1, 4096);
    app.add_option("--threads", call.threads, "of each run (default: processors / jobs, or 1)")
        .range(1, 4096);
    app.add_option(
           "--memory", call.memory_gb,
           "GB that runs side by side may need by their estimates (default: 80 % of what is "
           "free)")
        .positive();
    auto dry_run = app.add_flag("--dry-run", call.dry_run,
                                "only read the definitions and look for their mesh files; say "
                                "which would be refused, and why");
    app.add_flag("--resume", call.resumes,
                 "leave out runs that are done and whose inputs have not changed")
        .excludes(dry_run);
    app.add_flag("--no-pictures", call.no_pictures, "do not draw the particles");
    app.add_flag("--quiet", call.quiet, "say nothing but errors");
    app.add_flag("--log-json", call.log_json, "one JSON object per line instead of text");
    auto slurm = app.add_flag("--slurm", call.slurm,
                              "run nothing, write scripts for a Slurm job array into --out");
    slurm.excludes(dry_run);
    app.add_flag("--submit", call.submit, "submit them with sbatch").needs(slurm);
    app.add_option("--plan", call.plan, "parallel: run nothing, print one command per run")
        .one_of({"parallel"})
        .excludes(slurm)
        .excludes(dry_run);
    app.add_option("--task", call.task,
                   "do run N of the plan in the folder SOURCE, which --slurm or --plan wrote")
        .positive()
        .excludes(dry_run);
    app.add_flag("--summary", call.summary, "only gather the results of the plan in SOURCE")
        .excludes(dry_run);
    call.of_runs = take_run_options(arguments);
    if (!app.read(arguments)) return false;
    if ((call.slurm || !call.plan.empty()) && !has_shell())
        throw UsageError(
            "--slurm and --plan write for the shell of Linux; on Windows `fppg batch` runs the "
            "cases itself, several at a time with --jobs");
    return true;
}

/// Refuses options of runs that a run would refuse, before anything begins.
void check_run_options(const std::vector<std::string>& options)
{
    std::vector<std::string> words{"Case_Def"};
    words.insert(words.end(), options.begin(), options.end());
    const DropInOptions parsed = parse_command_line(words);
    if (parsed.action != DropInOptions::Action::Run || parsed.output != "Case_Def")
        throw UsageError(
            "expected options of runs after --, such as -save:all; fppg --help lists them");
}

class BatchCommand
{
public:
    explicit BatchCommand(const BatchCall& call) : call_(call) {}

    int run()
    {
        if (call_.task > 0) return run_task();
        if (call_.summary) return summarise();
        check_run_options(call_.of_runs);
        std::vector<SweepVariable> variables;
        for (const std::string& text : call_.sets) variables.push_back(parse_sweep(text));
        out_ = folder_of(call_.out);
        plan_.runs = list_runs(call_.source, out_, variables, call_.of_runs);
        check_run_options(plan_.runs.front().options);
        if (call_.dry_run) return check_all();
        plan_.resumes = call_.resumes;
        plan_.has_pictures = !call_.no_pictures;
        const int processors = default_threads();
        const auto runs = static_cast<int>(std::min<std::size_t>(plan_.runs.size(), 4096));
        plan_.threads = call_.threads > 0 ? call_.threads
                        : call_.jobs > 0  ? std::max(1, processors / call_.jobs)
                                          : std::max(1, processors / runs);
        plan_.jobs = call_.jobs > 0 ? call_.jobs : std::max(1, processors / plan_.threads);
        make_folder();
        std::optional<FolderLock> lock(std::in_place, out_, false);
        if (call_.slurm) return write_slurm(lock);
        if (!call_.plan.empty()) return print_tasks(lock);
        write_plan(out_, plan_);
        return run_all();
    }

private:
    static std::string folder_of(const std::string& path)
    {
        const fs::path full = fs::absolute(path).lexically_normal();
        return (full.has_filename() ? full : full.parent_path()).string();
    }

    void make_folder() const
    {
        std::error_code error;
        fs::create_directories(out_, error);
        if (error)
            throw IoError(fmt::format("{}: cannot create the folder: {}", out_, error.message()));
    }

    ProgressStyle style() const
    {
        if (call_.log_json) return ProgressStyle::Json;
        if (call_.quiet) return ProgressStyle::Quiet;
        return is_terminal(Stream::Error) ? ProgressStyle::Bar : ProgressStyle::Lines;
    }

    BatchOptions options() const
    {
        BatchOptions options;
        options.jobs = plan_.jobs;
        options.threads = plan_.threads;
        options.resumes = plan_.resumes;
        options.has_pictures = plan_.has_pictures;
        options.memory_bytes = call_.memory_gb > 0
                                   ? call_.memory_gb * 1e9
                                   : memory_share * static_cast<double>(available_memory());
        return options;
    }

    /// 1 if a run would be refused.
    int check_all() const
    {
        const StopSignalsAsk stop;
        std::size_t refused = 0;
        for (const BatchRun& run : plan_.runs)
        {
            if (stop.is_asked()) throw Interrupted(stop.signal());
            std::vector<std::string> words{run.definition, run.output};
            words.insert(words.end(), run.options.begin(), run.options.end());
            const DropInOptions options = parse_command_line(words);
            const std::string path = as_named(run.definition + ".xml");
            const auto refusal = find_refusal(path, case_options(options), options.strict);
            refused += refusal ? 1 : 0;
            tell_check(path, run, refusal);
        }
        if (!call_.quiet && !call_.log_json)
            fmt::print("{} {}: {} can be run, {} {} refused\n", plan_.runs.size(),
                       call_.sets.empty() ? "definitions" : "runs", plan_.runs.size() - refused,
                       refused, refused == 1 ? "is" : "are");
        return refused > 0 ? 1 : 0;
    }

    /// Absolute only where the source was.
    std::string as_named(const std::string& definition) const
    {
        if (fs::path(call_.source).is_absolute()) return definition;
        return fs::path(definition).lexically_proximate(fs::current_path()).string();
    }

    void tell_check(const std::string& path, const BatchRun& run,
                    const std::optional<std::string>& refusal) const
    {
        if (call_.log_json)
        {
            Json json = {{"event", "checked"},
                         {"run", run.name},
                         {"definition", path},
                         {"refused", refusal.has_value()}};
            if (refusal) json["error"] = *refusal;
            fmt::print("{}\n", json.text());
            return;
        }
        if (!refusal) return;
        std::string settings;
        for (const auto& [name, value] : run.settings)
            settings += fmt::format("{}{}={}", settings.empty() ? " (" : ", ", name, value);
        fmt::print("{}{}\n", *refusal, settings.empty() ? "" : settings + ")");
    }

    int run_all() const
    {
        const StopSignalsAsk stop;
        BatchOptions run_options = options();
        run_options.is_asked_to_stop = [&stop] { return stop.is_asked(); };
        std::vector<RunRecord> records;
        {
            Progress progress(style(), plan_.runs.size());
            records = run_batch(plan_.runs, run_options, progress);
        }
        write_summary(out_, plan_.runs, records);
        const BatchCounts counts = count_states(records);
        tell(counts);
        if (stop.is_asked()) return 128 + stop.signal();
        return counts.failed + counts.open > 0 ? 1 : 0;
    }

    void tell(const BatchCounts& counts) const
    {
        if (call_.quiet || call_.log_json) return;
        fmt::print("{} runs: {} done{}, {} failed", plan_.runs.size(), counts.done,
                   counts.reused > 0 ? fmt::format(" ({} of them before)", counts.reused) : "",
                   counts.failed);
        if (counts.open > 0) fmt::print(", {} open; --resume goes on with them", counts.open);
        fmt::print("\nsummary.csv, summary.json and report.html are in {}\n", out_);
    }

    int run_task()
    {
        out_ = folder_of(call_.source);
        plan_ = read_plan(out_);
        if (call_.task > plan_.runs.size())
            throw UsageError(fmt::format("--task: {} is out of range, the plan has {} runs",
                                         call_.task, plan_.runs.size()));
        const FolderLock lock(out_, true);
        const std::vector<BatchRun> one{plan_.runs[call_.task - 1]};
        const StopSignalsAsk stop;
        BatchOptions run_options = options();
        run_options.is_asked_to_stop = [&stop] { return stop.is_asked(); };
        run_options.jobs = 1;
        Progress progress(call_.log_json ? ProgressStyle::Json
                          : call_.quiet  ? ProgressStyle::Quiet
                                         : ProgressStyle::Lines,
                          1);
        const BatchCounts counts = count_states(run_batch(one, run_options, progress));
        if (stop.is_asked()) return 128 + stop.signal();
        return counts.done == 1 ? 0 : 1;
    }

    int summarise()
    {
        out_ = folder_of(call_.source);
        plan_ = read_plan(out_);
        std::vector<RunRecord> records;
        for (const BatchRun& run : plan_.runs) records.push_back(read_record(run));
        write_summary(out_, plan_.runs, records);
        const BatchCounts counts = count_states(records);
        tell(counts);
        return counts.failed + counts.open > 0 ? 1 : 0;
    }

    /// Tasks of a scheduler may be handed in twice, so they always leave out what is done.
    int write_slurm(std::optional<FolderLock>& lock)
    {
        plan_.resumes = true;
        std::vector<RunRecord> estimates;
        {
            const StopSignalsAsk stop;
            BatchOptions run_options = options();
            run_options.is_asked_to_stop = [&stop] { return stop.is_asked(); };
            run_options.resumes = false;
            Progress progress(ProgressStyle::Quiet, plan_.runs.size());
            estimates = estimate_runs(plan_.runs, run_options, progress);
            if (stop.is_asked()) throw Interrupted(stop.signal());
        }
        write_plan(out_, plan_);
        const std::string script = write_slurm_scripts(out_, plan_, estimates);
        if (!call_.submit)
        {
            if (!call_.quiet)
                fmt::print("{} runs; look at {}/batch.sbatch, then submit it with {}\n",
                           plan_.runs.size(), out_, script);
            return 0;
        }
        std::fflush(stdout);
        // The first tasks may begin before sbatch ends, and they lock the folder themselves.
        lock.reset();
        const int code = run_script(shell_word(script));
        if (code != 0)
            throw IoError(
                fmt::format("{} ended with exit code {}; is sbatch there?", script, code));
        return 0;
    }

    int print_tasks(std::optional<FolderLock>& lock)
    {
        plan_.resumes = true;
        write_plan(out_, plan_);
        // Whoever reads the lines may begin with the first one at once.
        lock.reset();
        fmt::print("{}", task_lines(out_, plan_));
        if (!call_.quiet)
            fmt::print(stderr,
                       "{} commands; pipe them to parallel --jobs {} --joblog {}, then: fppg batch "
                       "--summary {}\n",
                       plan_.runs.size(), plan_.jobs, shell_word(out_ + "/joblog.txt"),
                       shell_word(out_));
        return 0;
    }

    BatchCall call_;
    std::string out_;
    Plan plan_;
};

} // namespace

int run_batch_command(const std::vector<std::string>& arguments)
{
    BatchCall call;
    if (!read_arguments(arguments, call)) return 0;
    return BatchCommand(call).run();
}

} // namespace fppg
