#include "lattice/paint_scene.h"

#include "fppg/combination.h"
#include "fppg/error.h"

#include "core/parallel.h"
#include "lattice/node_files.h"
#include "lattice/paint_mesh.h"
#include "scene/surfaces.h"
#include "shapes/kinds.h"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <utility>

namespace fppg
{
namespace
{

/// Of two files with one name the later one counts.
void keep(LatticeReport& report, NodeFile file)
{
    std::erase_if(report.node_files, [&](const NodeFile& f) { return f.name == file.name; });
    report.node_files.push_back(std::move(file));
}

/// Shapes are written from the case, not from its nodes.
void paint_output(Painting&, const Brush&, const ShapeOutOp&) {}

void paint_output(Painting& painting, const Brush&, const CellsOutOp& op)
{
    NodeFile file;
    file.name = "_" + op.file + "_MkCells" + op.suffix + ".vtk";
    file.is_cells = true;
    file.cells = plain_nodes(painting.canvas.field(), painting.canvas.threads());
    file.mk = op.mk;
    keep(painting.report, std::move(file));
}

void paint_output(Painting& painting, const Brush& brush, const PointsMkOutOp& op)
{
    NodeFile file;
    file.name = fmt::format("_{}_mk{}.vtk", op.file, brush.mk.mk);
    file.points = border_nodes(painting.canvas.field(), brush.mk.mk);
    keep(painting.report, std::move(file));
}

/// A shape in the way of its own kind, or by its nodes alone.
template <typename Kind>
void paint_kind(Painting& painting, const Brush& brush, const Kind& kind)
{
    if constexpr (requires { fppg::paint(painting, brush, kind); })
        fppg::paint(painting, brush, kind);
    else if (brush.state->off_lattice)
        throw CaseError(
            painting.def.file, brush.source->line,
            fmt::format("<{}>: is not possible with setfrdrawmode", brush.source->command));
    else
        painting.canvas.paint(brush, kinds::nodes_of(kind, *brush.state, painting.grid()));
}

void paint_any(Painting& painting, const Brush& brush, const Edit& edit)
{
    std::visit([&](const auto& kind) { fppg::paint(painting, brush, kind); }, edit);
}

void paint_any(Painting& painting, const Brush& brush, const Output& output)
{
    std::visit([&](const auto& kind) { paint_output(painting, brush, kind); }, output);
}

void paint_any(Painting& painting, const Brush&, const ResetOp&)
{
    painting.canvas.reset();
}

/// Shapes have steps of their own.
void paint_any(Painting&, const Brush&, const Shape&) {}

void add_fitted(Painting& painting, FittedStep& fitted)
{
    for (std::string& w : fitted.warnings) painting.report.warnings.push_back(std::move(w));
    for (FittedDraw& draw : fitted.draws)
    {
        painting.report.triangles += draw.body.report.facets_read;
        for (std::string& w : draw.warnings) painting.report.warnings.push_back(std::move(w));
        painting.canvas.add_wall(std::move(draw));
    }
}

/// A shape on the lattice, or its true surface where it was fitted.
void paint_shape(Painting& painting, const DrawOp& draw, FittedStep& fitted)
{
    Brush brush(draw);
    const auto& shape = std::get<Shape>(draw.what);
    const auto* file = std::get_if<MeshFileOp>(&shape);
    if (file != nullptr)
        check_mesh(painting, draw, mesh_of(painting, brush, *file), file->transform);
    else if (painting.def.zone == 0) // the limits of other zones are meant to cut shapes
        painting.checks.check_shape(draw, bounds_of(shape, painting.grid().dp));
    add_fitted(painting, fitted);
    brush.spares_walls = painting.canvas.cut_walls(draw.source, fitted);
    if (!fitted.is_fitted)
        std::visit([&](const auto& kind) { paint_kind(painting, brush, kind); }, shape);
    else if (file != nullptr && !file->advanced)
        paint_points_and_lines(painting, brush, mesh_of(painting, brush, *file), file->transform);
}

/// The nodes that the draw of a part takes on an empty lattice.
SpanSet nodes_of(Painting& painting, const DrawOp& draw)
{
    DrawState state = *draw.state;
    state.mk = {MkKind::Bound, std::max<std::uint16_t>(painting.def.mk_bound_first, 1), 0};
    DrawOp alone = draw;
    alone.state = std::make_shared<const DrawState>(state);
    const int threads = painting.canvas.threads();
    Painting empty(painting.scene, threads, painting.report);
    FittedStep not_fitted;
    paint_shape(empty, alone, not_fitted);
    const RunField field = empty.canvas.take();
    SpanSet out;
    out.slabs.resize(field.slabs.size());
    parallel_for(field.slabs.size(), threads,
                 [&](std::size_t x) { out.slabs[x] = occupied(field.slabs[x]); });
    return out;
}

/// A combination on the lattice: by interval operations on the nodes of its parts.
void paint_nodes(Painting& painting, const Combination& combination)
{
    const int threads = painting.canvas.threads();
    const BooleanNode& tree = combination.boolean->tree;
    std::vector<SpanSet> sets;
    for (const DrawOp* part : combination.parts) sets.push_back(nodes_of(painting, *part));
    const SpanSet nodes = boolean_spans(sets, tree, threads);
    const std::vector<SpanSet> shares = share_out(nodes, sets, tree, threads);
    for (std::size_t p = 0; p < shares.size(); ++p)
    {
        if (shares[p].slabs.empty()) continue;
        Brush brush(combination.whole);
        brush.mk = combination.mks[p];
        painting.canvas.paint(brush, region_of(shares[p]));
    }
    if (nodes.slabs.empty())
        painting.report.warnings.push_back(
            fmt::format("{}: nothing is left of its parts on the lattice",
                        place_of(painting.def, combination.whole.source)));
}

void paint_combination(Painting& painting, const Combination& combination, FittedStep& fitted)
{
    if (!fitted.is_fitted)
    {
        paint_nodes(painting, combination);
        return;
    }
    for (const DrawOp* part : combination.parts) // so that the report names their files
        if (const auto* file = shape_as<MeshFileOp>(*part)) mesh_of(painting, Brush(*part), *file);
    add_fitted(painting, fitted);
}

void paint_step(Painting& painting, const SceneStep& step, FittedStep& fitted)
{
    if (step.combination)
        paint_combination(painting, *step.combination, fitted);
    else if (step.shape() != nullptr)
        paint_shape(painting, *step.draw, fitted);
    else if (!step.is_part)
        std::visit([&](const auto& what) { paint_any(painting, Brush(*step.draw), what); },
                   step.draw->what);
}

} // namespace

RunField paint_scene(const Scene& scene, std::vector<FittedStep>&& fitted, int threads,
                     const LatticeProgress& progress, LatticeReport& report)
{
    Painting painting(scene, threads, report);
    for (std::size_t i = 0; i < scene.steps.size(); ++i)
    {
        if (progress) progress(i, scene.steps.size());
        paint_step(painting, scene.steps[i], fitted[i]);
        fitted[i] = {};
    }
    return painting.canvas.take();
}

RunField draw_on_lattice(const Scene& scene, int threads, const LatticeProgress& progress,
                         LatticeReport& report)
{
    return paint_scene(scene, std::vector<FittedStep>(scene.steps.size()), threads, progress,
                       report);
}

} // namespace fppg
