#include "scene/shape_files.h"

#include "fppg/files.h"
#include "fppg/lattice.h"

#include "core/float32.h"
#include "scene/shape_cells.h"

#include <algorithm>
#include <array>
#include <iterator>

namespace fppg
{
namespace
{

constexpr std::array<const char*, 4> endings{".vtk", ".vtp", ".vtu", ".stl"};

const ShapeOutOp* output_of(const SceneStep& step)
{
    const auto* output = std::get_if<Output>(&step.draw->what);
    return output != nullptr ? std::get_if<ShapeOutOp>(output) : nullptr;
}

/// The draws whose shapes the next `shapeout` writes, by form: actual, snapped.
class KeptDraws
{
public:
    void clear() { kept_ = {}; }

    void keep(const DrawOp& op)
    {
        const ShapeMode& mode = op.state->shape_mode;
        if (!mode.kinds[static_cast<std::size_t>(op.state->mk.kind)]) return;
        if (mode.actual) kept_[0].push_back(&op);
        if (mode.snapped) kept_[1].push_back(&op);
    }

    void write(const ShapeOutOp& out, const ShapeMode& mode, std::vector<ShapeFileDraws>& files)
    {
        for (const bool snapped : {true, false})
        {
            if (!(snapped ? mode.snapped : mode.actual)) continue;
            std::vector<const DrawOp*>& ops = kept_[snapped ? 1 : 0];
            const std::string stem = "_" + out.file + (snapped ? "_Dp" : "_Actual");
            files.push_back({stem, out.format, snapped, out.normal_dp, ops});
            if (out.reset) ops.clear();
        }
    }

private:
    std::array<std::vector<const DrawOp*>, 2> kept_;
};

class ShapeCollector
{
public:
    explicit ShapeCollector(const Scene& scene) : scene_(scene) {}

    std::vector<ShapeFile> run()
    {
        for (const ShapeFileDraws& draws : shape_file_draws(scene_)) write(draws);
        return std::move(files_);
    }

private:
    void write(const ShapeFileDraws& draws)
    {
        ShapeFile file;
        file.name = draws.name();
        file.format = draws.format;
        for (const DrawOp* op : draws.draws) add_cells(*op, draws.is_snapped, file.shapes);
        if (file.shapes.empty()) return;
        if (draws.normal_dp != 0)
        {
            ShapeFile shown = file;
            shown.name = draws.stem + "_Nor" + endings[static_cast<std::size_t>(draws.format)];
            shown.has_normals = true;
            std::vector<ShapePolygons> lines = normals(file.shapes, draws.normal_dp);
            shown.shapes.insert(shown.shapes.begin(), std::make_move_iterator(lines.begin()),
                                std::make_move_iterator(lines.end()));
            keep(std::move(file));
            file = std::move(shown);
        }
        keep(std::move(file));
    }

    /// Objects count from 0 in every file, one a command that leaves cells. Corners are float32,
    /// as in the files, also for the normals that are made of them.
    void add_cells(const DrawOp& op, bool snapped, std::vector<ShapePolygons>& shapes)
    {
        const std::vector<ShapeCell> cells = shape_cells(scene_, op, snapped);
        if (cells.empty()) return;
        const bool is_same = !shapes.empty() && call_ == op.call;
        const int mk = op.state->mk.kind == MkKind::Void ? 0 : op.state->mk.mk;
        if (!is_same || shapes.back().mk != mk)
        {
            ShapePolygons shape;
            if (!shapes.empty()) shape.object_id = shapes.back().object_id + (is_same ? 0 : 1);
            shape.mk = mk;
            shapes.push_back(std::move(shape));
        }
        call_ = op.call;
        ShapePolygons& shape = shapes.back();
        for (const ShapeCell& cell : cells)
        {
            std::vector<std::uint32_t>& polygon = shape.polygons.emplace_back();
            for (const Vec3& corner : cell)
            {
                polygon.push_back(static_cast<std::uint32_t>(shape.vertices.size()));
                shape.vertices.push_back(as_float32(corner));
            }
        }
    }

    /// Of two files with one name the later one counts.
    void keep(ShapeFile file)
    {
        std::erase_if(files_, [&](const ShapeFile& f) { return f.name == file.name; });
        files_.push_back(std::move(file));
    }

    /// A line along the normal of every face from the middle of its corners, with the mk of the
    /// face and an object number of their own, as in GenCase v5.4.354.
    std::vector<ShapePolygons> normals(const std::vector<ShapePolygons>& shapes,
                                       double length_dp) const
    {
        std::vector<ShapePolygons> out;
        const std::uint32_t id = shapes.back().object_id + 1;
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
                lines.vertices.push_back(middle + normal * (length_dp * scene_.def->grid.dp));
                lines.polygons.push_back({i, i + 1});
            }
            if (!lines.polygons.empty()) out.push_back(std::move(lines));
        }
        return out;
    }

    const Scene& scene_;
    std::size_t call_ = 0; ///< of the cells that were added last
    std::vector<ShapeFile> files_;
};

} // namespace

std::string ShapeFileDraws::name() const
{
    return stem + endings[static_cast<std::size_t>(format)];
}

std::vector<ShapeFileDraws> shape_file_draws(const Scene& scene)
{
    std::vector<ShapeFileDraws> out;
    KeptDraws kept;
    for (const SceneStep& step : scene.steps)
    {
        if (step.combination) continue; // its parts are written
        const DrawOp& op = *step.draw;
        if (std::holds_alternative<ResetOp>(op.what))
            kept.clear();
        else if (const ShapeOutOp* output = output_of(step))
            kept.write(*output, op.state->shape_mode, out);
        else if (op.state->draw_shapes && has_shape_cells(op.what))
            kept.keep(op);
    }
    return out;
}

std::vector<ShapeFile> collect_shape_files(const Scene& scene)
{
    return ShapeCollector(scene).run();
}

} // namespace fppg
