#include "app/check_command.h"

#include "app/subcommand_line.h"
#include "app/threads.h"
#include "batch/estimate.h"
#include "core/json.h"
#include "fppg/check.h"
#include "fppg/error.h"
#include "fppg/files.h"
#include "fppg/motion_gaps.h"

#include <fmt/format.h>

#include <filesystem>
#include <optional>

namespace fppg
{

namespace
{

struct CheckCall
{
    std::string case_name;
    std::string json;
    std::string vtk;
    bool strict = false;
    int threads = 0;
    bool follows_motion = false;
    std::string definition; ///< of the motion
    std::string passages;   ///< a VTK file
    MotionGapOptions gaps;
};

/// Reads the arguments; false when only the help was asked for.
bool read_arguments(std::vector<std::string> arguments, CheckCall& call)
{
    SubcommandLine app(
        "Judges a written case, ours or GenCase's, as the solver v5.4 would: normals and ghost "
        "nodes "
        "for mDBC with the cavity full of fluid, walls that are too thin, fluid and particles that "
        "stand too close, particles outside the domain. Exit code: 0, or 3 with --strict where "
        "there are findings.",
        "fppg check");
    std::string evars;
    app.add_option("CASE", call.case_name,
                   "without extension: Case.xml and Case.bi4; of vres one zone, as Case_vres01")
        .required();
    app.add_option("--json", call.json, "all numbers, as JSON");
    app.add_option("--vtk", call.vtk,
                   "the faulty particles; their array Fault says which fault, in the order of the "
                   "table from 0 on");
    app.add_flag("--strict", call.strict, "findings are errors");
    app.add_flag("--motion", call.follows_motion,
                 "the least gap of every two mks through the motion, and narrow passages, by the "
                 "true shapes; CASE may be a definition, of which no particles are there yet");
    app.add_option("--definition", call.definition,
                   "of --motion: Case_Def.xml, where the meshes are not beside Case.xml");
    app.add_option("--evars", evars, "of --motion: as -evars: of the generation, A=1:B=2");
    app.add_option("--dp", call.gaps.dp, "of --motion: in place of the case's, metres").positive();
    app.add_option("--end", call.gaps.end, "of --motion: in place of TimeMax, seconds").positive();
    app.add_option("--step", call.gaps.step_dp,
                   "of --motion: how far parts move between two looks, dp")
        .positive()
        .shows_default();
    app.add_option("--passages", call.passages, "of --motion: narrow places as points, .vtk");
    app.add_option("--threads", call.threads, "default 0: what the machine or its scheduler allows")
        .range(0, 4096);
    for (std::string& argument : arguments)
        if (argument == "-strict") argument = "--strict";
    if (!app.read(arguments)) return false;
    if (call.threads == 0) call.threads = default_threads();
    call.gaps.evars = read_evars(evars);
    call.gaps.threads = call.threads;
    const bool is_of_motion = !call.definition.empty() || !evars.empty() || call.gaps.dp > 0 ||
                              call.gaps.end > 0 || !call.passages.empty();
    if (is_of_motion && !call.follows_motion)
        throw UsageError(
            "--definition, --evars, --dp, --end and --passages are for --motion; expected it too");
    return true;
}

/// Whether particles of the case are there: else its name is that of a definition.
bool has_particles(const std::string& name)
{
    std::error_code ignored;
    return !name.ends_with(".xml") && std::filesystem::exists(name + ".bi4", ignored);
}

/// The particles of a case at its dp, for what another dp would cost.
void count_particles(const std::string& definition, const CheckCall& call, MotionGaps& gaps)
{
    EstimateOptions options;
    options.case_options.dp = gaps.dp;
    options.case_options.evars = call.gaps.evars;
    options.threads = call.threads;
    try
    {
        const Estimate found = estimate_case(definition, options);
        gaps.wall_particles = static_cast<double>(found.n_fixed + found.n_moving);
        gaps.volume_particles = static_cast<double>(found.n_fluid + found.n_floating);
    }
    catch (const Error& error)
    {
        gaps.notes.push_back(
            fmt::format("The particles of a smaller dp were not counted: {}", error.what()));
    }
}

/// Gaps through the motion of the case.
MotionGaps gaps_of(const CheckCall& call)
{
    std::string definition = call.definition.empty() ? call.case_name : call.definition;
    if (!definition.ends_with(".xml")) definition += ".xml";
    MotionGaps gaps = measure_motion_gaps(definition, call.gaps);
    if (gaps.resolving_factor() > 1) count_particles(definition, call, gaps);
    return gaps;
}

void write_text_file(const std::string& path, const std::string& text)
{
    OutputFile file(path);
    file.append(text);
    file.commit();
}

/// What overlaps or is nearer than 2 dp while it moves.
bool are_clear(const MotionGaps& gaps)
{
    return std::none_of(gaps.pairs.begin(), gaps.pairs.end(),
                        [](const MkGap& pair)
                        { return pair.moves && (pair.overlapping > 0 || pair.least_dp < 2); });
}

} // namespace

int run_check(const std::vector<std::string>& arguments)
{
    CheckCall call;
    if (!read_arguments(arguments, call)) return 0;
    if (call.follows_motion && !has_particles(call.case_name))
    {
        if (!call.vtk.empty())
            throw UsageError("--vtk: there are no particles; --passages is for narrow passages");
        const MotionGaps gaps = gaps_of(call);
        if (!call.json.empty()) write_text_file(call.json, to_json(gaps));
        if (!call.passages.empty()) write_text_file(call.passages, to_vtk(gaps));
        fmt::print("{}", to_text(gaps));
        if (call.strict && !are_clear(gaps))
            throw CaseError(
                fmt::format("--strict: '{}' has findings, which are errors", call.case_name));
        return 0;
    }
    // The files are made first: a folder that cannot be written is found before the work.
    std::optional<OutputFile> json;
    std::optional<OutputFile> vtk;
    if (!call.json.empty()) json.emplace(call.json);
    if (!call.vtk.empty()) vtk.emplace(call.vtk);
    const CheckReport report = check_case(call.case_name, call.threads);
    if (vtk)
    {
        vtk->append(to_vtk(report));
        vtk->commit();
    }
    fmt::print("{}", to_text(report));
    bool is_clean = report.is_clean();
    std::string numbers = to_json(report);
    if (call.follows_motion)
    {
        const MotionGaps gaps = gaps_of(call);
        if (!call.passages.empty()) write_text_file(call.passages, to_vtk(gaps));
        fmt::print("{}", to_text(gaps));
        is_clean = is_clean && are_clear(gaps);
        Json both = Json::parse(numbers);
        both["motion"] = Json::parse(to_json(gaps));
        numbers = both.text(2) + "\n";
    }
    if (json)
    {
        json->append(numbers);
        json->commit();
    }
    if (call.strict && !is_clean)
        throw CaseError(
            fmt::format("--strict: '{}' has findings, which are errors", call.case_name));
    return 0;
}

} // namespace fppg
