#include "fppg/error.h"

#include "meshes/cad_surface.h"
#include "shapes/file_polygons.h"
#include "shapes/kinds.h"

#include <cassert>
#include <cmath>

namespace fppg::kinds
{
namespace
{

/// Solids together, moved by a transform; nothing where one is none.
std::optional<ExactBody> body_of_parts(const std::vector<CadPart>& parts, const Transform& move)
{
    double volume = 0;
    Vec3 weighted;
    for (const CadPart& part : parts)
    {
        if (!(part.volume > 0)) return std::nullopt;
        volume += part.volume;
        weighted = weighted + part.volume * part.center;
    }
    const Vec3 center = weighted / volume;
    std::array<Vec3, 3> inertia{};
    for (const CadPart& part : parts)
    {
        const auto& m = part.inertia;
        const std::array<Vec3, 3> own =
            inertia_about({Vec3{m[0], m[3], m[5]}, Vec3{m[3], m[1], m[4]}, Vec3{m[5], m[4], m[2]}},
                          part.volume, part.center - center);
        for (std::size_t r = 0; r < 3; ++r) inertia[r] = inertia[r] + own[r];
    }
    // Second moments, int x x^T, go with the map on both sides; the inertia is their trace less
    // they.
    const auto turned_over = [](const std::array<Vec3, 3>& m, double share)
    {
        const double trace = share * (m[0].x + m[1].y + m[2].z);
        std::array<Vec3, 3> of{-m[0], -m[1], -m[2]};
        of[0].x += trace;
        of[1].y += trace;
        of[2].z += trace;
        return of;
    };
    const std::array<Vec3, 3> second = turned_over(inertia, 0.5);
    const auto& a = move.linear;
    const double grows = std::fabs(dot(a[0], cross(a[1], a[2])));
    std::array<Vec3, 3> moved{};
    for (std::size_t r = 0; r < 3; ++r)
    {
        const Vec3 row{dot(second[0], a[r]), dot(second[1], a[r]), dot(second[2], a[r])};
        moved[r] = grows * Vec3{dot(row, a[0]), dot(row, a[1]), dot(row, a[2])};
    }
    ExactBody out;
    out.volume = grows * volume;
    out.center = move(center);
    out.inertia = turned_over(moved, 1);
    return out;
}

} // namespace

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
        mesh.cad = std::make_shared<const CadSource>(CadSource{context.mesh->cad, file.transform});
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
    std::optional<ExactBody> out = body_of_closed(soup, why_not);
    // Of a CAD model not its facets, but its exact faces.
    if (out && context.mesh->cad != nullptr)
        if (auto exact = body_of_parts(context.mesh->cad->parts, file.transform)) return exact;
    return out;
}

} // namespace fppg::kinds
