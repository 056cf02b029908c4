#include "scene/shape_cells.h"

#include "core/float32.h"
#include "meshes/cut_at_plane.h"
#include "meshes/mesh_library.h"

#include <algorithm>
#include <variant>

namespace fppg
{
namespace
{

void clip(const ClipPlane& plane, std::vector<ShapeCell>& cells)
{
    const auto beyond = [&](const Vec3& p) { return dot(p - plane.point, plane.normal); };
    const auto holds = [&](const Vec3& p) { return beyond(p) <= 0; };
    const auto crossing = [&](const Vec3& a, const Vec3& b)
    { return as_float32(a + (b - a) * (-beyond(a) / dot(plane.normal, b - a))); };
    ShapeCell kept;
    for (ShapeCell& cell : cells)
    {
        if (std::all_of(cell.begin(), cell.end(), holds)) continue;
        if (cell.size() > 2)
        {
            cut_at_plane(cell, holds, crossing, kept);
            if (kept.size() < 3) kept.clear();
            cell.swap(kept);
        }
        else if (holds(cell[0]))
            cell = {cell[0], crossing(cell[0], cell[1])};
        else if (holds(cell[1]))
            cell = {cell[1], crossing(cell[0], cell[1])};
        else
            cell.clear();
    }
    std::erase_if(cells, [](const ShapeCell& cell) { return cell.empty(); });
}

} // namespace

bool has_shape_cells(const Command& what)
{
    const auto* shape = std::get_if<Shape>(&what);
    return shape != nullptr && has_cells(*shape);
}

std::vector<ShapeCell> shape_cells(const Scene& scene, const DrawOp& op, bool snapped)
{
    const CaseDef& def = *scene.def;
    const DrawState& state = *op.state;
    MeshFile cut;
    ShapeContext context{state, def.grid, nullptr, snapped && !state.off_lattice};
    if (const auto* file = shape_as<MeshFileOp>(op))
        context.mesh =
            &scene.meshes->read_drawn(op.source, *file, {def.case_pos_min, def.case_pos_max}, cut);
    std::vector<ShapeCell> cells = cells_of(std::get<Shape>(op.what), context);
    if (!state.clips.empty())
        for (ShapeCell& cell : cells)
            for (Vec3& corner : cell) corner = as_float32(corner);
    for (const ClipPlane& plane : state.clips) clip(plane, cells);
    return cells;
}

} // namespace fppg
