#include "app/inspect_particles.h"

#include "fppg/error.h"
#include "fppg/particles.h"
#include "fppg/relax_walls.h"
#include "fppg/scene.h"
#include "fppg/shapes.h"

#include "app/body_table.h"
#include "meshes/read_step.h"

#include <fmt/format.h>

#include <cmath>
#include <filesystem>
#include <memory>
#include <utility>

namespace fppg
{
namespace
{

constexpr std::uint16_t wall_mk = 10;

/// A case that draws the file alone, as a filled solid.
CaseDef case_of(const InspectOptions& options, const SurfaceMesh& mesh, Placement place)
{
    CaseDef def;
    Box3 box;
    for (const Vec3& v : mesh.vertices) box.add(v);
    constexpr double margin = 3;
    def.grid.dp = options.dp;
    def.grid.origin = box.min - margin * options.dp * Vec3{1, 1, 1};
    for (int axis = 0; axis < 3; ++axis)
        def.grid.n[static_cast<std::size_t>(axis)] = static_cast<std::uint32_t>(
            std::ceil((box.max[axis] - box.min[axis]) / options.dp + 2 * margin) + 1);
    def.mk_bound_first = wall_mk;
    def.constants.rhop0 = 1000;
    def.constants.gamma = 7;
    def.constants.coef_sound = 20;
    def.constants.coef_h = 1;
    def.h = std::sqrt(3.0) * options.dp;
    FitSettings settings;
    settings.feature_angle_deg = options.angle_deg;
    settings.cad_angle_deg = options.cad_angle_deg;
    settings.place = place;
    if (place == Placement::Inside) settings.depths_dp = {0.5};
    def.fit.all = settings;
    MeshFileOp file;
    file.file = std::filesystem::absolute(options.path).string();
    file.reading = reading_of(options);
    file.autofill = true;
    DrawState state;
    state.mk = {MkKind::Bound, wall_mk, 0};
    DrawOp op;
    op.source = {1, "drawfile"};
    op.state = std::make_shared<const DrawState>(state);
    op.what = Shape{std::move(file)};
    def.ops.push_back(std::move(op));
    return def;
}

} // namespace

MeshReading reading_of(const InspectOptions& options)
{
    MeshReading reading;
    reading.format = mesh_format_of(options.path);
    reading.parts = options.parts;
    if (reading.format == MeshFormat::Step) reading.deflection = cad_deflection_dp * options.dp;
    if (reading.format != MeshFormat::Step && !options.parts.empty())
        throw UsageError(fmt::format("{}: --part is possible for STEP files only", options.path));
    return reading;
}

std::vector<InspectedBody> inspect_bodies(const InspectOptions& options, const SurfaceMesh& mesh)
{
    std::vector<InspectedBody> out;
    out.push_back({"shape", 0, body_of_facets(soup_of(mesh))});
    for (const Placement place : {Placement::Surface, Placement::Inside})
    {
        const CaseDef def = case_of(options, mesh, place);
        LatticeReport drawn;
        RunField field = draw_scene(make_scene(def), options.threads, {}, drawn);
        RelaxReport relaxed;
        relax_walls(def, field, options.threads, {}, relaxed);
        CaseConstants constants;
        std::vector<std::string> warnings;
        const CaseParticles particles =
            make_particles(def, field, options.threads, constants, warnings);
        const bool is_inside = place == Placement::Inside;
        for (const ParticleBlock& block : particles.blocks)
            if (block.mk == wall_mk)
                out.push_back({is_inside ? "inside" : "on the surface",
                               static_cast<std::size_t>(block.count),
                               body_of_particles(particles, block, is_inside)});
    }
    return out;
}

} // namespace fppg
