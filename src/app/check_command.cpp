#include "app/check_command.h"

#include "app/subcommand_line.h"
#include "app/threads.h"
#include "fppg/check.h"
#include "fppg/error.h"
#include "fppg/files.h"

#include <fmt/format.h>

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
    app.add_option("CASE", call.case_name,
                   "without extension: Case.xml and Case.bi4; of vres one zone, as Case_vres01")
        .required();
    app.add_option("--json", call.json, "all numbers, as JSON");
    app.add_option("--vtk", call.vtk,
                   "the faulty particles; their array Fault says which fault, in the order of the "
                   "table from 0 on");
    app.add_flag("--strict", call.strict, "findings are errors");
    app.add_option("--threads", call.threads, "default 0: what the machine or its scheduler allows")
        .range(0, 4096);
    for (std::string& argument : arguments)
        if (argument == "-strict") argument = "--strict";
    if (!app.read(arguments)) return false;
    if (call.threads == 0) call.threads = default_threads();
    return true;
}

} // namespace

int run_check(const std::vector<std::string>& arguments)
{
    CheckCall call;
    if (!read_arguments(arguments, call)) return 0;
    // The files are made first: a folder that cannot be written is found before the work.
    std::optional<OutputFile> json;
    std::optional<OutputFile> vtk;
    if (!call.json.empty()) json.emplace(call.json);
    if (!call.vtk.empty()) vtk.emplace(call.vtk);
    const CheckReport report = check_case(call.case_name, call.threads);
    if (json)
    {
        json->append(to_json(report));
        json->commit();
    }
    if (vtk)
    {
        vtk->append(to_vtk(report));
        vtk->commit();
    }
    fmt::print("{}", to_text(report));
    if (call.strict && !report.is_clean())
        throw CaseError(
            fmt::format("--strict: '{}' has findings, which are errors", call.case_name));
    return 0;
}

} // namespace fppg
