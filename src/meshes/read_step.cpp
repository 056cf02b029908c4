#include "meshes/read_step.h"

#include "core/plugin.h"
#include "core/text.h"
#include "fppg/error.h"
#include "meshes/step_plugin.h"
#include "platform/regular_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <mutex>
#include <set>

namespace fppg
{

namespace
{

namespace fs = std::filesystem;

/// The plugin has millimetres.
Vec3 metres(const double* mm)
{
    return {mm[0] / 1000, mm[1] / 1000, mm[2] / 1000};
}

const FppgStep& step_plugin()
{
    static const FppgStep* const plugin = reinterpret_cast<FppgStepEntry>(plugin_function(
        "libfppg_step.so", FPPG_STEP_ENTRY,
        "STEP files are read by it; it is built where OpenCASCADE is "
        "(libocct-data-exchange-dev), and not on Windows. Export the parts as STL, or build it"))();
    return *plugin;
}

/// An open file, as long as anything needs its exact faces.
class StepFile
{
public:
    explicit StepFile(const std::string& path) : path_(path)
    {
        const char* fault = "";
        file_ = step_plugin().open(path.c_str(), &fault);
        if (file_ == nullptr) throw GeometryError(fmt::format("{}: {}", path, fault));
        for (std::size_t i = 0; i < step_plugin().part_count(file_); ++i)
        {
            FppgStepPart found{};
            step_plugin().part(file_, i, &found);
            CadPart& part = parts_.emplace_back();
            part.name = found.name;
            for (const std::string_view name : split(found.path, '\n'))
                if (!name.empty()) part.path.emplace_back(name);
            if (found.has_color == 0) continue;
            part.color.emplace();
            for (std::size_t c = 0; c < 3; ++c)
                (*part.color)[c] = static_cast<std::uint8_t>(
                    std::lround(255 * std::clamp(found.color[c], 0.0, 1.0)));
        }
    }
    ~StepFile() { step_plugin().close(file_); }
    StepFile(const StepFile&) = delete;
    StepFile& operator=(const StepFile&) = delete;

    const std::vector<CadPart>& parts() const { return parts_; }

    void mesh(std::size_t index, double deflection, CadFacets& out)
    {
        out.parts.push_back(parts_[index]);
        const char* fault =
            step_plugin().mesh(file_, index, 1000 * deflection, step_angle, &out, take_mesh);
        if (*fault != '\0')
            throw GeometryError(
                fmt::format("{}: the part '{}': {}", path_, parts_[index].name, fault));
        for (std::size_t f = out.is_plane.size(); f < out.face.size(); ++f)
            out.is_plane.push_back(step_plugin().is_plane(file_, out.face[f]) != 0 ? 1 : 0);
    }

    FacePoint at(std::uint32_t face, double u, double v) const
    {
        std::array<double, 18> p{};
        step_plugin().surface(file_, face, u, v, p.data());
        return {metres(&p[0]), metres(&p[3]),  metres(&p[6]),
                metres(&p[9]), metres(&p[12]), metres(&p[15])};
    }

private:
    static void take_mesh(void* to, const FppgStepMesh* mesh)
    {
        CadFacets& out = *static_cast<CadFacets*>(to);
        CadPart& part = out.parts.back();
        part.first_facet = out.face.size();
        part.facet_count = mesh->facet_count;
        part.volume = mesh->volume * 1e-9;
        part.area = mesh->area * 1e-6;
        part.center = metres(mesh->center);
        for (std::size_t e = 0; e < 6; ++e) part.inertia[e] = mesh->inertia[e] * 1e-15;
        part.sharp_edges = mesh->sharp_edges;
        part.smooth_edges = mesh->smooth_edges;
        part.sharp_length = mesh->sharp_length / 1000;
        for (std::size_t f = 0; f < mesh->facet_count; ++f)
        {
            out.face.push_back(mesh->faces[f]);
            auto& uv = out.uv.emplace_back();
            for (std::size_t c = 0; c < 3; ++c)
            {
                out.soup.vertices.push_back(
                    metres(mesh->points + 3 * std::size_t{mesh->corners[3 * f + c]}));
                uv[c] = {mesh->uv[6 * f + 2 * c], mesh->uv[6 * f + 2 * c + 1]};
            }
        }
    }

    std::string path_;
    FppgStepFile* file_ = nullptr;
    std::vector<CadPart> parts_;
};

/// Reading takes longer than all else, and a case draws parts of a file one by one: a file that is
/// open stays so until none needs it.
std::shared_ptr<StepFile> open_step(const std::string& path)
{
    expect_regular_file(path);
    std::error_code failed;
    if (!fs::is_regular_file(path, failed))
        throw IoError(fmt::format("cannot open '{}': no such file", path));
    struct Known
    {
        fs::file_time_type time;
        std::uintmax_t size = 0;
        std::weak_ptr<StepFile> file;
    };
    static std::mutex mutex;
    static std::map<std::string, Known> known;
    const std::lock_guard<std::mutex> lock(mutex);
    Known& entry = known[fs::absolute(path, failed).string()];
    const auto time = fs::last_write_time(path, failed);
    const auto size = fs::file_size(path, failed);
    std::shared_ptr<StepFile> file = entry.file.lock();
    if (file && entry.time == time && entry.size == size) return file;
    file = std::make_shared<StepFile>(path);
    entry = {time, size, file};
    return file;
}

bool has_name(const CadPart& part, std::string_view name)
{
    return part.name == name ||
           std::find(part.path.begin(), part.path.end(), name) != part.path.end();
}

/// Parts of a name; of "bolt#2" the second that is named so.
std::vector<std::size_t> parts_named(const std::vector<CadPart>& parts, std::string_view name)
{
    std::vector<std::size_t> found;
    for (std::size_t i = 0; i < parts.size(); ++i)
        if (has_name(parts[i], name)) found.push_back(i);
    const std::size_t sign = name.rfind('#');
    if (!found.empty() || sign == std::string_view::npos) return found;
    const std::string_view number = name.substr(sign + 1);
    if (number.empty() || number.size() > 6 ||
        number.find_first_not_of("0123456789") != std::string_view::npos)
        return {};
    const auto wanted = static_cast<std::size_t>(std::stoul(std::string(number)));
    found = parts_named(parts, name.substr(0, sign));
    if (wanted < 1 || wanted > found.size()) return {};
    return {found[wanted - 1]};
}

std::string list_of(const std::vector<CadPart>& parts)
{
    std::vector<std::string> names;
    for (const CadPart& part : parts)
        for (const std::string& name : part.path)
            if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
    if (names.empty()) return "its parts have no names";
    constexpr std::size_t most = 30;
    const std::size_t more = names.size() > most ? names.size() - most : 0;
    names.resize(names.size() - more);
    return fmt::format("it has {}{}", fmt::join(names, ", "),
                       more > 0 ? fmt::format(" and {} more", more) : "");
}

std::set<std::size_t> chosen_parts(const std::string& path, const std::vector<CadPart>& parts,
                                   const std::string& wanted)
{
    std::set<std::size_t> chosen;
    if (wanted.empty())
    {
        for (std::size_t i = 0; i < parts.size(); ++i) chosen.insert(i);
        return chosen;
    }
    // A name may have commas itself.
    std::vector<std::string_view> names{wanted};
    if (parts_named(parts, wanted).empty()) names = split(wanted, ',');
    for (const std::string_view name : names)
    {
        const std::vector<std::size_t> found = parts_named(parts, trimmed(name));
        if (found.empty())
            throw GeometryError(
                fmt::format("{}: has no part named '{}': {}", path, trimmed(name), list_of(parts)));
        chosen.insert(found.begin(), found.end());
    }
    return chosen;
}

} // namespace

bool is_step_file(const std::string& path)
{
    const std::string ending = lower_case(fs::path(path).extension().string());
    return ending == ".step" || ending == ".stp";
}

MeshFile read_step(const std::string& path, const MeshReading& reading)
{
    const std::shared_ptr<StepFile> file = open_step(path);
    auto cad = std::make_shared<CadFacets>();
    for (const std::size_t i : chosen_parts(path, file->parts(), reading.parts))
        file->mesh(i, reading.deflection, *cad);
    if (cad->face.empty()) throw GeometryError(fmt::format("{}: has no face", path));
    cad->at = [file](std::uint32_t face, double u, double v) { return file->at(face, u, v); };
    MeshFile out;
    out.soup = cad->soup;
    out.cad = std::move(cad);
    return out;
}

std::vector<CadPart> step_parts(const std::string& path)
{
    return open_step(path)->parts();
}

} // namespace fppg
