#include "shapes/shape_mesh.h"
#include "shapes/polygon_cut.h"

#include "fppg/error.h"

#include "shapes/round_mesh.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <map>
#include <numeric>

namespace fppg
{
namespace
{

using Corners = std::array<std::uint32_t, 3>;

void flip(TriangleSoup& soup)
{
    for (std::size_t i = 0; i < soup.size(); ++i)
        std::swap(soup.vertices[3 * i + 1], soup.vertices[3 * i + 2]);
}

/// The triangles of a polygon of a figure, all running around as the polygon does.
std::vector<Corners> triangles_of(const FigureOp& figure, const FigureFace& face)
{
    std::vector<Corners> out = face.triangles;
    if (out.empty() && face.cut.empty())
        for (std::size_t i = 2; i < face.vertices.size(); ++i)
            out.push_back({face.vertices[0], face.vertices[i - 1], face.vertices[i]});
    else if (out.empty())
    {
        for (const auto& t : cut_polygon(figure.vertices, {face.cut.begin(), face.cut.end()}))
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

TriangleSoup soup_of(const FigureOp& figure, const std::vector<FigureFace>& faces)
{
    TriangleSoup soup;
    for (const FigureFace& face : faces)
        for (const Corners& t : triangles_of(figure, face))
            for (const std::uint32_t v : t) soup.vertices.push_back(figure.vertices[v]);
    return soup;
}

/// The visible part of the faces that setmknextauto draws at this turn: a polygon that is cut as
/// given counts as one part, each triangle of the others as a part of its own.
TriangleSoup part_of(const FigureOp& figure)
{
    TriangleSoup soup;
    std::uint32_t part = 0;
    for (const FigureFace& face : figure.faces)
    {
        if (!face.is_visible) continue;
        const bool is_one_part = face.triangles.empty() && face.cut.empty();
        for (const Corners& t : triangles_of(figure, face))
        {
            if (part == figure.part)
                for (const std::uint32_t v : t) soup.vertices.push_back(figure.vertices[v]);
            if (!is_one_part) ++part;
        }
        if (is_one_part) ++part;
    }
    return soup;
}

class ShapeMesher
{
public:
    ShapeMesher(const DrawState& state, const TriangleSoup* file, double dp)
        : state_(state), file_(file), dp_(dp)
    {
    }

    std::vector<ShapeMesh> run(const Shape& shape)
    {
        std::visit([this](const auto& op) { draw(op); }, shape);
        std::erase_if(meshes_, [](const ShapeMesh& m) { return m.soup.size() == 0; });
        if (state_.normal_invert)
            for (ShapeMesh& mesh : meshes_)
                if (!mesh.is_solid) flip(mesh.soup);
        return std::move(meshes_);
    }

private:
    bool is_wire() const { return state_.mode == DrawMode::Wire; }
    bool may_fill() const { return state_.mode != DrawMode::Face; }

    void draw(const FigureOp& op)
    {
        if (is_wire()) return;
        ShapeMesh mesh;
        mesh.is_solid = may_fill() && op.solid != SolidKind::None;
        if (op.part_count > 0 && mesh.is_solid)
            throw GeometryError(
                "setmknextauto draws the inside of this shape part by part, which "
                "body-fitted particles cannot follow; switch one of the two off");
        // Hidden faces help to tell the outside of what is seen.
        const TriangleSoup hull = soup_of(op, op.faces);
        const bool is_turned = is_closed(hull) && volume_of(hull) < 0;
        std::vector<FigureFace> visible;
        std::copy_if(op.faces.begin(), op.faces.end(), std::back_inserter(visible),
                     [](const FigureFace& f) { return f.is_visible; });
        if (mesh.is_solid)
            mesh.soup = hull;
        else
            mesh.soup = op.part_count > 0 ? part_of(op) : soup_of(op, visible);
        if (is_turned) flip(mesh.soup);
        meshes_.push_back(std::move(mesh));
    }

    void draw(const SphereOp& op)
    {
        if (is_wire()) return;
        for (const double layer : op.layers_dp)
            meshes_.push_back(sphere_mesh(op.center, op.radius + layer * dp_, dp_));
        if (!op.layers_dp.empty()) return;
        meshes_.push_back(sphere_mesh(op.center, op.radius, dp_));
        meshes_.back().is_solid = may_fill();
    }

    void draw(const CylinderOp& op)
    {
        if (is_wire()) return;
        for (const CylinderLayer& layer : op.layers)
            meshes_.push_back(cylinder_mesh(layer.p0, layer.p1, layer.radius, op.is_visible, dp_));
        if (!op.layers.empty()) return;
        meshes_.push_back(cylinder_mesh(op.p0, op.p1, op.radius, op.is_visible, dp_));
        meshes_.back().is_solid = may_fill() && !op.is_masked;
    }

    void draw(const EllipsoidOp& op)
    {
        if (is_wire()) return;
        meshes_.push_back(ellipsoid_mesh(op.focus0, op.focus1, op.radius, dp_));
        meshes_.back().is_solid = may_fill();
    }

    void draw(const MeshFileOp& op)
    {
        assert(file_ != nullptr);
        if (state_.mk_next_auto)
            throw GeometryError(
                "setmknextauto draws a mesh file part by part, which body-fitted "
                "particles cannot follow; switch one of the two off");
        ShapeMesh mesh;
        mesh.is_solid = op.autofill || op.fill_inside || op.advanced;
        mesh.soup.vertices.reserve(file_->vertices.size());
        for (const Vec3& v : file_->vertices) mesh.soup.vertices.push_back(op.transform(v));
        const auto& rows = op.transform.linear;
        if (dot(rows[0], cross(rows[1], rows[2])) < 0) flip(mesh.soup);
        meshes_.push_back(std::move(mesh));
    }

    /// Points, lines and waves stay on the lattice.
    template <typename Other>
    void draw(const Other&)
    {
    }

    const DrawState& state_;
    const TriangleSoup* file_;
    double dp_;
    std::vector<ShapeMesh> meshes_;
};

} // namespace

std::vector<ShapeMesh> shape_meshes(const DrawOp& op, const TriangleSoup* file, double dp)
{
    const auto* shape = std::get_if<Shape>(&op.what);
    if (shape == nullptr) return {};
    return ShapeMesher(*op.state, file, dp).run(*shape);
}

} // namespace fppg
