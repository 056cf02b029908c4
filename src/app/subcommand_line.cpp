#include "app/subcommand_line.h"

#include "fppg/error.h"

#include <fmt/format.h>

namespace fppg
{

bool read_subcommand_line(CLI::App& app, const std::vector<std::string>& arguments)
{
    try
    {
        app.parse(std::vector<std::string>(arguments.rbegin(), arguments.rend()));
    }
    catch (const CLI::CallForHelp&)
    {
        fmt::print("{}", app.help());
        return false;
    }
    catch (const CLI::ParseError& error)
    {
        throw UsageError(fmt::format("{}; {} --help shows the form", error.what(), app.get_name()));
    }
    return true;
}

} // namespace fppg
