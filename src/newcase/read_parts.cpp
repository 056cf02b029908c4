#include "newcase/plan.h"

#include "core/text.h"
#include "fppg/error.h"
#include "fppg/shapes.h"
#include "meshes/mesh_formats.h"
#include "meshes/read_step.h"

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
    if (is_step_file(path.string())) return true;
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
        throw UsageError(fmt::format("{}: holds no part, expected STEP or mesh files: {}",
                                     folder.string(), mesh_format_list()));
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
        if (input.empty())
            throw UsageError("fppg new: a part without a name, expected a file or a folder");
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
    const fs::path near =
        fs::absolute(file).lexically_normal().lexically_relative(folder.lexically_normal());
    return near.empty() ? fs::absolute(file).string() : near.generic_string();
}

/// The beginning of the file, in small letters: where exporters write what they are and in which
/// unit.
std::vector<std::string> comments_of(const fs::path& path)
{
    std::ifstream in(std::filesystem::path(path), std::ios::binary);
    std::string text(2048, '\0');
    in.read(text.data(), static_cast<std::streamsize>(text.size()));
    text.resize(static_cast<std::size_t>(std::max<std::streamsize>(in.gcount(), 0)));
    // A binary file has only its title.
    const std::size_t end = text.find('\0');
    if (end != std::string::npos) text.resize(std::min<std::size_t>(end, 80));
    text = lower_case(text);
    std::vector<std::string> out;
    for (const std::string_view line : split(text, '\n'))
        if (out.size() < 20) out.emplace_back(trimmed(line));
    return out;
}

void take_in(NewPart& part, const TriangleSoup& soup, int threads)
{
    try
    {
        part.mesh = repair_mesh(soup, {}, threads, part.report);
    }
    catch (const GeometryError& error)
    {
        throw GeometryError(fmt::format("{}: {}", part.path, error.what()));
    }
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
        throw GeometryError(fmt::format(
            "{}: has no surface, only points or lines; expected the facets of a part", part.path));
    take_in(part, file.soup, options.threads);
    part.comments = comments_of(path);
    return part;
}

/// Gives a part a name that no other one has.
void name_part(NewPart& part, const std::string& stem, std::set<std::string>& names)
{
    part.name = stem;
    for (int n = 2; !names.insert(lower_case(part.name)).second; ++n)
        part.name = fmt::format("{}_{}", stem, n);
}

/// The name by which `fppg:part` asks for one part of a file.
std::string part_reference(const std::vector<CadPart>& parts, std::size_t index)
{
    const std::string& name = parts[index].name;
    if (name.empty()) return fmt::format("#{}", index + 1);
    std::size_t same = 0, before = 0;
    for (std::size_t i = 0; i < parts.size(); ++i)
    {
        const std::vector<std::string>& path = parts[i].path;
        if (std::find(path.begin(), path.end(), name) == path.end()) continue;
        ++same;
        if (i <= index) ++before;
    }
    return same == 1 ? name : fmt::format("{}#{}", name, before);
}

void add_step_parts(const fs::path& path, CasePlan& plan, std::set<std::string>& names)
{
    const std::vector<CadPart> parts = step_parts(path.string());
    for (std::size_t i = 0; i < parts.size(); ++i)
    {
        NewPart part;
        name_part(part, clean_name(parts[i].name.empty() ? path.stem().string() : parts[i].name),
                  names);
        part.path = path.string();
        part.file = relative_name(path, plan.options->output);
        part.format = MeshFormat::Step;
        part.step_part = part_reference(parts, i);
        MeshReading reading;
        reading.format = part.format;
        reading.parts = part.step_part;
        const MeshFile file = read_step(part.path, reading);
        const CadPart& found = file.cad->parts.front();
        part.step_facts =
            fmt::format("{} CAD edges that bend, {} tangent ones; exact area {:.9g} m2{}",
                        found.sharp_edges, found.smooth_edges, found.area,
                        found.volume > 0 ? fmt::format(", volume {:.9g} m3", found.volume) : "");
        take_in(part, file.soup, plan.options->threads);
        plan.parts.push_back(std::move(part));
    }
}

} // namespace

void read_parts(CasePlan& plan)
{
    const std::vector<fs::path> files = part_paths(plan);
    if (files.empty()) throw UsageError("fppg new: expected mesh files or folders of them");
    constexpr std::size_t most_parts = 200;
    std::set<std::string> names;
    for (const fs::path& path : files)
    {
        if (is_step_file(path.string()))
        {
            add_step_parts(path, plan, names);
            continue;
        }
        NewPart part = read_part(path, *plan.options);
        name_part(part, clean_name(path.stem().string()), names);
        plan.parts.push_back(std::move(part));
    }
    if (plan.parts.size() > most_parts)
        throw UsageError(fmt::format("{} parts, expected at most {}: each has an mk of its own",
                                     plan.parts.size(), most_parts));
    for (std::size_t i = 0; i < plan.parts.size(); ++i)
        plan.parts[i].mkbound = static_cast<int>(i) + 1;
}

} // namespace fppg
