#include "fppg/case_def.h"
#include "fppg/domain_clip.h"
#include "fppg/files.h"
#include "fppg/lattice.h"
#include "fppg/shapes.h"

#include "casedef/file_polygons.h"
#include "casedef/mesh_path.h"
#include "lattice/cylinder_rings.h"
#include "lattice/plane_shapes.h"
#include "lattice/snap.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <numbers>

namespace fppg
{
namespace
{

class ShapeCollector
{
public:
    explicit ShapeCollector(const CaseDef& def) : def_(def) {}

    std::vector<ShapeFile> run()
    {
        const bool has_output = std::any_of(
            def_.ops.begin(), def_.ops.end(),
            [](const DrawOp& op) { return std::holds_alternative<ShapeOutOp>(op.what); });
        if (!has_output) return {};
        for (const DrawOp& op : def_.ops)
        {
            if (std::holds_alternative<ResetOp>(op.what))
                kept_ = {};
            else if (const auto* out = std::get_if<ShapeOutOp>(&op.what))
                write(*out, op.state->shape_mode);
            else if (op.state->draw_shapes && is_shape(op.what) && !is_later_part(op.what))
                keep_shape(op);
        }
        return std::move(files_);
    }

private:
    static bool is_shape(const DrawVariant& what)
    {
        return std::holds_alternative<LinesOp>(what) || std::holds_alternative<FigureOp>(what) ||
               std::holds_alternative<SphereOp>(what) || std::holds_alternative<CylinderOp>(what) ||
               std::holds_alternative<MeshFileOp>(what);
    }

    /// Of a figure drawn part by part the first stands for the whole.
    static bool is_later_part(const DrawVariant& what)
    {
        const auto* figure = std::get_if<FigureOp>(&what);
        return figure != nullptr && figure->part > 0;
    }

    void keep_shape(const DrawOp& op)
    {
        const ShapeMode& mode = op.state->shape_mode;
        if (!mode.kinds[static_cast<std::size_t>(op.state->mk.kind)]) return;
        if (mode.actual) kept_[0].push_back(&op);
        if (mode.snapped) kept_[1].push_back(&op);
    }

    void write(const ShapeOutOp& out, const ShapeMode& mode)
    {
        for (const bool snapped : {true, false})
        {
            if (!(snapped ? mode.snapped : mode.actual)) continue;
            std::vector<const DrawOp*>& ops = kept_[snapped ? 1 : 0];
            write_form(out, ops, snapped);
            if (out.reset) ops.clear();
        }
    }

    void write_form(const ShapeOutOp& out, const std::vector<const DrawOp*>& ops, bool snapped)
    {
        ShapeFile file;
        constexpr std::array<const char*, 4> endings{".vtk", ".vtp", ".vtu", ".stl"};
        const char* ending = endings[static_cast<std::size_t>(out.format)];
        const std::string stem = "_" + out.file + (snapped ? "_Dp" : "_Actual");
        file.name = stem + ending;
        file.format = out.format;
        std::uint32_t id = 0;
        for (const DrawOp* op : ops)
        {
            ShapePolygons shape = polygons(*op, snapped);
            shape.object_id = id++;
            shape.mk = op->state->mk.kind == MkKind::Void ? -1 : op->state->mk.mk;
            if (op->state->normal_invert)
                for (auto& p : shape.polygons)
                    if (p.size() > 2) std::reverse(p.begin(), p.end());
            if (!shape.polygons.empty()) file.shapes.push_back(std::move(shape));
        }
        if (file.shapes.empty()) return;
        if (out.normal_dp != 0)
        {
            ShapeFile shown = file;
            shown.name = stem + "_Nor" + ending;
            shown.has_normals = true;
            std::vector<ShapePolygons> lines = normals(file.shapes, id, out.normal_dp);
            shown.shapes.insert(shown.shapes.begin(), std::make_move_iterator(lines.begin()),
                                std::make_move_iterator(lines.end()));
            keep(std::move(file));
            file = std::move(shown);
        }
        keep(std::move(file));
    }

    /// Of two files with one name the later one counts.
    void keep(ShapeFile file)
    {
        std::erase_if(files_, [&](const ShapeFile& f) { return f.name == file.name; });
        files_.push_back(std::move(file));
    }

    /// A line along the normal of every face from the middle of its corners, with the mk of the
    /// face and an object number of their own, as in GenCase v5.4.354.
    std::vector<ShapePolygons> normals(const std::vector<ShapePolygons>& shapes, std::uint32_t id,
                                       double length_dp) const
    {
        std::vector<ShapePolygons> out;
        for (const ShapePolygons& shape : shapes)
        {
            ShapePolygons lines;
            lines.object_id = id;
            lines.mk = shape.mk;
            for (const auto& polygon : shape.polygons)
            {
                if (polygon.size() < 3) continue;
                Vec3 middle;
                for (const std::uint32_t v : polygon) middle = middle + shape.vertices[v];
                middle = middle / static_cast<double>(polygon.size());
                const Vec3& a = shape.vertices[polygon[0]];
                Vec3 normal = cross(shape.vertices[polygon[1]] - a, shape.vertices[polygon[2]] - a);
                if (norm(normal) > 0) normal = normal / norm(normal);
                const auto i = static_cast<std::uint32_t>(lines.vertices.size());
                lines.vertices.push_back(middle);
                lines.vertices.push_back(middle + normal * (length_dp * def_.grid.dp));
                lines.polygons.push_back({i, i + 1});
            }
            if (!lines.polygons.empty()) out.push_back(std::move(lines));
        }
        return out;
    }

    Vec3 place(const Vec3& p, bool snapped) const
    {
        return snapped ? position(snap(p, def_.grid), def_.grid) : p;
    }

    ShapePolygons polygons(const DrawOp& op, bool snapped) const
    {
        ShapePolygons out;
        const DrawConstants& constants = op.state->constants;
        if (const auto* lines = std::get_if<LinesOp>(&op.what))
            for (const auto& [from, to] : lines->segments)
            {
                const auto i = static_cast<std::uint32_t>(out.vertices.size());
                out.vertices.push_back(place(from, snapped));
                out.vertices.push_back(place(to, snapped));
                out.polygons.push_back({i, i + 1});
            }
        else if (const auto* figure = std::get_if<FigureOp>(&op.what))
        {
            for (const Vec3& v : figure->vertices) out.vertices.push_back(place(v, snapped));
            for (const FigureFace& f : figure->faces)
                if (f.is_visible) out.polygons.push_back(f.vertices);
        }
        else if (const auto* sphere = std::get_if<SphereOp>(&op.what))
            add_sphere(out, place(sphere->center, snapped), radius(sphere->radius, snapped),
                       constants.sphere_sides);
        else if (const auto* cylinder = std::get_if<CylinderOp>(&op.what))
            add_cylinder(out, *cylinder, place(cylinder->p0, snapped), place(cylinder->p1, snapped),
                         radius(cylinder->radius, snapped), constants.cylinder_sides);
        else if (const auto* mesh = std::get_if<MeshFileOp>(&op.what))
        {
            add_mesh(out, *mesh, find_mesh_file(def_, op.source, mesh->file), snapped);
        }
        return out;
    }

    /// Quads stay whole, those of a bathymetry only if they are flat; a polyline begins with a
    /// line of no length. As in the files of GenCase v5.4.354.
    void add_mesh(ShapePolygons& out, const MeshFileOp& op, const std::string& path,
                  bool snapped) const
    {
        const MeshFile file =
            op.clip_resize && !op.advanced
                ? read_clipped(path, op.reading, op.transform,
                               clip_box(def_.case_pos_min, def_.case_pos_max, *op.clip_resize))
                : read_mesh_file(path, op.reading);
        const auto add_vertex = [&](const Vec3& v)
        {
            out.vertices.push_back(place(op.transform(v), snapped));
            return static_cast<std::uint32_t>(out.vertices.size() - 1);
        };
        for (const std::vector<Vec3>& line : file.lines)
        {
            if (op.advanced) break; // takes surfaces only
            std::uint32_t before = add_vertex(line[0]);
            out.polygons.push_back({before, before});
            for (std::size_t i = 1; i < line.size(); ++i)
            {
                const std::uint32_t next = add_vertex(line[i]);
                out.polygons.push_back({before, next});
                before = next;
            }
        }
        const auto first = static_cast<std::uint32_t>(out.vertices.size());
        for (const Vec3& v : file.soup.vertices) add_vertex(v);
        for_each_polygon(file, op, def_.grid.dp,
                         [&](std::vector<std::uint32_t> corners)
                         {
                             for (std::uint32_t& c : corners) c += first;
                             out.polygons.push_back(std::move(corners));
                         });
    }

    double radius(double r, bool snapped) const
    {
        return snapped ? std::floor(r / def_.grid.dp + 0.5) * def_.grid.dp : r;
    }

    static void add_sphere(ShapePolygons& out, const Vec3& center, double r, int sides)
    {
        const auto n = static_cast<std::uint32_t>(sides);
        out.vertices.push_back(center - Vec3{0, 0, r});
        for (std::uint32_t ring = 1; ring < n; ++ring)
            for (std::uint32_t i = 0; i < n; ++i)
            {
                const double polar = std::numbers::pi * ring / n;
                const double turn = -std::numbers::pi / 2 - 2 * std::numbers::pi * i / n;
                out.vertices.push_back(center + Vec3{r * std::sin(polar) * std::cos(turn),
                                                     r * std::sin(polar) * std::sin(turn),
                                                     -r * std::cos(polar)});
            }
        out.vertices.push_back(center + Vec3{0, 0, r});
        const auto at = [n](std::uint32_t ring, std::uint32_t i)
        { return 1 + (ring - 1) * n + i % n; };
        const auto top = static_cast<std::uint32_t>(out.vertices.size() - 1);
        for (std::uint32_t i = 0; i < n; ++i) out.polygons.push_back({0, at(1, i), at(1, i + 1)});
        for (std::uint32_t ring = 1; ring + 1 < n; ++ring)
            for (std::uint32_t i = 0; i < n; ++i)
                out.polygons.push_back(
                    {at(ring, i + 1), at(ring, i), at(ring + 1, i), at(ring + 1, i + 1)});
        for (std::uint32_t i = 0; i < n; ++i)
            out.polygons.push_back({at(n - 1, i + 1), at(n - 1, i), top});
    }

    static void add_cylinder(ShapePolygons& out, const CylinderOp& cylinder, const Vec3& a,
                             const Vec3& b, double r, int sides)
    {
        if (norm(b - a) == 0) return;
        const auto n = static_cast<std::uint32_t>(sides);
        const auto rings = cylinder_rings(a, b, r, sides);
        for (const std::vector<Vec3>& ring : rings)
            out.vertices.insert(out.vertices.end(), ring.begin(), ring.end());
        out.vertices.push_back(a);
        out.vertices.push_back(b);
        const auto for_each_side = [&](const auto& add)
        {
            for (std::uint32_t i = 0; i < n; ++i) add(i, (i + 1) % n);
        };
        const auto add = [&](std::vector<std::uint32_t> corners)
        { out.polygons.push_back(std::move(corners)); };
        if (cylinder.is_visible[0])
            for_each_side([&](std::uint32_t i, std::uint32_t j) { add({i, j, 2 * n}); });
        if (cylinder.is_visible[1])
            for_each_side(
                [&](std::uint32_t i, std::uint32_t j) {
                    add({n + i, 2 * n + 1, n + j});
                });
        if (cylinder.is_visible[2])
            for_each_side([&](std::uint32_t i, std::uint32_t j) { add({j, i, n + i, n + j}); });
    }

    const CaseDef& def_;
    std::array<std::vector<const DrawOp*>, 2> kept_; ///< by form: actual, snapped
    std::vector<ShapeFile> files_;
};

} // namespace

std::vector<ShapeFile> collect_shape_files(const CaseDef& def)
{
    return ShapeCollector(def).run();
}

} // namespace fppg
