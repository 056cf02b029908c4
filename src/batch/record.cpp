#include "batch/record.h"

#include "fppg/error.h"
#include "fppg/files.h"
#include "fppg/version.h"

#include "batch/content_hash.h"
#include "core/json.h"
#include "platform/processes.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <filesystem>
#include <fstream>
#include <iterator>

namespace fppg
{
namespace
{

namespace fs = std::filesystem;
constexpr std::array<const char*, 5> state_names{"waiting", "done", "failed", "refused", "stopped"};

/// What follows `label`, a number with commas.
std::uint64_t number_after(std::string_view text, std::string_view label)
{
    const std::size_t at = text.find(label);
    if (at == std::string_view::npos) return 0;
    std::uint64_t n = 0;
    for (const char c : text.substr(at + label.size()))
    {
        if (c == ',') continue;
        if (std::isdigit(static_cast<unsigned char>(c)) == 0) break;
        n = n * 10 + static_cast<std::uint64_t>(c - '0');
    }
    return n;
}

} // namespace

const char* name_of(RunState state)
{
    return state_names[static_cast<std::size_t>(state)];
}

std::string program_identity()
{
    return fmt::format("fppg {} {}", version, content_hash(program_path()));
}

std::string record_path(const BatchRun& run)
{
    return run.output + ".batch.json";
}

std::string look_path(const BatchRun& run)
{
    return run.output + ".batch.look";
}

void write_record(const BatchRun& run, const RunRecord& record)
{
    Json inputs = Json::array();
    for (const auto& [path, hash] : record.inputs)
        inputs.push_back({{"path", path}, {"hash", hash}});
    Json outputs = Json::array();
    for (const auto& [name, bytes] : record.outputs)
        outputs.push_back({{"name", name}, {"bytes", bytes}});
    const Json json = {{"state", name_of(record.state)},
                       {"program", record.program},
                       {"options", record.options},
                       {"inputs", inputs},
                       {"outputs", outputs},
                       {"picture", record.picture},
                       {"particles", record.np},
                       {"fixed", record.n_fixed},
                       {"moving", record.n_moving},
                       {"floating", record.n_floating},
                       {"fluid", record.n_fluid},
                       {"seconds", record.seconds},
                       {"memory_bytes", record.memory_bytes},
                       {"estimated_seconds", record.estimated_seconds},
                       {"estimated_memory_bytes", record.estimated_memory_bytes},
                       {"exit_code", record.exit_code},
                       {"warnings", record.warnings},
                       {"error", record.error}};
    OutputFile file(record_path(run));
    file.append(json.text(1) + "\n");
    file.commit();
}

RunRecord read_record(const BatchRun& run)
{
    std::ifstream in(record_path(run));
    try
    {
        const Json json = Json::parse(in);
        RunRecord record;
        const auto state =
            std::find(state_names.begin(), state_names.end(), json.at("state").get<std::string>());
        if (state == state_names.end()) return {};
        record.state = static_cast<RunState>(state - state_names.begin());
        json.at("program").get_to(record.program);
        json.at("options").get_to(record.options);
        for (const Json& input : json.at("inputs").items())
            record.inputs.emplace_back(input.at("path").get<std::string>(),
                                       input.at("hash").get<std::string>());
        for (const Json& output : json.at("outputs").items())
            record.outputs.emplace_back(output.at("name").get<std::string>(),
                                        output.at("bytes").get<std::uint64_t>());
        json.at("picture").get_to(record.picture);
        json.at("particles").get_to(record.np);
        json.at("fixed").get_to(record.n_fixed);
        json.at("moving").get_to(record.n_moving);
        json.at("floating").get_to(record.n_floating);
        json.at("fluid").get_to(record.n_fluid);
        json.at("seconds").get_to(record.seconds);
        json.at("memory_bytes").get_to(record.memory_bytes);
        json.at("estimated_seconds").get_to(record.estimated_seconds);
        json.at("estimated_memory_bytes").get_to(record.estimated_memory_bytes);
        json.at("exit_code").get_to(record.exit_code);
        json.at("warnings").get_to(record.warnings);
        json.at("error").get_to(record.error);
        return record;
    }
    catch (const JsonError&)
    {
        return {};
    }
}

bool is_current(const BatchRun& run, const RunRecord& record, const std::string& program)
{
    if (record.state != RunState::Done || record.program != program ||
        record.options != run.options || record.inputs.empty() || record.outputs.empty())
        return false;
    for (const auto& [name, bytes] : record.outputs)
    {
        std::error_code error;
        const auto size = fs::file_size(fs::path(run.output).parent_path() / name, error);
        if (error || size != bytes) return false;
    }
    // The record may be that of another case of this name.
    if (record.inputs.front().first != run.definition + ".xml") return false;
    return std::all_of(record.inputs.begin(), record.inputs.end(),
                       [](const auto& input)
                       {
                           std::error_code error;
                           return fs::is_regular_file(input.first, error) &&
                                  content_hash(input.first) == input.second;
                       });
}

std::vector<std::pair<std::string, std::uint64_t>> list_outputs(const BatchRun& run)
{
    std::vector<std::pair<std::string, std::uint64_t>> out;
    const fs::path folder = fs::path(run.output).parent_path();
    const std::string own = fs::path(run.output).filename().string();
    for (const auto& entry : fs::recursive_directory_iterator(folder))
    {
        const fs::path name = entry.path().lexically_relative(folder);
        const std::string text = name.string();
        if (!entry.is_regular_file() || text.starts_with(own + ".batch.") || text == own + ".png" ||
            name.filename().string().find(".part-") != std::string::npos)
            continue;
        out.emplace_back(text, entry.file_size());
    }
    std::sort(out.begin(), out.end());
    return out;
}

void read_printed(const std::string& text, RunRecord& record)
{
    const std::size_t total = text.find("Total particles: ");
    if (total != std::string::npos)
    {
        const std::string_view line =
            std::string_view(text).substr(total, text.find('\n', total) - total);
        record.np = number_after(line, "Total particles: ");
        record.n_fixed = number_after(line, "fx=");
        record.n_moving = number_after(line, "mv=");
        record.n_floating = number_after(line, "ft=");
        record.n_fluid = number_after(line, "fluid=");
    }
    constexpr std::string_view warning = "*** WARNING: ";
    for (std::size_t at = text.find(warning); at != std::string::npos;)
    {
        const std::size_t begin = at + warning.size();
        const std::size_t end = std::min(text.find('\n', begin), text.size());
        record.warnings.push_back(text.substr(begin, end - begin));
        at = text.find(warning, end);
    }
    constexpr std::string_view error = "*** Error: ";
    const std::size_t at = text.find(error);
    if (at == std::string::npos) return;
    const std::size_t begin = at + error.size();
    const std::size_t end = std::min(text.find("\n\nFinished execution", begin), text.size());
    record.error = text.substr(begin, end - begin);
}

} // namespace fppg
