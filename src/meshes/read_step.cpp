#include "meshes/read_step.h"

#include "core/text.h"
#include "fppg/error.h"
#include "meshes/step_plugin.h"

#include <dlfcn.h>
#include <fmt/format.h>

#include <filesystem>

namespace fppg
{

namespace
{

namespace fs = std::filesystem;

constexpr const char* plugin_file = "libfppg_step.so";

/// Beside the program, where a build has it, and where an installation puts it.
std::vector<fs::path> plugin_places()
{
    std::error_code error;
    const fs::path folder = fs::read_symlink("/proc/self/exe", error).parent_path();
    std::vector<fs::path> out{folder / plugin_file, folder / "../lib/fppg" / plugin_file};
#ifdef FPPG_PLUGIN_FOLDER
    out.emplace_back(fs::path(FPPG_PLUGIN_FOLDER) / plugin_file);
#endif
    return out;
}

FppgReadStep plugin()
{
    std::string looked_at;
    for (const fs::path& place : plugin_places())
    {
        std::error_code ignored;
        if (!fs::exists(place, ignored))
        {
            looked_at += fmt::format("{}{}", looked_at.empty() ? "" : ", ",
                                     place.lexically_normal().string());
            continue;
        }
        void* library = ::dlopen(place.c_str(), RTLD_NOW | RTLD_LOCAL);
        if (library == nullptr)
            throw IoError(fmt::format("cannot open the plugin that reads STEP: {}", ::dlerror()));
        if (void* symbol = ::dlsym(library, FPPG_READ_STEP))
            return reinterpret_cast<FppgReadStep>(symbol);
        throw IoError(fmt::format("{}: is no plugin of this version", place.string()));
    }
    throw IoError(fmt::format(
        "STEP files are read by a plugin, {}, which is built where OpenCASCADE is "
        "(libocct-data-exchange-dev); it is not at {}. Export the parts as STL, or build it",
        plugin_file, looked_at));
}

void take_part(void* to, const FppgStepPart* part)
{
    StepPart out;
    out.name = part->name;
    out.volume = part->volume;
    out.area = part->area;
    out.sharp_edges = part->sharp_edges;
    out.smooth_edges = part->smooth_edges;
    for (std::size_t c = 0; c < 3 * part->facet_count; ++c)
    {
        const double* p = part->points + 3 * std::size_t{part->corners[c]};
        out.soup.vertices.push_back({p[0], p[1], p[2]});
    }
    static_cast<std::vector<StepPart>*>(to)->push_back(std::move(out));
}

} // namespace

bool is_step_file(const std::string& path)
{
    const std::string ending = lower_case(fs::path(path).extension().string());
    return ending == ".step" || ending == ".stp";
}

std::vector<StepPart> read_step(const std::string& path, double deflection_mm, double angle_rad)
{
    std::error_code ignored;
    if (!fs::is_regular_file(path, ignored))
        throw IoError(fmt::format("cannot open '{}': no such file", path));
    const FppgReadStep read = plugin();
    std::vector<StepPart> out;
    const std::string fault = read(path.c_str(), deflection_mm, angle_rad, &out, take_part);
    if (!fault.empty()) throw GeometryError(fmt::format("{}: {}", path, fault));
    if (out.empty()) throw GeometryError(fmt::format("{}: holds no solid and no shell", path));
    return out;
}

} // namespace fppg
