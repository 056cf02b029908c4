#include "app/drawn_geometry.h"

#include "batch/wall_geometry.h"

#include <algorithm>
#include <filesystem>

namespace fppg
{

std::vector<std::string> take_run_options(std::vector<std::string>& arguments)
{
    const auto divider = std::find(arguments.begin(), arguments.end(), "--");
    if (divider == arguments.end()) return {};
    std::vector<std::string> out(divider + 1, arguments.end());
    arguments.erase(divider, arguments.end());
    return out;
}

DropInOptions parse_definition(const std::string& definition,
                               const std::vector<std::string>& of_run)
{
    std::vector<std::string> words{definition};
    words.insert(words.end(), of_run.begin(), of_run.end());
    DropInOptions run = parse_command_line(words);
    if (run.input.ends_with(".xml")) run.input.resize(run.input.size() - 4);
    return run;
}

TriangleSoup drawn_geometry(const std::string& definition, const std::vector<std::string>& of_run,
                            int threads)
{
    const DropInOptions run = parse_definition(definition, of_run);
    CaseOptions options;
    options.fit = run.fit;
    options.dp = run.dp;
    options.evars = run.evars;
    options.case_name = std::filesystem::path(run.input).filename().string();
    return wall_geometry(run.input + ".xml", options, threads);
}

} // namespace fppg
