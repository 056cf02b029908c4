#include "batch/report.h"

#include "fppg/files.h"
#include "fppg/version.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <filesystem>
#include <fstream>
#include <iterator>

namespace fppg
{
namespace
{

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

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
    return json.dump(1, ' ', false, Json::error_handler_t::replace) + "\n";
}

std::string html_text(const std::string& text)
{
    std::string out;
    for (const char c : text)
    {
        if (c == '<')
            out += "&lt;";
        else if (c == '>')
            out += "&gt;";
        else if (c == '&')
            out += "&amp;";
        else if (c == '"')
            out += "&quot;";
        else
            out += c;
    }
    return out;
}

std::string base64(const std::string& bytes)
{
    static constexpr char digits[] =
        "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string out;
    for (std::size_t i = 0; i < bytes.size(); i += 3)
    {
        const std::size_t n = std::min<std::size_t>(3, bytes.size() - i);
        unsigned three = 0;
        for (std::size_t k = 0; k < 3; ++k)
            three = three << 8U | (k < n ? static_cast<unsigned char>(bytes[i + k]) : 0U);
        for (std::size_t k = 0; k < 4; ++k)
            out += k <= n ? digits[three >> (18 - 6 * k) & 63U] : '=';
    }
    return out;
}

std::string picture_of(const BatchRun& run, const RunRecord& record)
{
    if (record.picture.empty()) return "";
    std::ifstream in(fs::path(run.output).parent_path() / record.picture, std::ios::binary);
    if (!in) return "";
    const std::string bytes((std::istreambuf_iterator<char>(in)), std::istreambuf_iterator<char>());
    return fmt::format("<img alt=\"{}\" src=\"data:image/png;base64,{}\">", html_text(run.name),
                       base64(bytes));
}

std::string grouped(std::uint64_t n)
{
    std::string text = std::to_string(n);
    for (auto at = static_cast<std::ptrdiff_t>(text.size()) - 3; at > 0; at -= 3)
        text.insert(static_cast<std::size_t>(at), 1, ',');
    return text;
}

constexpr const char* head = R"(<!DOCTYPE html>
<html lang="en"><head><meta charset="utf-8"><title>fppg batch</title>
<style>
body { font: 15px/1.4 system-ui, sans-serif; margin: 2em; color: #222; }
table { border-collapse: collapse; }
th, td { padding: 4px 10px; border-bottom: 1px solid #ddd; text-align: left; vertical-align: top; }
td.n { text-align: right; font-variant-numeric: tabular-nums; white-space: nowrap; }
img { width: 240px; height: 180px; }
.done { color: #17692b; } .failed, .refused { color: #b3261e; } .stopped, .waiting { color: #8a5a00; }
.small { font-size: 13px; max-width: 40em; white-space: pre-wrap; }
@media (prefers-color-scheme: dark) {
  body { background: #1b1b1b; color: #ddd; } th, td { border-color: #444; }
  .done { color: #7cc58d; } .failed, .refused { color: #f2958e; } .stopped, .waiting { color: #e0b45c; }
}
</style></head><body>
)";

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
    std::string text = head;
    text += fmt::format(
        "<h1>{} runs: {} done, {} failed, {} open</h1>\n<p>{} particles, {:.1f} s of all runs "
        "together. fppg {}.</p>\n",
        runs.size(), counts.done, counts.failed, counts.open, grouped(particles), seconds, version);
    text +=
        "<table><thead><tr><th></th><th>run</th><th>state</th><th>particles</th><th>fixed</th>"
        "<th>moving</th><th>floating</th><th>fluid</th><th>time</th><th>memory</th>"
        "<th>warnings and errors</th></tr></thead><tbody>\n";
    for (std::size_t i = 0; i < runs.size(); ++i)
    {
        const RunRecord& r = records[i];
        text += fmt::format("<tr><td>{}</td><td>{}</td><td class=\"{}\">{}</td>",
                            picture_of(runs[i], r), html_text(runs[i].name), name_of(r.state),
                            name_of(r.state));
        for (const std::uint64_t n : {r.np, r.n_fixed, r.n_moving, r.n_floating, r.n_fluid})
            text += fmt::format("<td class=\"n\">{}</td>", grouped(n));
        text += fmt::format("<td class=\"n\">{:.2f} s</td><td class=\"n\">{:.0f} MB</td>",
                            r.seconds, r.memory_bytes / 1e6);
        std::string notes = r.error;
        for (const std::string& warning : r.warnings)
            notes += (notes.empty() ? "" : "\n") + warning;
        text += fmt::format("<td class=\"small\">{}</td></tr>\n", html_text(notes));
    }
    return text + "</tbody></table>\n</body></html>\n";
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
