#include "app/subcommands.h"

#include <algorithm>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "app/inspect.h"
#include "app/threads.h"
#include "fppg/error.h"

namespace fppg
{

bool is_subcommand(const std::vector<std::string>& arguments)
{
    return !arguments.empty() && arguments.front() == "inspect";
}

int run_subcommand(const std::vector<std::string>& arguments)
{
    CLI::App app("particles for SPH from meshes and case definitions", "fppg");
    app.require_subcommand(1);

    InspectOptions inspect;
    bool as_json = false;
    CLI::App* const command = app.add_subcommand(
        "inspect",
        "Says what a mesh file holds, what is wrong with it, and how many particles it "
        "needs");
    command->add_option("mesh", inspect.path, "STL file, binary or ASCII")->required();
    command->add_option("--dp", inspect.dp, "particle distance, in the unit of the file")
        ->check(CLI::PositiveNumber);
    command->add_option("--angle", inspect.angle_deg, "feature angle, degrees")
        ->check(CLI::Range(0.0, 179.999))
        ->capture_default_str();
    command->add_option("--weld", inspect.weld_distance,
                        "weld vertices nearer than this, in the unit of the file");
    command->add_option("--threads", inspect.threads, "threads (0: what the machine allows)");
    command->add_flag("--json", as_json, "print JSON");

    std::vector<std::string> reversed(arguments.rbegin(), arguments.rend());
    try
    {
        app.parse(reversed);
    }
    catch (const CLI::CallForHelp&)
    {
        fmt::print("{}", command->help());
        return 0;
    }
    catch (const CLI::ParseError& error)
    {
        throw UsageError(
            fmt::format("{}; fppg {} --help shows the form", error.what(), arguments.front()));
    }
    if (inspect.threads <= 0) inspect.threads = default_threads();
    const Inspection inspection = inspect_mesh(inspect);
    fmt::print("{}", as_json ? to_json(inspection) : to_text(inspection));
    return 0;
}

} // namespace fppg
