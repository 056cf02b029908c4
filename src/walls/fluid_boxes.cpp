#include "walls/fluid_boxes.h"

#include "scene/surfaces.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>
#include <variant>

namespace fppg
{
namespace
{

Box3 box_of(const ShapeMesh& shape)
{
    Box3 box;
    for (const Vec3& v : shape.soup.vertices) box.add(v);
    return box;
}

/// Fluid that comes in lies in the wall: it will be a step before it.
Box3 moved_in(const Box3& box, const Vec3& way, const LatticeGrid& grid)
{
    const Vec3 step = (2 * grid.dp) * way;
    return {box.min + step, box.max + step};
}

Box3 box_of(const Scene& scene, const DrawOp& draw, int threads)
{
    Box3 out;
    for (const ShapeMesh& shape : surfaces_of(scene, draw, PartsAs::One, threads))
        if (const Box3 box = box_of(shape); !box.is_empty())
            for (const Vec3& corner : {box.min, box.max}) out.add(corner);
    return out;
}

std::vector<Vec3> places_beside(const Box3& body, const std::vector<Box3>& fluid,
                                const LatticeGrid& grid)
{
    const auto surrounds = [&](const Box3& box, int axis) {
        return box.min[axis] < body.min[axis] - grid.dp && box.max[axis] > body.max[axis] + grid.dp;
    };
    std::vector<Vec3> out;
    for (const Box3& box : fluid)
    {
        const Vec3 middle = 0.5 * (box.min + box.max);
        if (!body.has(middle, 0) || !surrounds(box, 0) || (!grid.is_2d && !surrounds(box, 1)))
            out.push_back(middle);
    }
    return out;
}

/// A box about a place in fluid: of a seed the place alone.
Box3 box_about(const Vec3& seed)
{
    Box3 box;
    box.add(seed);
    return box;
}

} // namespace

std::vector<Box3> boxes_of_fluid(const Scene& scene, int threads)
{
    const InOutZones& inout = scene.def->solver.inout;
    std::vector<Box3> out;
    for (const SceneStep& step : scene.steps)
    {
        if (step.combination || step.draw->state->mk.kind != MkKind::Fluid) continue;
        if (const auto* edit = std::get_if<Edit>(&step.draw->what))
        {
            if (const auto* fill = std::get_if<FillOp>(edit)) out.push_back(box_about(fill->seed));
            if (const auto* fill = std::get_if<CavityFillOp>(edit))
                out.push_back(box_about(fill->seed));
        }
        if (step.shape() == nullptr) continue;
        for (const ShapeMesh& shape : surfaces_of(scene, *step.draw, PartsAs::One, threads))
            if (const Box3 box = box_of(shape); !box.is_empty())
            {
                const auto inlet = inout.fluids.find(step.draw->state->mk.mk);
                out.push_back(inlet == inout.fluids.end()
                                  ? box
                                  : moved_in(box, inlet->second.way, scene.def->grid));
            }
    }
    for (const InletShape& shape : inout.shapes)
        if (shape.way != Vec3{}) out.push_back(moved_in(shape.box, shape.way, scene.def->grid));
    return out;
}

std::vector<Vec3> places_in_fluid(const std::vector<Box3>& fluid, const Scene& scene,
                                  const DrawOp& draw, int threads)
{
    if (fluid.empty()) return {};
    return places_beside(box_of(scene, draw, threads), fluid, scene.def->grid);
}

std::vector<Vec3> places_in_fluid(const std::vector<Box3>& fluid, const Scene& scene,
                                  const Combination& combination, int threads)
{
    if (fluid.empty()) return {};
    Box3 body;
    for (std::size_t p = 0; p < combination.parts.size(); ++p)
    {
        if (combination.stays[p] == 0) continue;
        const Box3 box = box_of(scene, *combination.parts[p], threads);
        if (box.is_empty()) continue;
        for (const Vec3& corner : {box.min, box.max}) body.add(corner);
    }
    return places_beside(body, fluid, scene.def->grid);
}

std::vector<std::string> draw_shells_around_fluid(const Scene& scene, int threads, CaseDef& def)
{
    std::vector<std::string> out;
    const auto is_left_out = [&](const DrawOp& op)
    { return op.inner_surface != nullptr && op.shells > 0 && op.state->draw_points; };
    if (std::none_of(def.ops.begin(), def.ops.end(), is_left_out)) return out;
    const std::vector<Box3> fluid = boxes_of_fluid(scene, threads);
    for (DrawOp& op : def.ops)
    {
        if (!is_left_out(op)) continue;
        const Box3 body = box_of(scene, op, threads);
        const std::vector<Vec3> places = places_in_fluid(fluid, scene, op, threads);
        if (std::none_of(places.begin(), places.end(),
                         [&](const Vec3& p) { return body.has(p, 0); }))
            continue;
        op.what = *op.inner_surface;
        out.push_back(
            fmt::format("{}: fluid is within it, so that the innermost of its <layers "
                        "vdp> is the surface of the wall.",
                        place_of(def, op.source)));
    }
    return out;
}

} // namespace fppg
