#include "lattice/shape_cells.h"

#include "core/float32.h"
#include "lattice/shape_rings.h"
#include "meshes/cut_at_plane.h"
#include "meshes/mesh_library.h"
#include "nodes/snap.h"
#include "shapes/file_polygons.h"
#include "shapes/shape.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace fppg
{
namespace
{

class CellMaker
{
public:
    CellMaker(const Scene& scene, const DrawOp& op, bool snapped)
        : scene_(scene),
          def_(*scene.def),
          op_(op),
          state_(*op.state),
          snapped_(snapped && !state_.off_lattice)
    {
    }

    std::vector<ShapeCell> run()
    {
        std::visit([this](const auto& kind) { draw(kind); }, std::get<Shape>(op_.what));
        if (!state_.clips.empty())
            for (ShapeCell& cell : cells_)
                for (Vec3& corner : cell) corner = as_float32(corner);
        for (const ClipPlane& plane : state_.clips) clip(plane);
        return std::move(cells_);
    }

private:
    Vec3 place(const Vec3& p) const
    {
        return snapped_ ? position(snap(p, def_.grid), def_.grid) : p;
    }

    double rounded(double radius) const
    {
        return snapped_ ? std::floor(radius / def_.grid.dp + 0.5) * def_.grid.dp : radius;
    }

    bool is_wire() const { return state_.mode == DrawMode::Wire; }

    void add_line(const Vec3& from, const Vec3& to) { cells_.push_back({from, to}); }

    void add_face(ShapeCell corners)
    {
        if (state_.normal_invert) std::reverse(corners.begin(), corners.end());
        cells_.push_back(std::move(corners));
    }

    /// Turned over, a face of a sphere or cylinder keeps its first corner.
    void add_round_face(ShapeCell corners)
    {
        if (state_.normal_invert) std::reverse(corners.begin() + 1, corners.end());
        cells_.push_back(std::move(corners));
    }

    /// A triangle or quad of a figure or mesh.
    void add_flat_face(ShapeCell corners)
    {
        if (is_wire())
            for (std::size_t i = 0; i < corners.size(); ++i)
                add_line(corners[i], corners[(i + 1) % corners.size()]);
        else if (!snapped_ || corners.size() > 3)
            add_face(std::move(corners));
        else if (corners[0] == corners[1] && corners[1] == corners[2])
            return;
        else if (corners[0] == corners[1] || corners[1] == corners[2] || corners[2] == corners[0])
            add_line(corners[0], corners[0] == corners[1] ? corners[2] : corners[1]);
        else
            add_face(std::move(corners));
    }

    void draw(const LinesOp& lines)
    {
        for (const auto& [from, to] : lines.segments) add_line(place(from), place(to));
    }

    void draw(const FigureOp& figure)
    {
        // Off the lattice parts are others; there the first stands for all.
        const bool in_parts = figure.part_count > 0 && !state_.off_lattice;
        if (figure.part > 0 && (!in_parts || figure.solid == SolidKind::Box)) return;
        if (figure.solid == SolidKind::Box)
            draw_solid_box(figure);
        else if (figure.solid == SolidKind::None || state_.mode != DrawMode::Solid)
            add_faces(figure);
        if (!in_parts || figure.solid == SolidKind::Box) return;
        const std::size_t first = figure.part_count - cells_.size();
        if (figure.part < first)
            cells_.clear();
        else
            cells_ = {std::move(cells_[figure.part - first])};
    }

    void add_faces(const FigureOp& figure)
    {
        for (const FigureFace& face : figure.faces)
        {
            if (!face.is_visible) continue;
            if (face.triangles.empty() && face.cut.empty())
            {
                ShapeCell corners;
                for (const std::uint32_t v : face.vertices)
                    corners.push_back(place(figure.vertices[v]));
                add_flat_face(std::move(corners));
                continue;
            }
            for (auto t : face_triangles(figure, face))
            {
                // The top of a prism is cut as its bottom, which looks down.
                if (face.cut_offset > 0 && !is_wire()) std::reverse(t.begin(), t.end());
                add_flat_face({place(figure.vertices[t[0]]), place(figure.vertices[t[1]]),
                               place(figure.vertices[t[2]])});
            }
        }
    }

    /// Its sides are those of boxfill all, in the same order, whatever it is filled as.
    void draw_solid_box(const FigureOp& box)
    {
        if (is_wire() && !state_.off_lattice) add_faces(box);
        constexpr std::array<std::array<std::size_t, 4>, 6> sides{
            {{0, 3, 2, 1}, {4, 5, 6, 7}, {0, 1, 5, 4}, {2, 3, 7, 6}, {1, 2, 6, 5}, {0, 4, 7, 3}}};
        for (const auto& side : sides)
        {
            ShapeCell corners;
            for (const std::size_t i : side)
                corners.push_back(place(box.vertices[box.solid_vertices[i]]));
            add_face(std::move(corners));
        }
    }

    void draw(const SphereOp& sphere)
    {
        for (const double layer : sphere.shown_layers_dp)
            add_sphere(sphere.center, sphere.radius + layer * def_.grid.dp);
        if (sphere.layers_dp.empty()) add_sphere(sphere.center, sphere.radius);
    }

    void add_sphere(const Vec3& at, double radius)
    {
        const auto rings = sphere_rings(place(at), rounded(radius), state_.constants.sphere_sides);
        const Vec3& low = rings.front()[0];
        const Vec3& high = rings.back()[0];
        const std::vector<Vec3>& lowest = rings[1];
        const std::vector<Vec3>& highest = rings[rings.size() - 2];
        const std::size_t n = lowest.size();
        const auto next = [n](std::size_t i) { return (i + 1) % n; };
        for (std::size_t i = 0; i < n; ++i) add_face({low, lowest[i], lowest[next(i)]});
        for (std::size_t ring = 1; ring + 2 < rings.size(); ++ring)
            for (std::size_t i = 0; i < n; ++i)
                add_round_face({rings[ring][next(i)], rings[ring][i], rings[ring + 1][i],
                                rings[ring + 1][next(i)]});
        for (std::size_t i = 0; i < n; ++i) add_round_face({highest[next(i)], highest[i], high});
    }

    void draw(const CylinderOp& cylinder)
    {
        for (const CylinderLayer& layer : cylinder.layers)
            if (layer.is_shown) add_cylinder(layer, cylinder.is_visible);
        if (cylinder.layers.empty())
            add_cylinder({cylinder.p0, cylinder.p1, cylinder.radius}, cylinder.is_visible);
    }

    void add_cylinder(const CylinderLayer& cylinder, const std::array<bool, 3>& is_visible)
    {
        const Vec3 a = place(cylinder.p0);
        const Vec3 b = place(cylinder.p1);
        if (norm(b - a) == 0) return;
        const double more = snapped_ ? state_.constants.cylinder_tube * def_.grid.dp : 0;
        const auto [near, far] =
            cylinder_rings(a, b, cylinder.radius + more, state_.constants.cylinder_sides);
        const std::size_t n = near.size();
        for (std::size_t i = 0; is_visible[0] && i < n; ++i)
            add_round_face({near[i], near[(i + 1) % n], a});
        for (std::size_t i = 0; is_visible[1] && i < n; ++i)
            add_round_face({far[i], b, far[(i + 1) % n]});
        for (std::size_t i = 0; is_visible[2] && i < n; ++i)
        {
            const std::size_t j = (i + 1) % n;
            add_round_face({near[j], near[i], far[i], far[j]});
        }
    }

    /// Quads stay whole, those of a bathymetry only if they are flat; a polyline begins with a
    /// line of no length.
    void draw(const MeshFileOp& mesh)
    {
        MeshFile cut;
        const MeshFile& file = scene_.meshes->read_drawn(
            op_.source, mesh, {def_.case_pos_min, def_.case_pos_max}, cut);
        const auto placed = [&](const Vec3& v) { return place(mesh.transform(v)); };
        for (const std::vector<Vec3>& line : file.lines)
        {
            if (mesh.advanced) break; // takes surfaces only
            for (std::size_t i = 0; i < line.size(); ++i)
                add_line(placed(line[i == 0 ? 0 : i - 1]), placed(line[i]));
        }
        for_each_polygon(file, mesh, def_.grid.dp,
                         [&](const std::vector<std::uint32_t>& corners)
                         {
                             ShapeCell cell;
                             for (const std::uint32_t c : corners)
                                 cell.push_back(placed(file.soup.vertices[c]));
                             add_flat_face(std::move(cell));
                         });
    }

    /// Points, ellipsoids and waves have none.
    template <typename Other>
    void draw(const Other&)
    {
    }

    void clip(const ClipPlane& plane)
    {
        const auto beyond = [&](const Vec3& p) { return dot(p - plane.point, plane.normal); };
        const auto holds = [&](const Vec3& p) { return beyond(p) <= 0; };
        const auto crossing = [&](const Vec3& a, const Vec3& b)
        { return as_float32(a + (b - a) * (-beyond(a) / dot(plane.normal, b - a))); };
        ShapeCell kept;
        for (ShapeCell& cell : cells_)
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
        std::erase_if(cells_, [](const ShapeCell& cell) { return cell.empty(); });
    }

    const Scene& scene_;
    const CaseDef& def_;
    const DrawOp& op_;
    const DrawState& state_;
    bool snapped_;
    std::vector<ShapeCell> cells_;
};

} // namespace

bool has_shape_cells(const Command& what)
{
    const auto* shape = std::get_if<Shape>(&what);
    return shape != nullptr && has_polygons(*shape);
}

std::vector<ShapeCell> shape_cells(const Scene& scene, const DrawOp& op, bool snapped)
{
    return CellMaker(scene, op, snapped).run();
}

} // namespace fppg
