#include "batch/run_batch.h"

#include "fppg/error.h"

#include "batch/content_hash.h"
#include "batch/rates.h"
#include "core/json.h"
#include "core/most_particles.h"
#include "platform/child_process.h"
#include "platform/file_map.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <csignal>
#include <filesystem>
#include <memory>
#include <thread>

namespace fppg
{
namespace
{

namespace fs = std::filesystem;

/// What a child counts where nothing is known of it: an estimate, or a run whose estimate failed,
/// which fails as early itself.
constexpr double small_bytes = 32e6;
/// A picture shows a part of large results, and they are measured piece by piece.
constexpr std::uint64_t picture_particles = 4000000;
/// Of all runs together in the 3-D view of the report.
constexpr std::size_t view_particles = 1000000;
constexpr auto poll_interval = std::chrono::milliseconds(5);
/// Between two requests to stop; the first one ends a relaxation early, the second the program.
constexpr auto stop_interval = std::chrono::milliseconds(200);

/// Takes what `fppg estimate --json` printed; the run goes on without it where it is no JSON.
void read_estimate(const std::string& printed, RunRecord& record)
{
    try
    {
        const Json json = Json::parse(printed);
        json.at("particles").get_to(record.np);
        json.at("memory_bytes").get_to(record.estimated_memory_bytes);
        json.at("seconds").get_to(record.estimated_seconds);
        for (const Json& file : json.at("files").items())
            record.inputs.emplace_back(file.get<std::string>(), "");
    }
    catch (const JsonError&)
    {
        return;
    }
}

enum class Step
{
    Estimate,
    Run,
    Picture,
    End,
};

struct Job
{
    const BatchRun* run = nullptr;
    Step step = Step::Estimate;
    std::unique_ptr<ChildProcess> child;
    double reserved_bytes = 0; ///< while the child is at work
    RunRecord record;

    std::string folder() const { return fs::path(run->output).parent_path().string(); }
    std::string log() const { return run->output + ".batch.log"; }
    std::string estimate_file() const { return run->output + ".batch.estimate"; }
};

class Batch
{
public:
    Batch(const std::vector<BatchRun>& runs, const BatchOptions& options, Progress& progress,
          bool only_estimates)
        : options_(options),
          progress_(progress),
          only_estimates_(only_estimates),
          program_(program_identity()),
          jobs_(runs.size())
    {
        for (std::size_t i = 0; i < runs.size(); ++i) jobs_[i].run = &runs[i];
    }

    std::vector<RunRecord> work()
    {
        for (Job& job : jobs_) prepare(job);
        while (std::any_of(jobs_.begin(), jobs_.end(),
                           [](const Job& job) { return job.step != Step::End; }))
        {
            if (options_.is_asked_to_stop && options_.is_asked_to_stop()) stop();
            for (Job& job : jobs_)
                if (job.child && job.child->has_ended()) take_result(job);
            while (!is_stopped_ && start_next())
            {
            }
            progress_.tick(running(), share_done());
            std::this_thread::sleep_for(poll_interval);
        }
        std::vector<RunRecord> out;
        for (Job& job : jobs_) out.push_back(std::move(job.record));
        return out;
    }

private:
    std::size_t running() const
    {
        return static_cast<std::size_t>(
            std::count_if(jobs_.begin(), jobs_.end(), [](const Job& job) { return !!job.child; }));
    }

    double share_done() const
    {
        double all = 0;
        double done = 0;
        for (const Job& job : jobs_)
        {
            if (job.step == Step::Estimate) return 0;
            if (job.record.is_reused) continue;
            all += job.record.estimated_seconds;
            if (job.step == Step::End) done += job.record.estimated_seconds;
        }
        return all > 0 ? done / all : 0;
    }

    double reserved() const
    {
        double sum = 0;
        for (const Job& job : jobs_) sum += job.child ? job.reserved_bytes : 0;
        return sum;
    }

    void prepare(Job& job)
    {
        if (options_.resumes)
        {
            job.record = read_record(*job.run);
            if (is_current(*job.run, job.record, program_))
            {
                job.record.is_reused = true;
                job.step = Step::Picture;
                remove_leftovers(job);
                if (!wants_picture(job)) finish(job);
                return;
            }
        }
        job.record = {};
        job.record.program = program_;
        job.record.options = job.run->options;
        std::error_code error;
        fs::create_directories(job.folder(), error);
        if (error)
            throw IoError(
                fmt::format("{}: cannot create the folder: {}", job.folder(), error.message()));
        remove_leftovers(job);
    }

    /// Whether a run that is done still lacks its picture, and there is memory to draw it.
    bool wants_picture(const Job& job) const
    {
        const bool has_picture = !job.record.picture.empty() &&
                                 fs::exists(job.run->output + ".png") &&
                                 fs::exists(look_path(*job.run));
        return options_.has_pictures && !has_picture && job.record.np > 0 &&
               needed_bytes(job) <= options_.memory_bytes;
    }

    /// Temporary files of a run that was killed, its copies of meshes in data/ too.
    static void remove_leftovers(const Job& job)
    {
        std::error_code ignored;
        std::vector<fs::path> leftovers;
        for (const auto& entry : fs::recursive_directory_iterator(job.folder(), ignored))
        {
            const std::string name = entry.path().filename().string();
            if (name.starts_with('.') && name.find(".part-") != std::string::npos)
                leftovers.push_back(entry.path());
        }
        for (const fs::path& path : leftovers) fs::remove(path, ignored);
    }

    /// Starts what fits beside the children at work; false if nothing does.
    bool start_next()
    {
        if (running() >= static_cast<std::size_t>(options_.jobs)) return false;
        const double free_bytes = options_.memory_bytes - reserved();
        Job* best = nullptr;
        bool has_estimates = false;
        for (Job& job : jobs_)
        {
            has_estimates = has_estimates || job.step == Step::Estimate;
            if (job.child || job.step == Step::End) continue;
            if (running() > 0 && needed_bytes(job) > free_bytes) continue;
            if (best == nullptr || comes_before(job, *best)) best = &job;
        }
        if (best == nullptr) return false;
        // The longest runs come first, which all estimates must be known for.
        if (best->step == Step::Run && has_estimates) return false;
        start(*best);
        return true;
    }

    static double needed_bytes(const Job& job)
    {
        if (job.step == Step::Run) return std::max(small_bytes, job.record.estimated_memory_bytes);
        if (job.step == Step::Picture)
            return small_bytes +
                   rates.picture_bytes_per_particle *
                       static_cast<double>(std::min(job.record.np, picture_particles));
        return small_bytes;
    }

    static bool comes_before(const Job& a, const Job& b)
    {
        const auto rank = [](const Job& job) {
            return job.step == Step::Estimate ? 0 : job.step == Step::Picture ? 1 : 2;
        };
        if (rank(a) != rank(b)) return rank(a) < rank(b);
        return a.step == Step::Run && a.record.estimated_seconds > b.record.estimated_seconds;
    }

    void start(Job& job)
    {
        const fs::path definition(job.run->definition);
        const std::string folder = definition.parent_path().string();
        std::string name = definition.filename().string();
        // Else it would be an option.
        if (name.starts_with('-')) name.insert(0, "./");
        const std::string threads = fmt::format("{}", options_.threads);
        job.reserved_bytes = needed_bytes(job);
        std::vector<std::string> words;
        std::string log = job.log();
        if (job.step == Step::Estimate)
        {
            words = {"estimate", name, "--json", "-threads:" + threads};
            words.insert(words.end(), job.run->options.begin(), job.run->options.end());
            log = job.estimate_file();
        }
        else if (job.step == Step::Run)
        {
            note_inputs(job);
            job.record.state = RunState::Stopped;
            write_record(*job.run, job.record);
            words = {name, job.run->output, "-threads:" + threads};
            words.insert(words.end(), job.run->options.begin(), job.run->options.end());
            progress_.started(*job.run);
        }
        else
        {
            const std::size_t particles =
                std::clamp<std::size_t>(view_particles / jobs_.size(), 2000, 200000);
            words = {
                "report",      job.run->output,           "--picture",    job.run->output + ".png",
                "--data",      look_path(*job.run),       "--definition", name,
                "--particles", std::to_string(particles), "--threads",    threads,
                "--"};
            words.insert(words.end(), job.run->options.begin(), job.run->options.end());
        }
        job.child = std::make_unique<ChildProcess>(words, folder, log);
    }

    /// As they are before the run reads them: what changes meanwhile is found by the next batch.
    static void note_inputs(Job& job)
    {
        const std::string definition = job.run->definition + ".xml";
        std::vector<std::string> paths{definition};
        for (const auto& input : job.record.inputs)
            if (input.first != definition) paths.push_back(input.first);
        job.record.inputs.clear();
        for (const std::string& path : paths)
            if (is_file(path)) job.record.inputs.emplace_back(path, content_hash(path));
    }

    void take_result(Job& job)
    {
        const std::unique_ptr<ChildProcess> child = std::move(job.child);
        if (job.step == Step::Estimate)
            take_estimate(job, *child);
        else if (job.step == Step::Run)
            take_run(job, *child);
        else
            take_picture(job, *child);
    }

    void take_estimate(Job& job, const ChildProcess& child)
    {
        const std::string text = read_whole(job.estimate_file());
        fs::remove(job.estimate_file());
        job.step = Step::Run;
        if (child.exit_code() == 0)
        {
            read_estimate(text, job.record);
            progress_.estimated(*job.run, job.record);
        }
        if (only_estimates_)
        {
            job.step = Step::End;
            return;
        }
        if (is_stopped_)
        {
            job.record.state = RunState::Waiting;
            job.step = Step::End;
            return;
        }
        if (job.record.estimated_memory_bytes <= options_.memory_bytes) return;
        job.record.state = RunState::Refused;
        job.record.error = fmt::format(
            "needs about {:.2f} GB of memory, more than the {:.2f} GB that the batch may use; "
            "--memory allows more, {}",
            job.record.estimated_memory_bytes / 1e9, options_.memory_bytes / 1e9,
            what_fits(text, job.record.estimated_memory_bytes));
        note_inputs(job);
        finish(job);
    }

    /// The dp of an estimate with which memory would do: what grows are surfaces.
    std::string what_fits(const std::string& estimate, double needed) const
    {
        const double fixed = rates.base_bytes + rates.bytes_per_thread * options_.threads;
        if (options_.memory_bytes <= fixed) return "a larger dp needs less";
        const double dp = Json::parse(estimate).at("dp").get<double>();
        const double finer = std::sqrt((needed - fixed) / (options_.memory_bytes - fixed));
        return fmt::format("dp={:g} and larger ones fit", dp_rounded_up(dp * finer));
    }

    void take_run(Job& job, const ChildProcess& child)
    {
        std::string text = read_whole(job.log());
        std::erase(text, '\r'); // Windows ends lines with two characters
        RunRecord& record = job.record;
        record.np = 0;
        read_printed(text, record);
        record.exit_code = child.exit_code();
        record.seconds = child.seconds();
        record.memory_bytes = static_cast<double>(child.peak_bytes());
        const bool is_asked_to_stop =
            record.exit_code == 128 + SIGINT || record.exit_code == 128 + SIGTERM;
        if (is_asked_to_stop || is_stopped_)
        {
            record.state = RunState::Stopped;
        }
        else if (record.exit_code != 0)
        {
            record.state = RunState::Failed;
            if (record.error.empty())
                record.error =
                    record.exit_code > 128
                        ? fmt::format("ended by signal {}{}", record.exit_code - 128,
                                      record.exit_code == 137 ? ", perhaps for want of memory" : "")
                        : fmt::format("ended with exit code {}; {} holds its output",
                                      record.exit_code, job.log());
        }
        else
        {
            record.state = RunState::Done;
            fs::remove(job.log());
            record.outputs = list_outputs(*job.run);
            // Kept whatever becomes of the picture.
            write_record(*job.run, record);
            job.step = Step::Picture;
            if (wants_picture(job)) return;
        }
        finish(job);
    }

    /// A run is done without a picture too: -save:-bi leaves nothing to draw.
    void take_picture(Job& job, const ChildProcess& child)
    {
        if (child.exit_code() == 0)
            job.record.picture = fs::path(job.run->output + ".png").filename().string();
        fs::remove(job.log());
        write_record(*job.run, job.record);
        finish(job);
    }

    void finish(Job& job)
    {
        job.step = Step::End;
        if (job.record.state != RunState::Done && job.record.state != RunState::Waiting)
            write_record(*job.run, job.record);
        if (job.record.state != RunState::Waiting) progress_.finished(*job.run, job.record);
    }

    void stop()
    {
        const auto now = std::chrono::steady_clock::now();
        if (is_stopped_ && now < stopped_at_ + stop_interval) return;
        is_stopped_ = true;
        stopped_at_ = now;
        for (Job& job : jobs_)
        {
            if (job.child)
                job.child->stop();
            else if (job.step == Step::Picture)
                finish(job);
            else
                job.step = Step::End;
        }
    }

    const BatchOptions& options_;
    Progress& progress_;
    bool only_estimates_;
    std::string program_;
    std::vector<Job> jobs_;
    bool is_stopped_ = false;
    std::chrono::steady_clock::time_point stopped_at_;
};

} // namespace

std::vector<RunRecord> run_batch(const std::vector<BatchRun>& runs, const BatchOptions& options,
                                 Progress& progress)
{
    return Batch(runs, options, progress, false).work();
}

std::vector<RunRecord> estimate_runs(const std::vector<BatchRun>& runs, const BatchOptions& options,
                                     Progress& progress)
{
    return Batch(runs, options, progress, true).work();
}

} // namespace fppg
