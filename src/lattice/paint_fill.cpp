// Fills and redraws.
#include "fppg/error.h"

#include "lattice/cavity_fill.h"
#include "lattice/fill_level.h"
#include "lattice/flood.h"
#include "lattice/limits.h"
#include "lattice/mesh_units.h"
#include "lattice/redraw.h"
#include "platform/memory.h"
#include "scene/surfaces.h"

#include <fmt/format.h>

#include <algorithm>

namespace fppg
{
namespace
{

/// An index of all columns of a fill's box is kept while it runs.
void check_columns(const Painting& painting, const Brush& brush, const NodeBox& box)
{
    constexpr double bytes_per_indexed_column = 40;
    if (box.is_empty()) return;
    const double columns = static_cast<double>(box.end[0] - box.begin[0]) *
                           static_cast<double>(box.end[1] - box.begin[1]);
    if (columns * bytes_per_indexed_column > static_cast<double>(available_memory()))
        throw CaseError(
            painting.def.file, brush.source->line,
            fmt::format("<{}>: the fill reaches over {:g} columns of nodes, more than fit into "
                        "this machine's memory; <fillbox> limits it",
                        brush.source->command, columns));
}

std::string why_nothing_is_filled(const Painting& painting, const Node& seed, const Limits& limits)
{
    if (!is_inside(seed, painting.grid()))
        return "is outside the domain; expected a place between <pointmin> and <pointmax>";
    const auto x = static_cast<std::size_t>(seed.x);
    const auto y = static_cast<std::uint32_t>(seed.y);
    const auto z = static_cast<std::uint32_t>(seed.z);
    const auto holds = [&](const auto& s) { return s.y == y && s.z_begin <= z && z < s.z_end; };
    const auto is_in_box = [&](int axis)
    {
        const auto k = static_cast<std::size_t>(axis);
        return limits.box.begin[k] <= seed[axis] && seed[axis] < limits.box.end[k];
    };
    const auto is_masked = [&](const SpanSet& mask)
    { return std::none_of(mask.slabs[x].begin(), mask.slabs[x].end(), holds); };
    if (!is_in_box(0) || !is_in_box(1) || !is_in_box(2) || (limits.mask && is_masked(*limits.mask)))
        return "is outside the region that limits the fill; expected a place strictly inside it";
    const std::vector<Run>& runs = painting.canvas.field().slabs[x];
    const auto run = std::find_if(runs.begin(), runs.end(), holds);
    if (run == runs.end())
        return "is on a node where nothing is drawn, which <modefill> does not name; add void "
               "there";
    const CaseDef& def = painting.def;
    const int mk = run->mk;
    const bool is_bound = mk >= def.mk_bound_first;
    return fmt::format(
        "lies in {} {}, which <modefill> does not name; expected a place in the "
        "empty space to be filled",
        is_bound ? "the solid of mkbound" : "mkfluid",
        mk - (is_bound ? def.mk_bound_first : def.mk_fluid_first));
}

/// A node larger on each side, within the lattice.
NodeBox grown(NodeBox box, const LatticeGrid& grid)
{
    for (std::size_t axis = 0; axis < 3; ++axis)
    {
        --box.begin[axis];
        ++box.end[axis];
    }
    return intersect(box, whole_lattice(grid));
}

/// With a boundary mk walls keep their place and take the new mk.
Brush redraw_brush(const Brush& brush)
{
    Brush out = brush;
    out.keeps_walls = brush.mk.kind == MkKind::Bound;
    return out;
}

} // namespace

std::vector<Spans> Limits::kept(std::vector<Spans> nodes) const
{
    if (mask)
        for (std::size_t x = 0; x < nodes.size(); ++x)
            nodes[x] = intersect(nodes[x], mask->slabs[x]);
    return nodes;
}

void Limits::keep_within(const SpanSet& nodes)
{
    if (nodes.slabs.empty()) return;
    if (!mask)
        mask = nodes;
    else
        mask->slabs = kept(nodes.slabs);
}

NodeBox node_box(const BoxRegion& region, const LatticeGrid& grid)
{
    const Node a = snap(region.corner0, grid);
    const Node b = snap(region.corner1, grid);
    NodeBox box;
    for (int axis = 0; axis < 3; ++axis)
    {
        const auto k = static_cast<std::size_t>(axis);
        box.begin[k] = std::min(a[axis], b[axis]) + 1;
        box.end[k] = std::max(a[axis], b[axis]);
    }
    return intersect(box, whole_lattice(grid));
}

SpanSet mask_of(const Painting& painting, const Brush& brush, const PolyhedronOp& polyhedron)
{
    SpanSet mask;
    mask.slabs.resize(painting.grid().n[0]);
    const SlabRegion inside = solid_of(polyhedron, *brush.state, painting.grid());
    for (std::uint32_t x = inside.x_begin; x < inside.x_end; ++x)
        mask.slabs[x] = listed(inside, x, {}, painting.grid());
    return mask;
}

Limits limits_of(const Painting& painting, const Brush& brush,
                 const std::optional<BoxLimits>& region)
{
    Limits limits{whole_lattice(painting.grid()), {}};
    if (!region) return limits;
    if (const auto* box = std::get_if<BoxRegion>(&*region))
        limits.box = node_box(*box, painting.grid());
    else
        limits.mask = mask_of(painting, brush, std::get<PolyhedronOp>(*region));
    return limits;
}

void paint(Painting& painting, const Brush& brush, const FillOp& op)
{
    Limits limits = limits_of(painting, brush, op.region);
    const std::size_t number = painting.floods++;
    if (number < painting.scene.fill_limits.size())
        limits.keep_within(painting.scene.fill_limits[number]);
    check_columns(painting, brush, limits.box);
    const Canvas& canvas = painting.canvas;
    const Node seed = snap(op.seed, painting.grid());
    const std::vector<char> fillable = fillable_mks(op.filter, painting.def.mk_bound_first);
    const std::vector<Spans> nodes =
        flood(canvas.field(), seed, fillable, limits.box, limits.mask_used(), canvas.threads());
    if (painting.report.keeps_floods)
    {
        SpanSet& reached = painting.report.flooded.emplace_back();
        if (!limits.mask)
            reached.slabs = flood(canvas.field(), seed, fillable,
                                  grown(limits.box, painting.grid()), nullptr, canvas.threads());
    }
    if (brush.state->draw_points && node_count(nodes) == 0)
        painting.report.warnings.push_back(
            fmt::format("{}: the fill added no node: its seed ({:g}, {:g}, {:g}) {}",
                        place_of(painting.def, *brush.source), op.seed.x, op.seed.y, op.seed.z,
                        why_nothing_is_filled(painting, seed, limits)));
    painting.checks.check_fill(*brush.source, *brush.state, nodes);
    painting.canvas.paint(brush, nodes);
}

void paint(Painting& painting, const Brush& brush, const CavityFillOp& op)
{
    const std::string place = place_of(painting.def, *brush.source);
    CavityFillReport said;
    try
    {
        const std::vector<Spans> nodes =
            fill_cavity(painting.canvas.field(), op, painting.canvas.threads(), said);
        said.filled.line = brush.source->line;
        for (const std::string& line : said.log)
            said.filled.log.push_back(fmt::format("{}: {}", place, line));
        painting.report.fills.push_back(std::move(said.filled));
        for (const std::string& w : said.warnings)
            painting.report.warnings.push_back(fmt::format("{}: {}", place, w));
        painting.canvas.paint(brush, nodes);
    }
    catch (const GeometryError& e)
    {
        throw GeometryError(
            fmt::format("{}: {}{}", place, e.what(),
                        suspected_units(painting.scene, painting.canvas.threads())));
    }
}

void paint(Painting& painting, const Brush& brush, const RedrawOp& op)
{
    const Limits limits = limits_of(painting, brush, op.region);
    painting.canvas.paint(
        redraw_brush(brush),
        limits.kept(redraw_nodes(painting.canvas.field(), op, limits.box,
                                 painting.def.mk_bound_first, painting.canvas.threads())));
    // With <setmkvoid/> cases take away what they drew for a shape file.
    if (brush.mk.kind == MkKind::Void && painting.canvas.is_empty()) painting.canvas.reset();
}

void paint(Painting& painting, const Brush& brush, const RedrawNearOp& op)
{
    const Limits limits = limits_of(painting, brush, op.region);
    for (int i = 0; i < op.times; ++i)
        painting.canvas.paint(
            redraw_brush(brush),
            redraw_near_nodes(painting.canvas.field(), op, limits.box, limits.mask_used(),
                              painting.def.mk_bound_first, painting.canvas.threads()));
}

} // namespace fppg
