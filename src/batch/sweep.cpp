#include "batch/sweep.h"

#include "core/text.h"
#include "fppg/error.h"
#include "platform/regular_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <fstream>
#include <set>

namespace fppg
{
namespace
{

namespace fs = std::filesystem;

constexpr std::string_view ending = "_Def.xml";

struct FoundCase
{
    fs::path file; ///< absolute, with extension
    std::string name;
};

bool is_dp(const std::string& name)
{
    return lower_case(name) == "dp";
}

/// Without ".xml" and "_Def". A star would stand for the name of the definition.
std::string case_name(const fs::path& file)
{
    std::string name = file.filename().string();
    for (const std::string_view tail : {std::string_view(".xml"), std::string_view("_Def")})
        if (name.size() > tail.size() && name.ends_with(tail))
            name.resize(name.size() - tail.size());
    std::replace(name.begin(), name.end(), '*', '_');
    // It names the folder of the results.
    if (name == "." || name == "..")
        throw CaseError(
            file.string(), 0,
            fmt::format("a case cannot be called '{}', which no new folder can be", name));
    return name;
}

std::vector<FoundCase> cases_of_folder(const fs::path& folder, const fs::path& out)
{
    std::vector<FoundCase> found;
    std::error_code error;
    fs::recursive_directory_iterator at(folder, fs::directory_options::skip_permission_denied,
                                        error);
    if (error)
        throw IoError(
            fmt::format("cannot read the folder '{}': {}", folder.string(), error.message()));
    for (; at != fs::recursive_directory_iterator(); at.increment(error))
    {
        std::error_code ignored;
        if (at->is_directory(ignored) && at->path() == out) at.disable_recursion_pending();
        const std::string name = at->path().filename().string();
        if (!at->is_regular_file(ignored) || !name.ends_with(ending) ||
            name.size() == ending.size())
            continue;
        const fs::path inside = at->path().lexically_relative(folder).parent_path();
        found.push_back({at->path(), (inside / case_name(at->path())).string()});
    }
    std::sort(found.begin(), found.end(),
              [](const FoundCase& a, const FoundCase& b) { return a.file < b.file; });
    return found;
}

std::vector<FoundCase> cases_of_list(const fs::path& list)
{
    expect_regular_file(list.string());
    std::ifstream in(list);
    if (!in) throw IoError(fmt::format("cannot read '{}'", list.string()));
    std::vector<FoundCase> found;
    std::string line;
    for (int number = 1; std::getline(in, line); ++number)
    {
        line = std::string(trimmed(line));
        if (line.empty() || line[0] == '#') continue;
        fs::path file = (list.parent_path() / line).lexically_normal();
        if (!file.string().ends_with(".xml")) file += ".xml";
        if (!fs::is_regular_file(file))
            throw IoError(
                fmt::format("{}:{}: there is no file '{}'", list.string(), number, file.string()));
        found.push_back({file, case_name(file)});
    }
    return found;
}

/// As part of a name of a folder.
std::string plain(const std::string& text)
{
    std::string out = text;
    for (char& c : out)
        if (std::isalnum(static_cast<unsigned char>(c)) == 0 &&
            std::string_view("._+-").find(c) == std::string_view::npos)
            c = '_';
    return out;
}

BatchRun run_of(const FoundCase& found, const fs::path& out,
                std::vector<std::pair<std::string, std::string>> settings,
                const std::vector<std::string>& options)
{
    BatchRun run;
    run.name = found.name;
    std::string evars;
    for (const auto& [name, value] : settings)
    {
        run.name.append("_").append(plain(name)).append(plain(value));
        if (is_dp(name))
            run.options.push_back("-dp:" + value);
        else
            evars.append(":").append(name).append("=").append(value);
    }
    if (!evars.empty()) run.options.push_back("-evars" + evars);
    run.options.insert(run.options.end(), options.begin(), options.end());
    run.definition = found.file.string().substr(0, found.file.string().size() - 4);
    run.output = (out / run.name / case_name(found.file)).string();
    run.settings = std::move(settings);
    return run;
}

} // namespace

SweepVariable parse_sweep(const std::string& text)
{
    const std::size_t equals = text.find('=');
    if (equals == 0 || equals == std::string::npos || equals + 1 == text.size())
        throw UsageError(fmt::format(
            "--set: \"{}\" is invalid, expected NAME=VALUE,VALUE such as Dp=0.01,0.005", text));
    SweepVariable out;
    out.name = text.substr(0, equals);
    for (std::size_t begin = equals + 1; begin <= text.size();)
    {
        const std::size_t end = std::min(text.find(',', begin), text.size());
        const std::string value = text.substr(begin, end - begin);
        if (value.empty() || value.find(':') != std::string::npos)
            throw UsageError(fmt::format(
                "--set: \"{}\" is invalid, expected values without ':' between commas", text));
        out.values.push_back(value);
        begin = end + 1;
    }
    return out;
}

std::vector<BatchRun> list_runs(const std::string& source, const std::string& out,
                                const std::vector<SweepVariable>& variables,
                                const std::vector<std::string>& options)
{
    for (std::size_t i = 0; i < variables.size(); ++i)
        for (std::size_t j = 0; j < i; ++j)
            if (variables[i].name == variables[j].name)
                throw UsageError(
                    fmt::format("--set: {} is given twice, expected once", variables[i].name));
    const fs::path path = fs::absolute(source).lexically_normal();
    std::vector<FoundCase> found;
    if (fs::is_directory(path))
        found = cases_of_folder(path.has_filename() ? path : path.parent_path(), out);
    else if (!fs::exists(path))
        throw IoError(fmt::format("there is no folder or file '{}'", source));
    else if (path.extension() == ".xml")
        found = {{path, case_name(path)}};
    else
        found = cases_of_list(path);
    if (found.empty())
        throw UsageError(
            fmt::format("{}: there is no case in it, expected files *_Def.xml or a "
                        "list of them",
                        source));
    std::size_t combinations = 1;
    for (const SweepVariable& variable : variables) combinations *= variable.values.size();
    std::vector<BatchRun> runs;
    std::set<std::string> names;
    for (const FoundCase& one : found)
        for (std::size_t c = 0; c < combinations; ++c)
        {
            std::vector<std::pair<std::string, std::string>> settings(variables.size());
            std::size_t rest = c;
            for (std::size_t v = variables.size(); v-- > 0;)
            {
                const std::size_t n = variables[v].values.size();
                settings[v] = {variables[v].name, variables[v].values[rest % n]};
                rest /= n;
            }
            BatchRun run = run_of(one, out, std::move(settings), options);
            // Cases of a list may have one name in several folders, and values that differ only in
            // odd characters one folder.
            const std::string name = run.name;
            for (int number = 2; !names.insert(run.name).second; ++number)
                run.name = fmt::format("{}_{}", name, number);
            run.output = (fs::path(out) / run.name / case_name(one.file)).string();
            runs.push_back(std::move(run));
        }
    return runs;
}

} // namespace fppg
