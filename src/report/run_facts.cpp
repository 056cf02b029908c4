#include "report/run_facts.h"

#include "core/text.h"
#include "platform/regular_file.h"
#include "report/html.h"

#include <fmt/format.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>

namespace fppg
{

RunFacts read_run_facts(std::string_view text)
{
    constexpr std::string_view warning = "*** WARNING: ";
    constexpr std::string_view end_of_stage = "-End  time:";
    constexpr std::string_view all = "Time of execution: ";
    RunFacts facts;
    for (const std::string_view part : split(text, '\n'))
    {
        // GenCase for Windows ends lines with CR and LF.
        const std::string line(part.substr(0, part.find('\r')));
        const std::size_t stage = line.find(end_of_stage);
        if (line.starts_with(warning))
            facts.warnings.push_back(line.substr(warning.size()));
        else if (line.starts_with('[') && stage != std::string::npos)
            facts.stages.emplace_back(
                line.substr(1, stage - 1),
                std::strtod(line.c_str() + stage + end_of_stage.size(), nullptr));
        else if (line.starts_with(all))
            facts.seconds = std::strtod(line.c_str() + all.size(), nullptr);
    }
    return facts;
}

std::optional<RunFacts> facts_of_result(const std::string& path)
{
    std::string stem = path;
    for (const std::string_view ending : {".bi4", ".xml", ".vtk", "_All"})
        if (stem.ends_with(ending)) stem.erase(stem.size() - ending.size());
    expect_regular_file(stem + ".out");
    std::ifstream in(std::filesystem::path(stem + ".out"), std::ios::binary);
    if (!in) return std::nullopt;
    return read_run_facts(std::string((std::istreambuf_iterator<char>(in)), {}));
}

std::string run_facts_html(const RunFacts& facts)
{
    std::string html = "<p>";
    for (const auto& [name, seconds] : facts.stages)
        html += fmt::format("{} {:.3f} s, ", escaped_html(name), seconds);
    html += fmt::format("all {:.3f} s</p>\n", facts.seconds);
    if (facts.warnings.empty()) return html;
    html += "<ul>";
    for (const std::string& text : facts.warnings)
        html += fmt::format("<li>{}</li>", escaped_html(text));
    return html + "</ul>\n";
}

} // namespace fppg
