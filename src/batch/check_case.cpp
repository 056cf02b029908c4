#include "batch/check_case.h"

#include "fppg/error.h"

#include "meshes/mesh_library.h"

#include <fmt/format.h>

namespace fppg
{
namespace
{

void require_files(const CaseDef& def)
{
    for (const DrawOp& op : def.ops)
        if (const auto* mesh = shape_as<MeshFileOp>(op))
        {
            def.meshes->find(op.source, mesh->file);
            for (const std::string& file : mesh->joined) def.meshes->find(op.source, file);
        }
    for (const PointFile& file : def.point_files) def.meshes->find(file.source, file.file);
}

void check_zone(const std::string& path, const CaseOptions& options, bool is_strict, CaseDef& def)
{
    def = read_case(path, options);
    require_files(def);
    if (is_strict && !def.warnings.empty())
        throw CaseError(fmt::format("{} (-strict: warnings count as errors)", def.warnings[0]));
}

} // namespace

std::optional<std::string> find_refusal(const std::string& path, CaseOptions options,
                                        bool is_strict)
{
    std::string text;
    try
    {
        CaseDef def;
        check_zone(path, options, is_strict, def);
        const VresDef vres = def.vres;
        options.vres = &vres;
        for (options.zone = 1; options.zone < vres.zones.size(); ++options.zone)
            check_zone(path, options, is_strict, def);
        return std::nullopt;
    }
    catch (const Interrupted&)
    {
        throw;
    }
    catch (const Error& error)
    {
        text = error.what();
    }
    // Files of properties and of variables are named instead of the definition.
    return text.find(path) == std::string::npos ? path + ": " + text : text;
}

} // namespace fppg
