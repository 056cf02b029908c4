#include "fppg/error.h"

#include "meshes/cad_surface.h"
#include "shapes/file_polygons.h"
#include "shapes/kinds.h"

#include <cassert>

namespace fppg::kinds
{

/// What a file holds is known when it is read.
Box3 bounds_of(const MeshFileOp&, double)
{
    return {};
}

bool is_body(const MeshFileOp&, DrawMode)
{
    return true;
}

std::vector<ShapeMesh> surfaces_of(const MeshFileOp& file, const ShapeContext& context)
{
    assert(context.mesh != nullptr);
    if (context.state.mk_next_auto)
        throw GeometryError(
            "setmknextauto draws a mesh file part by part, which body-fitted "
            "particles cannot follow; switch one of the two off");
    const TriangleSoup& source = context.mesh->soup;
    ShapeMesh mesh;
    mesh.is_solid = file.autofill || file.fill_inside || file.advanced;
    mesh.soup.vertices.reserve(source.vertices.size());
    for (const Vec3& v : source.vertices) mesh.soup.vertices.push_back(file.transform(v));
    if (context.mesh->cad != nullptr)
        mesh.cad =
            std::make_shared<const CadSource>(CadSource{context.mesh->cad, file.transform});
    const auto& rows = file.transform.linear;
    if (dot(rows[0], cross(rows[1], rows[2])) < 0) flip(mesh.soup);
    return {std::move(mesh)};
}

void add_cells(const MeshFileOp& file, CellList& out)
{
    assert(out.context.mesh != nullptr);
    const MeshFile& mesh = *out.context.mesh;
    const auto placed = [&](const Vec3& v) { return out.context.place(file.transform(v)); };
    for (const std::vector<Vec3>& line : mesh.lines)
    {
        if (file.advanced) break; // takes surfaces only
        for (std::size_t i = 0; i < line.size(); ++i)
            out.add_line(placed(line[i == 0 ? 0 : i - 1]), placed(line[i]));
    }
    for_each_polygon(mesh, file, out.context.grid.dp,
                     [&](const std::vector<std::uint32_t>& corners)
                     {
                         ShapeCell cell;
                         for (const std::uint32_t c : corners)
                             cell.push_back(placed(mesh.soup.vertices[c]));
                         out.add_flat_face(std::move(cell));
                     });
}

std::optional<ExactBody> body_of(const MeshFileOp& file, const ShapeContext& context,
                                 std::string& why_not)
{
    TriangleSoup soup;
    for (const Vec3& v : context.mesh->soup.vertices) soup.vertices.push_back(file.transform(v));
    return body_of_closed(soup, why_not);
}

} // namespace fppg::kinds
