#include "scene/part_colours.h"

#include "meshes/cad_facets.h"
#include "scene/surfaces.h"
#include "shapes/shape.h"

#include <algorithm>

namespace fppg
{
namespace
{

using ColourAreas = std::map<std::uint16_t, std::map<Rgb, double>>;

void add_colours(const Scene& scene, const DrawOp& draw, const MkValue& mk, ColourAreas& areas)
{
    const auto* file = shape_as<MeshFileOp>(draw);
    if (file == nullptr || file->reading.format != MeshFormat::Step || mk.kind != MkKind::Bound ||
        !draw.state->draw_points)
        return;
    const MeshFile* mesh = mesh_of(scene, draw, 1);
    if (mesh->cad == nullptr) return;
    for (const CadPart& part : mesh->cad->parts)
        if (part.color) areas[mk.mk][*part.color] += part.area;
}

} // namespace

std::map<std::uint16_t, Rgb> colours_of_parts(const Scene& scene)
{
    ColourAreas areas;
    for (const SceneStep& step : scene.remaining())
    {
        if (step.combination)
            for (std::size_t p = 0; p < step.combination->parts.size(); ++p)
                add_colours(scene, *step.combination->parts[p], step.combination->mks[p], areas);
        else if (!step.is_part)
            add_colours(scene, *step.draw, step.draw->state->mk, areas);
    }
    std::map<std::uint16_t, Rgb> out;
    for (const auto& [mk, of] : areas)
        out[mk] = std::max_element(of.begin(), of.end(),
                                   [](const auto& a, const auto& b) { return a.second < b.second; })
                      ->first;
    return out;
}

} // namespace fppg
