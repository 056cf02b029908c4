#include "app/drawn_geometry.h"

#include "app/command_line.h"
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

TriangleSoup drawn_geometry(const std::string& definition, const std::vector<std::string>& of_run,
                            int threads)
{
    std::vector<std::string> words{definition};
    words.insert(words.end(), of_run.begin(), of_run.end());
    const DropInOptions run = parse_command_line(words);
    std::string name = run.input;
    if (name.ends_with(".xml")) name.resize(name.size() - 4);
    CaseOptions options;
    options.fit = run.fit;
    options.dp = run.dp;
    options.evars = run.evars;
    options.case_name = std::filesystem::path(name).filename().string();
    return wall_geometry(name + ".xml", options, threads);
}

} // namespace fppg
