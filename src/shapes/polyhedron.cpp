#include "fppg/error.h"

#include "shapes/kinds.h"
#include "shapes/polygon_cut.h"
#include "shapes/polyhedra.h"

#include <algorithm>
#include <array>
#include <iterator>
#include <map>
#include <memory>
#include <utility>

namespace fppg::kinds
{
namespace
{

using Corners = std::array<std::uint32_t, 3>;

/// The triangles of a polygon of a polyhedron, all running around as the polygon does.
std::vector<Corners> triangles_of(const PolyhedronOp& polyhedron, const PolyhedronFace& face)
{
    std::vector<Corners> out = face.triangles;
    if (out.empty() && face.cut.empty())
        for (std::size_t i = 2; i < face.vertices.size(); ++i)
            out.push_back({face.vertices[0], face.vertices[i - 1], face.vertices[i]});
    else if (out.empty())
    {
        for (const auto& t : cut_polygon(polyhedron.vertices, {face.cut.begin(), face.cut.end()}))
        {
            Corners& corners = out.emplace_back();
            for (std::size_t k = 0; k < 3; ++k)
                corners[k] = static_cast<std::uint32_t>(t[k]) + face.cut_offset;
        }
    }
    const auto place = [&](std::uint32_t v)
    { return std::find(face.vertices.begin(), face.vertices.end(), v) - face.vertices.begin(); };
    for (Corners& t : out)
    {
        const auto a = place(t[0]);
        const auto b = place(t[1]);
        const auto c = place(t[2]);
        if ((a < b) + (b < c) + (c < a) < 2) std::swap(t[1], t[2]);
    }
    return out;
}

/// Whether every side is run through as often in one way as in the other, by the places of corners.
bool is_closed(const TriangleSoup& soup)
{
    std::map<std::array<double, 6>, int> sides;
    for (std::size_t i = 0; i < soup.vertices.size(); ++i)
    {
        const Vec3& a = soup.vertices[i];
        const Vec3& b = soup.vertices[i % 3 == 2 ? i - 2 : i + 1];
        // Adding zero makes one of the two zeros.
        ++sides[{a.x + 0.0, a.y + 0.0, a.z + 0.0, b.x + 0.0, b.y + 0.0, b.z + 0.0}];
        --sides[{b.x + 0.0, b.y + 0.0, b.z + 0.0, a.x + 0.0, a.y + 0.0, a.z + 0.0}];
    }
    return std::all_of(sides.begin(), sides.end(), [](const auto& s) { return s.second == 0; });
}

double volume_of(const TriangleSoup& soup)
{
    double sum = 0;
    for (std::size_t i = 0; i + 2 < soup.vertices.size(); i += 3)
    {
        const Vec3& from = soup.vertices[0];
        sum += dot(soup.vertices[i] - from,
                   cross(soup.vertices[i + 1] - from, soup.vertices[i + 2] - from));
    }
    return sum / 6;
}

TriangleSoup soup_of(const PolyhedronOp& polyhedron, const std::vector<PolyhedronFace>& faces)
{
    TriangleSoup soup;
    for (const PolyhedronFace& face : faces)
        for (const Corners& t : triangles_of(polyhedron, face))
            for (const std::uint32_t v : t) soup.vertices.push_back(polyhedron.vertices[v]);
    return soup;
}

/// The visible part of the faces that setmknextauto draws at this turn: a polygon that is cut as
/// given counts as one part, each triangle of the others as a part of its own.
TriangleSoup part_of(const PolyhedronOp& polyhedron)
{
    TriangleSoup soup;
    std::uint32_t part = 0;
    for (const PolyhedronFace& face : polyhedron.faces)
    {
        if (!face.is_visible) continue;
        const bool is_one_part = face.triangles.empty() && face.cut.empty();
        for (const Corners& t : triangles_of(polyhedron, face))
        {
            if (part == polyhedron.part)
                for (const std::uint32_t v : t) soup.vertices.push_back(polyhedron.vertices[v]);
            if (!is_one_part) ++part;
        }
        if (is_one_part) ++part;
    }
    return soup;
}

void add_faces(const PolyhedronOp& polyhedron, CellList& out)
{
    const auto corner = [&](std::size_t v) { return out.context.place(polyhedron.vertices[v]); };
    for (const PolyhedronFace& face : polyhedron.faces)
    {
        if (!face.is_visible) continue;
        if (face.triangles.empty() && face.cut.empty())
        {
            ShapeCell corners;
            for (const std::uint32_t v : face.vertices) corners.push_back(corner(v));
            out.add_flat_face(std::move(corners));
            continue;
        }
        for (auto t : face_triangles(polyhedron, face))
        {
            // The top of a prism is cut as its bottom, which looks down.
            if (face.cut_offset > 0 && !out.context.is_wire()) std::reverse(t.begin(), t.end());
            out.add_flat_face({corner(t[0]), corner(t[1]), corner(t[2])});
        }
    }
}

/// Its sides are those of boxfill all, in the same order, whatever it is filled as.
void add_solid_box(const PolyhedronOp& box, CellList& out)
{
    if (out.context.is_wire() && !out.context.state.off_lattice) add_faces(box, out);
    constexpr std::array<std::array<std::size_t, 4>, 6> sides{
        {{0, 3, 2, 1}, {4, 5, 6, 7}, {0, 1, 5, 4}, {2, 3, 7, 6}, {1, 2, 6, 5}, {0, 4, 7, 3}}};
    for (const auto& side : sides)
    {
        ShapeCell corners;
        for (const std::size_t i : side)
            corners.push_back(out.context.place(box.vertices[box.solid_vertices[i]]));
        out.add_face(std::move(corners));
    }
}

} // namespace

Box3 bounds_of(const PolyhedronOp& polyhedron, double)
{
    Box3 box;
    for (const PolyhedronFace& face : polyhedron.faces)
    {
        if (!face.is_visible) continue;
        for (const std::uint32_t v : face.vertices) box.add(polyhedron.vertices[v]);
    }
    return box;
}

bool is_body(const PolyhedronOp& polyhedron, DrawMode mode)
{
    return polyhedron.solid != SolidKind::None && mode != DrawMode::Face;
}

std::vector<ShapeMesh> surfaces_of(const PolyhedronOp& polyhedron, const ShapeContext& context)
{
    if (context.is_wire()) return {};
    ShapeMesh mesh;
    mesh.is_solid = context.may_fill() && polyhedron.solid != SolidKind::None;
    if (polyhedron.part_count > 0 && mesh.is_solid)
        throw GeometryError(
            "setmknextauto draws the inside of this shape part by part, which "
            "body-fitted particles cannot follow; switch one of the two off");
    // Hidden faces help to tell the outside of what is seen.
    const TriangleSoup hull = soup_of(polyhedron, polyhedron.faces);
    const bool is_turned = is_closed(hull) && volume_of(hull) < 0;
    std::vector<PolyhedronFace> visible;
    std::copy_if(polyhedron.faces.begin(), polyhedron.faces.end(), std::back_inserter(visible),
                 [](const PolyhedronFace& f) { return f.is_visible; });
    if (mesh.is_solid)
        mesh.soup = hull;
    else
        mesh.soup = polyhedron.part_count > 0 ? part_of(polyhedron) : soup_of(polyhedron, visible);
    if (is_turned) flip(mesh.soup);
    return {std::move(mesh)};
}

void add_cells(const PolyhedronOp& polyhedron, CellList& out)
{
    const DrawState& state = out.context.state;
    // Off the lattice parts are others; there the first stands for all.
    const bool in_parts = polyhedron.part_count > 0 && !state.off_lattice;
    if (polyhedron.part > 0 && (!in_parts || polyhedron.solid == SolidKind::Box)) return;
    if (polyhedron.solid == SolidKind::Box)
        add_solid_box(polyhedron, out);
    else if (polyhedron.solid == SolidKind::None || state.mode != DrawMode::Solid)
        add_faces(polyhedron, out);
    if (!in_parts || polyhedron.solid == SolidKind::Box) return;
    const std::size_t first = polyhedron.part_count - out.cells.size();
    if (polyhedron.part < first)
        out.cells.clear();
    else
        out.cells = {std::move(out.cells[polyhedron.part - first])};
}

std::optional<ExactBody> body_of(const PolyhedronOp& polyhedron, const ShapeContext& context,
                                 std::string& why_not)
{
    if (polyhedron.part > 0) return std::nullopt; // the first part stands for the whole
    PolyhedronOp whole = polyhedron;
    whole.part_count = 0;
    DrawState full = context.state;
    full.mode = DrawMode::Full;
    const std::vector<ShapeMesh> surfaces = surfaces_of(whole, {full, context.grid});
    return body_of_closed(surfaces.empty() ? TriangleSoup{} : surfaces.back().soup, why_not);
}

} // namespace fppg::kinds
