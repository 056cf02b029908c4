#include "batch/report.h"

#include "fppg/files.h"
#include "fppg/version.h"

#include "core/json.h"
#include "platform/file_map.h"
#include "report/html.h"
#include "report/result_look.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

namespace fppg
{
namespace
{

namespace fs = std::filesystem;
void write_text(const fs::path& path, const std::string& text)
{
    OutputFile file(path.string());
    file.append(text);
    file.commit();
}

/// A field of CSV: quoted where it has to be (RFC 4180).
std::string csv_field(const std::string& text)
{
    if (text.find_first_of(",\"\n\r") == std::string::npos) return text;
    std::string out = "\"";
    for (const char c : text) out += c == '"' ? "\"\"" : std::string(1, c);
    return out + "\"";
}

std::string to_csv(const std::vector<BatchRun>& runs, const std::vector<RunRecord>& records)
{
    std::string text = "run,definition";
    if (!runs.empty())
        for (const auto& setting : runs.front().settings)
            text.append(",").append(csv_field(setting.first));
    text +=
        ",state,particles,fixed,moving,floating,fluid,seconds,memory_mb,estimated_seconds,"
        "estimated_memory_mb,warnings,exit_code,error,output\n";
    for (std::size_t i = 0; i < runs.size(); ++i)
    {
        const RunRecord& r = records[i];
        text += csv_field(runs[i].name) + "," + csv_field(runs[i].definition + ".xml");
        for (const auto& setting : runs[i].settings)
            text.append(",").append(csv_field(setting.second));
        text += fmt::format(",{},{},{},{},{},{},{:.3f},{:.1f},{:.3f},{:.1f},{},{},{},{}\n",
                            name_of(r.state), r.np, r.n_fixed, r.n_moving, r.n_floating, r.n_fluid,
                            r.seconds, r.memory_bytes / 1e6, r.estimated_seconds,
                            r.estimated_memory_bytes / 1e6, r.warnings.size(), r.exit_code,
                            csv_field(r.error), csv_field(runs[i].output));
    }
    return text;
}

std::string to_json(const std::vector<BatchRun>& runs, const std::vector<RunRecord>& records)
{
    const BatchCounts counts = count_states(records);
    Json list = Json::array();
    for (std::size_t i = 0; i < runs.size(); ++i)
    {
        const RunRecord& r = records[i];
        Json settings = Json::object();
        for (const auto& [name, value] : runs[i].settings) settings[name] = value;
        list.push_back({{"run", runs[i].name},
                        {"definition", runs[i].definition + ".xml"},
                        {"output", runs[i].output},
                        {"settings", settings},
                        {"options", runs[i].options},
                        {"state", name_of(r.state)},
                        {"particles", r.np},
                        {"fixed", r.n_fixed},
                        {"moving", r.n_moving},
                        {"floating", r.n_floating},
                        {"fluid", r.n_fluid},
                        {"seconds", r.seconds},
                        {"memory_bytes", r.memory_bytes},
                        {"estimated_seconds", r.estimated_seconds},
                        {"estimated_memory_bytes", r.estimated_memory_bytes},
                        {"exit_code", r.exit_code},
                        {"warnings", r.warnings},
                        {"error", r.error}});
    }
    const Json json = {{"program", fmt::format("fppg {}", version)},
                       {"done", counts.done},
                       {"failed", counts.failed},
                       {"open", counts.open},
                       {"runs", list}};
    return json.text(1) + "\n";
}

ResultLook look_of(const BatchRun& run, const RunRecord& record)
{
    ResultLook look;
    if (record.state == RunState::Done && !record.picture.empty())
    {
        look = read_look(read_whole(look_path(run)));
        look.picture = read_whole((fs::path(run.output).parent_path() / record.picture).string());
        look.note = fmt::format(": {} particles", grouped_digits(record.np));
    }
    look.name = run.name;
    return look;
}

std::string to_html(const std::vector<BatchRun>& runs, const std::vector<RunRecord>& records)
{
    const BatchCounts counts = count_states(records);
    std::uint64_t particles = 0;
    double seconds = 0;
    for (const RunRecord& r : records)
    {
        if (r.state == RunState::Done) particles += r.np;
        seconds += r.seconds;
    }
    std::vector<ResultLook> looks;
    for (std::size_t i = 0; i < runs.size(); ++i) looks.push_back(look_of(runs[i], records[i]));
    std::string text = page_head("fppg batch");
    text += fmt::format(
        "<h1>{} runs: {} done, {} failed, {} open</h1>\n<p>{} particles, {:.1f} s of all runs "
        "together. fppg {}.</p>\n",
        runs.size(), counts.done, counts.failed, counts.open, grouped_digits(particles), seconds,
        version);
    text += pictures_html(looks);
    text +=
        "<h2>Runs</h2>\n<div class=\"scroll\"><table><thead><tr><th>run</th><th>state</th>"
        "<th>particles</th><th>fixed</th><th>moving</th><th>floating</th><th>fluid</th>"
        "<th>time</th><th>memory</th><th class=\"text\">warnings and errors</th></tr></thead>"
        "<tbody>\n";
    for (std::size_t i = 0; i < runs.size(); ++i)
    {
        const RunRecord& r = records[i];
        text += fmt::format("<tr><td>{}</td><td class=\"{}\">{}</td>", escaped_html(runs[i].name),
                            name_of(r.state), name_of(r.state));
        for (const std::uint64_t n : {r.np, r.n_fixed, r.n_moving, r.n_floating, r.n_fluid})
            text += fmt::format("<td>{}</td>", grouped_digits(n));
        text += fmt::format("<td>{:.2f} s</td><td>{:.0f} MB</td>", r.seconds, r.memory_bytes / 1e6);
        std::string notes = r.error;
        for (const std::string& warning : r.warnings)
            notes += (notes.empty() ? "" : "\n") + warning;
        text += fmt::format("<td class=\"text\"><div class=\"small\">{}</div></td></tr>\n",
                            escaped_html(notes));
    }
    text += "</tbody></table></div>\n";
    const bool has_views = std::any_of(looks.begin(), looks.end(),
                                       [](const ResultLook& look) { return !look.set.empty(); });
    if (has_views)
        text += "<h2>In space</h2>\n" + views_html(looks) + "<h2>Particles</h2>\n" +
                details_html(looks);
    return text + "</body></html>\n";
}

} // namespace

BatchCounts count_states(const std::vector<RunRecord>& records)
{
    BatchCounts counts;
    for (const RunRecord& r : records)
    {
        if (r.state == RunState::Done)
            ++counts.done;
        else if (r.state == RunState::Failed || r.state == RunState::Refused)
            ++counts.failed;
        else
            ++counts.open;
        if (r.is_reused) ++counts.reused;
    }
    return counts;
}

void write_summary(const std::string& folder, const std::vector<BatchRun>& runs,
                   const std::vector<RunRecord>& records)
{
    write_text(fs::path(folder) / "summary.csv", to_csv(runs, records));
    write_text(fs::path(folder) / "summary.json", to_json(runs, records));
    write_text(fs::path(folder) / "report.html", to_html(runs, records));
}

} // namespace fppg
