#include "newcase/plan.h"

#include "core/text.h"
#include "fppg/error.h"
#include "fppg/shapes.h"
#include "meshes/mesh_formats.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <set>

namespace fppg
{

namespace
{

namespace fs = std::filesystem;

/// What meshes of parts end with; tables of heights are none.
bool is_part_file(const fs::path& path)
{
    const std::string ending = lower_case(path.extension().string());
    if (ending.size() < 2 || ending == ".csv") return false;
    return ending == ".stl" || mesh_format_of(path.string()) != MeshFormat::Stl;
}

void add_folder(const fs::path& folder, std::vector<fs::path>& files, CasePlan& plan)
{
    std::vector<fs::path> found;
    std::vector<std::string> others;
    for (const fs::directory_entry& entry : fs::directory_iterator(folder))
    {
        if (!entry.is_regular_file() || entry.path().filename().string().starts_with('.')) continue;
        if (is_part_file(entry.path()))
            found.push_back(entry.path());
        else
            others.push_back(entry.path().filename().string());
    }
    if (found.empty())
        throw UsageError(fmt::format("{}: holds no part, expected mesh files: {}", folder.string(),
                                     mesh_format_list()));
    std::sort(found.begin(), found.end());
    std::sort(others.begin(), others.end());
    files.insert(files.end(), found.begin(), found.end());
    if (!others.empty())
        plan.warnings.push_back(fmt::format("{}: these files are no parts and are left out: {}.",
                                            folder.string(), fmt::join(others, ", ")));
}

std::vector<fs::path> part_paths(CasePlan& plan)
{
    std::vector<fs::path> files;
    for (const std::string& input : plan.options->inputs)
    {
        std::error_code error;
        if (fs::is_directory(input, error))
            add_folder(input, files, plan);
        else
            files.emplace_back(input);
    }
    return files;
}

/// A name for commands and comments: letters, digits, _ and -.
std::string clean_name(const std::string& stem)
{
    std::string out;
    for (const char c : stem)
    {
        const bool is_plain = (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') ||
                              (c >= 'A' && c <= 'Z') || c == '_' || c == '-';
        out += is_plain ? c : '_';
    }
    while (out.find("--") != std::string::npos) out.replace(out.find("--"), 2, "-");
    return out.empty() ? "part" : out;
}

std::string relative_name(const fs::path& file, const std::string& definition)
{
    const fs::path folder = fs::absolute(definition).parent_path();
    const fs::path near = fs::absolute(file).lexically_normal().lexically_relative(
        folder.lexically_normal());
    return near.empty() ? fs::absolute(file).string() : near.generic_string();
}

/// The beginning of the file, in small letters: where exporters write what they are and in which
/// unit.
std::vector<std::string> comments_of(const fs::path& path)
{
    std::ifstream in(path, std::ios::binary);
    std::string text(2048, '\0');
    in.read(text.data(), static_cast<std::streamsize>(text.size()));
    text.resize(static_cast<std::size_t>(std::max<std::streamsize>(in.gcount(), 0)));
    // A binary file has only its title.
    const std::size_t end = text.find('\0');
    if (end != std::string::npos) text.resize(std::min<std::size_t>(end, 80));
    std::vector<std::string> out;
    for (const std::string_view line : split(lower_case(text), '\n'))
        if (out.size() < 20) out.emplace_back(trimmed(line));
    return out;
}

NewPart read_part(const fs::path& path, const NewCaseOptions& options)
{
    NewPart part;
    part.path = path.string();
    part.file = relative_name(path, options.output);
    part.format = mesh_format_of(part.path);
    MeshReading reading;
    reading.format = part.format;
    const MeshFile file = read_mesh_file(part.path, reading, options.threads);
    if (file.soup.size() == 0)
        throw GeometryError(
            fmt::format("{}: has no surface, only points or lines; expected the facets of a part",
                        part.path));
    try
    {
        part.mesh = repair_mesh(file.soup, {}, options.threads, part.report);
    }
    catch (const GeometryError& error)
    {
        throw GeometryError(fmt::format("{}: {}", part.path, error.what()));
    }
    part.comments = comments_of(path);
    return part;
}

} // namespace

void read_parts(CasePlan& plan)
{
    const std::vector<fs::path> files = part_paths(plan);
    if (files.empty()) throw UsageError("fppg new: expected mesh files or folders of them");
    constexpr std::size_t most_parts = 200;
    if (files.size() > most_parts)
        throw UsageError(fmt::format("{} parts, expected at most {}: each has an mk of its own",
                                     files.size(), most_parts));
    std::set<std::string> names;
    for (const fs::path& path : files)
    {
        NewPart part = read_part(path, *plan.options);
        const std::string stem = clean_name(path.stem().string());
        part.name = stem;
        for (int n = 2; !names.insert(lower_case(part.name)).second; ++n)
            part.name = fmt::format("{}_{}", stem, n);
        plan.parts.push_back(std::move(part));
    }
    for (std::size_t i = 0; i < plan.parts.size(); ++i)
        plan.parts[i].mkbound = static_cast<int>(i) + 1;
}

} // namespace fppg
