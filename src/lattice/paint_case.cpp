// Executes the draws of a case in order.
#include "core/parallel.h"
#include "lattice/fitted_draws.h"
#include "lattice/node_files.h"
#include "lattice/paint_mesh.h"

#include <fmt/format.h>

#include <algorithm>
#include <memory>

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

void paint(Painting& painting, const Brush&, const ResetOp&)
{
    painting.canvas.reset();
}

/// Shapes are written from the case, not from its nodes.
void paint(Painting&, const Brush&, const ShapeOutOp&) {}

void paint(Painting& painting, const Brush&, const CellsOutOp& op)
{
    NodeFile file;
    file.name = "_" + op.file + "_MkCells" + op.suffix + ".vtk";
    file.is_cells = true;
    file.cells = plain_nodes(painting.canvas.field(), painting.canvas.threads());
    file.mk = op.mk;
    keep(painting.report, std::move(file));
}

void paint(Painting& painting, const Brush& brush, const PointsMkOutOp& op)
{
    NodeFile file;
    file.name = fmt::format("_{}_mk{}.vtk", op.file, brush.mk.mk);
    file.points = border_nodes(painting.canvas.field(), brush.mk.mk);
    keep(painting.report, std::move(file));
}

void paint_draw(Painting& painting, const DrawOp& draw, bool fits_walls)
{
    const Brush brush(draw);
    if (const auto* file = std::get_if<MeshFileOp>(&draw.what))
        check_mesh(painting, draw, mesh_of(painting, brush, *file), file->transform);
    else if (painting.def.zone == 0) // the limits of other zones are meant to cut shapes
        painting.checks.check_shape(draw, bounds_of(draw, painting.grid().dp));
    if (fits_walls && paint_fitted(painting, brush, draw)) return;
    std::visit([&](const auto& what) { paint(painting, brush, what); }, draw.what);
}

/// The nodes that the draw of a part takes on an empty lattice.
SpanSet nodes_of(Painting& painting, const DrawOp& draw)
{
    DrawState state = *draw.state;
    state.mk = {MkKind::Bound, std::max<std::uint16_t>(painting.def.mk_bound_first, 1), 0};
    DrawOp alone = draw;
    alone.state = std::make_shared<const DrawState>(state);
    const int threads = painting.canvas.threads();
    Painting empty(painting.def, painting.meshes, threads, painting.report);
    paint_draw(empty, alone, false);
    const RunField field = empty.canvas.take();
    SpanSet out;
    out.slabs.resize(field.slabs.size());
    parallel_for(field.slabs.size(), threads,
                 [&](std::size_t x) { out.slabs[x] = occupied(field.slabs[x]); });
    return out;
}

/// A combination on the lattice, by interval operations on the nodes of its parts.
void paint_nodes(Painting& painting, const BooleanDef& boolean, const DrawOp& whole)
{
    const int threads = painting.canvas.threads();
    std::vector<SpanSet> sets;
    for (const BooleanDef::Part& part : boolean.parts)
        sets.push_back(nodes_of(painting, painting.def.ops[part.op]));
    const SpanSet nodes = boolean_spans(sets, boolean.tree, threads);
    const std::vector<SpanSet> shares = share_out(nodes, sets, boolean.tree, threads);
    for (std::size_t p = 0; p < shares.size(); ++p)
    {
        if (shares[p].slabs.empty()) continue;
        Brush brush(whole);
        brush.mk = mk_of_part(painting.def, boolean, p);
        painting.canvas.paint(brush, region_of(shares[p]));
    }
    if (nodes.slabs.empty())
        painting.report.warnings.push_back(
            fmt::format("{}: nothing is left of its parts on the lattice",
                        place_of(painting.def, whole.source)));
}

void paint_boolean(Painting& painting, const BooleanDef& boolean)
{
    const CaseDef& def = painting.def;
    const std::vector<char> stays = staying_parts(boolean.tree, boolean.parts.size());
    const auto first =
        static_cast<std::size_t>(std::find(stays.begin(), stays.end(), 1) - stays.begin());
    // The result has the state of its first part, and stands where the boolean does.
    DrawState state = *def.ops[boolean.parts[first].op].state;
    state.mk = mk_of_part(def, boolean, first);
    DrawOp whole;
    whole.source = {boolean.line, "boolean", boolean.name};
    whole.state = std::make_shared<const DrawState>(state);
    const FitSettings* settings =
        state.mk.kind == MkKind::Bound ? fit_settings(def.fit, state.mk.mk) : nullptr;
    if (settings != nullptr)
        paint_fitted(painting, boolean, whole, *settings);
    else
        paint_nodes(painting, boolean, whole);
}

/// Parts of booleans are drawn together, where the last of them stands.
void paint_step(Painting& painting, std::size_t i)
{
    bool is_part = false;
    for (const BooleanDef& boolean : painting.def.booleans)
    {
        if (!boolean.is_drawn) continue;
        std::size_t last = 0;
        bool is_its_part = false;
        for (const BooleanDef::Part& part : boolean.parts)
        {
            last = std::max(last, part.op);
            is_its_part = is_its_part || part.op == i;
        }
        is_part = is_part || is_its_part;
        if (last == i) paint_boolean(painting, boolean);
    }
    if (!is_part) paint_draw(painting, painting.def.ops[i], true);
}

} // namespace

RunField generate_lattice(const CaseDef& def, int threads, const LatticeProgress& progress,
                          LatticeReport& report)
{
    MeshLibrary meshes(def.file);
    Painting painting(def, meshes, threads, report);
    for (std::size_t i = 0; i < def.ops.size(); ++i)
    {
        if (progress) progress(i, def.ops.size());
        paint_step(painting, i);
    }
    return painting.canvas.take();
}

} // namespace fppg
