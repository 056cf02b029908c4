#include "app/estimate_command.h"

#include "app/command_line.h"
#include "app/measure_speed.h"
#include "app/stage_bar.h"
#include "app/threads.h"
#include "batch/estimate.h"
#include "batch/machine_speed.h"
#include "fppg/error.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>

namespace fppg
{

int run_estimate(const std::vector<std::string>& arguments)
{
    const auto asks = [](const std::string& a) { return a == "-h" || a == "--help"; };
    if (arguments.empty() || std::any_of(arguments.begin(), arguments.end(), asks))
    {
        fmt::print(
            "Says how many particles a case gives and what memory and time it needs, without "
            "writing anything.\n"
            "\n"
            "Usage:\n"
            "  fppg estimate DEFINITION [--json] [options]   fppg estimate Case_Def -dp:0.005\n"
            "  fppg estimate --calibrate                     measures this machine, in two "
            "seconds\n"
            "\n"
            "The options are those of a run: -dp, -evars, -fit, -save, -threads. Counts are exact, "
            "but for\n"
            "body-fitted walls; memory and time are estimates. --json prints one JSON object.\n"
            "--calibrate keeps how fast this machine is in the user's settings, for all later "
            "estimates.\n");
        return 0;
    }
    if (arguments == std::vector<std::string>{"--calibrate"})
    {
        const MachineSpeed speed = keep_machine_speed(measure_speed());
        fmt::print(
            "Body-fitting takes {:.2f} times as long here as on the machine that estimates "
            "were made for; kept in {}.\n",
            speed.factor, speed.file);
        return 0;
    }
    std::vector<std::string> of_run = arguments;
    const bool as_json = std::erase(of_run, "--json") > 0;
    DropInOptions run = parse_command_line(of_run);
    if (run.action != DropInOptions::Action::Run || run.input != run.output)
        throw UsageError("expected the name of one case definition; see fppg estimate --help");
    EstimateOptions options;
    options.case_options = case_options(run);
    options.threads = run.threads > 0 ? run.threads : default_threads();
    options.saves_bi4 = run.save_bi4;
    options.saves_all = run.save_all;
    options.saves_parts = run.save_bound || run.save_fluid;
    std::optional<StageBar> bar(std::in_place, "estimate");
    const Estimate estimate = estimate_case(run.input + ".xml", options);
    bar.reset();
    fmt::print("{}", as_json ? to_json(estimate) : to_text(estimate));
    return 0;
}

} // namespace fppg
