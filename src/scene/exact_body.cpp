#include "scene/exact_body.h"

#include "fppg/surface_mesh.h"

#include "scene/surfaces.h"
#include "shapes/shape.h"

#include <fmt/format.h>

#include <variant>
#include <vector>

namespace fppg
{
namespace
{

bool stays_in(const Combination& combination, std::uint16_t mk)
{
    for (std::size_t i = 0; i < combination.mks.size(); ++i)
        if (combination.stays[i] != 0 && combination.mks[i].kind == MkKind::Bound &&
            combination.mks[i].mk == mk)
            return true;
    return false;
}

/// The body of a closed mesh all of whose shells look outwards.
ExactBody body_of_turned(const MeshFileOp& file, const MeshFile& mesh)
{
    TriangleSoup soup;
    for (const Vec3& v : mesh.soup.vertices) soup.vertices.push_back(file.transform(v));
    MeshReport report;
    return body_of_facets(soup_of(repair_mesh(soup, {}, 1, report)));
}

} // namespace

std::optional<ExactBody> exact_body(const Scene& scene, std::uint16_t mk, bool turns_shells,
                                    std::string& why_not)
{
    if (scene.def->grid.is_2d)
    {
        why_not = "a case in two dimensions has no closed shapes";
        return std::nullopt;
    }
    std::vector<const DrawOp*> draws;
    bool is_recoloured = false;
    bool is_combined = false;
    for (const SceneStep& step : scene.remaining())
    {
        const DrawState& state = *step.draw->state;
        is_combined = is_combined || (step.combination && stays_in(*step.combination, mk));
        if (step.combination || step.is_part || state.mk.kind != MkKind::Bound ||
            state.mk.mk != mk || !state.draw_points)
            continue;
        const auto* shape = std::get_if<Shape>(&step.draw->what);
        const Edit* edit = step.edit();
        is_recoloured =
            is_recoloured || !state.clips.empty() || (edit != nullptr && is_redraw(*edit));
        if (shape != nullptr && !std::holds_alternative<WaveOp>(*shape)) draws.push_back(step.draw);
    }
    if (draws.size() != 1 || is_recoloured || is_combined)
    {
        why_not = is_recoloured ? "redraws or clips take part in it"
                  : is_combined ? "a combination of draws makes it"
                                : fmt::format("{} draws make it", draws.size());
        return std::nullopt;
    }
    const Shape& shape = std::get<Shape>(draws.front()->what);
    const MeshFile* mesh = mesh_of(scene, *draws.front(), 1);
    std::optional<ExactBody> body =
        body_of(shape, {*draws.front()->state, scene.def->grid, mesh}, why_not);
    const auto* file = std::get_if<MeshFileOp>(&shape);
    if (body && turns_shells && file != nullptr && mesh->cad == nullptr)
        body = body_of_turned(*file, *mesh);
    if (body)
        body->shape = fmt::format("<{}> of line {}", draws.front()->source.command,
                                  draws.front()->source.line);
    return body;
}

} // namespace fppg
