#include "meshes/read_step.h"

#include "core/plugin.h"
#include "core/text.h"
#include "fppg/error.h"
#include "meshes/step_plugin.h"

#include <fmt/format.h>

#include <filesystem>

namespace fppg
{

namespace
{

namespace fs = std::filesystem;

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
    static const auto read = reinterpret_cast<FppgReadStep>(
        plugin_function("libfppg_step.so", FPPG_READ_STEP,
                        "STEP files are read by it; it is built where OpenCASCADE is "
                        "(libocct-data-exchange-dev). Export the parts as STL, or build it"));
    std::vector<StepPart> out;
    const std::string fault = read(path.c_str(), deflection_mm, angle_rad, &out, take_part);
    if (!fault.empty()) throw GeometryError(fmt::format("{}: {}", path, fault));
    if (out.empty()) throw GeometryError(fmt::format("{}: holds no solid and no shell", path));
    return out;
}

} // namespace fppg
