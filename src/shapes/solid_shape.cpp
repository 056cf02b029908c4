#include "shapes/solid_shape.h"

#include "shapes/kinds.h"

#include <utility>

namespace fppg::kinds
{

Box3 bounds_of(const SolidOp& solid, double)
{
    return solid.shape->bounds();
}

bool is_body(const SolidOp&, DrawMode)
{
    return true;
}

std::vector<ShapeMesh> surfaces_of(const SolidOp& solid, const ShapeContext& context)
{
    if (context.is_wire()) return {};
    ShapeMesh mesh = solid.shape->surface(context.grid.dp);
    mesh.is_solid = context.may_fill();
    return {std::move(mesh)};
}

SlabRegion nodes_of(const SolidOp& solid, const DrawState& state, const LatticeGrid& grid)
{
    return solid.shape->nodes(state, grid);
}

void add_cells(const SolidOp& solid, CellList& out)
{
    for (ShapeCell& face : solid.shape->cells(out.context)) out.add_round_face(std::move(face));
}

std::optional<ExactBody> body_of(const SolidOp& solid, const ShapeContext&, std::string&)
{
    return solid.shape->moments();
}

} // namespace fppg::kinds
