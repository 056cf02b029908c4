#include "app/leak_command.h"

#include "app/subcommand_line.h"
#include "app/threads.h"
#include "fppg/error.h"
#include "fppg/files.h"
#include "leak/leak.h"

#include <fmt/format.h>
#include <optional>

namespace fppg
{

namespace
{

struct LeakCall
{
    std::string case_name;
    std::vector<std::string> parts;
    std::string json;
    std::string plot;
    LeakOptions options;
};

/// Reads the arguments; false when only the help was asked for.
bool read_arguments(const std::vector<std::string>& arguments, LeakCall& call)
{
    SubcommandLine app(
        "Counts fluid particles inside solids and outside a closed housing in the output of "
        "DualSPHysics, by the true shapes of the case; shapes that move are put where their "
        "particles are. Exit code: 0 there are none at any time, 1 there are.",
        "fppg leak");
    std::string evars;
    app.add_option("CASE", call.case_name,
                   "the case that the solver was given, without extension: Case.xml and Case.bi4")
        .required();
    app.add_option("PARTS", call.parts, "outputs Part_XXXX.bi4, or the folder that holds them")
        .required()
        .expected(1, -1);
    app.add_option("--json", call.json, "all numbers, as JSON");
    app.add_option("--plot", call.plot, "a plot over time, .svg");
    app.add_option("--definition", call.options.definition,
                   "Case_Def.xml, where the meshes are not beside Case.xml");
    app.add_option("--evars", evars, "as -evars: of the generation, A=1:B=2");
    app.add_option("--tolerance", call.options.tolerance_dp,
                   "a particle is inside when it is deeper than this, dp")
        .not_negative()
        .shows_default();
    app.add_option("--threads", call.options.threads,
                   "default 0: what the machine or its scheduler allows")
        .range(0, 4096);
    call.options.threads = 0;
    if (!app.read(arguments)) return false;
    call.options.evars = read_evars(evars);
    if (!call.plot.empty() && !call.plot.ends_with(".svg"))
        throw UsageError(
            fmt::format("--plot: \"{}\" is invalid, expected a name that ends in .svg", call.plot));
    if (call.options.threads == 0) call.options.threads = default_threads();
    return true;
}

} // namespace

int run_leak(const std::vector<std::string>& arguments)
{
    LeakCall call;
    if (!read_arguments(arguments, call)) return 0;
    // The files are made first: a folder that cannot be written is found before the work.
    std::optional<OutputFile> json;
    std::optional<OutputFile> plot;
    if (!call.json.empty()) json.emplace(call.json);
    if (!call.plot.empty()) plot.emplace(call.plot);
    const LeakReport report = count_leaks(call.case_name, call.parts, call.options);
    if (json)
    {
        json->append(to_json(report));
        json->commit();
    }
    if (plot)
    {
        plot->append(to_svg(report));
        plot->commit();
    }
    fmt::print("{}", to_text(report));
    return report.is_tight() ? 0 : 1;
}

} // namespace fppg
