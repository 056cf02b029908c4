#include "shapes/shape_mesh.h"

#include "shapes/kinds.h"
#include "shapes/shape.h"

namespace fppg
{

std::vector<ShapeMesh> shape_meshes(const DrawOp& op, const MeshFile* file, const LatticeGrid& grid)
{
    const auto* shape = std::get_if<Shape>(&op.what);
    if (shape == nullptr) return {};
    std::vector<ShapeMesh> meshes = surfaces_of(*shape, {*op.state, grid, file});
    std::erase_if(meshes, [](const ShapeMesh& m) { return m.soup.size() == 0; });
    if (op.state->normal_invert)
        for (ShapeMesh& mesh : meshes)
            if (!mesh.is_solid) kinds::flip(mesh.soup);
    return meshes;
}

} // namespace fppg
