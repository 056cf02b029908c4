#include "lattice/canvas.h"

#include "fppg/error.h"

#include "core/parallel.h"
#include "lattice/draw_pattern.h"
#include "lattice/zone_clip.h"
#include "platform/memory.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace fppg
{

Brush::Brush(const DrawOp& op) : source(&op.source), state(op.state.get()), mk(op.state->mk)
{
    if (const auto* edit = std::get_if<Edit>(&op.what))
    {
        heeds_pattern = !std::holds_alternative<RedrawNearOp>(*edit);
        empties_left_out = std::holds_alternative<FillOp>(*edit);
    }
}

Brush Brush::of_part(std::uint32_t steps) const
{
    Brush part = *this;
    if (mk.kind != MkKind::Void) part.mk.mk = static_cast<std::uint16_t>(mk.mk + steps);
    return part;
}

Canvas::Canvas(const CaseDef& def, int threads)
    : def_(def),
      threads_(threads),
      walls_(field_, threads),
      off_lattice_(field_, threads),
      run_limit_(available_memory() / 5 * 4 / sizeof(Run))
{
    field_.grid = def.grid;
    field_.slabs.resize(def.grid.n[0]);
}

void Canvas::paint(const Brush& brush, const SlabRegion& region)
{
    if (!brush.state->draw_points || region.x_end <= region.x_begin) return;
    const std::vector<ClipPlane> none;
    const std::vector<ClipPlane>& clips = brush.is_clipped ? brush.state->clips : none;
    parallel_for(region.x_end - region.x_begin, threads_,
                 [&](std::size_t i)
                 {
                     const auto x = region.x_begin + static_cast<std::uint32_t>(i);
                     paint_slab(brush, x, listed(region, x, clips, grid()));
                 });
}

void Canvas::paint(const Brush& brush, const std::vector<Spans>& nodes)
{
    if (!brush.state->draw_points) return;
    parallel_for(nodes.size(), threads_, [&](std::size_t x) { paint_slab(brush, x, nodes[x]); });
}

void Canvas::paint_off_lattice(const Brush& brush, const std::vector<Vec3>& points)
{
    Brush plain = brush;
    plain.heeds_pattern = false;
    paint(plain, off_lattice_.draw(points, brush.state->clips, brush.mk.mk));
}

void Canvas::paint_slab(const Brush& brush, std::size_t x, const Spans& spans)
{
    const DrawState& state = *brush.state;
    if (!state.pattern || !brush.heeds_pattern)
    {
        paint_slab(brush, x, spans, brush.mk);
        return;
    }
    const PatternSplit split =
        split_by_pattern(*state.pattern, spans, static_cast<std::uint32_t>(x));
    paint_slab(brush, x, split.drawn, brush.mk);
    if (!state.mk_back && !brush.empties_left_out) return;
    const MkValue back = state.mk_back.value_or(MkValue{});
    Brush behind = brush;
    behind.keeps_walls = brush.keeps_walls && back.kind == MkKind::Bound;
    paint_slab(behind, x, split.left_out, back);
}

void Canvas::paint_slab(const Brush& brush, std::size_t x, const Spans& spans, const MkValue& mk)
{
    std::vector<Run>& slab = field_.slabs[x];
    const std::size_t before = slab.size();
    const Spans zone = walls_.paint_over(x, spans, mk.mk, brush.keeps_walls, brush.spares_walls);
    fppg::paint(slab, brush.spares_walls ? walls_.without_spared(x, spans) : spans, mk.mk);
    if (!zone.empty()) fppg::paint(slab, zone, mk.mk, true);
    const std::uint64_t runs = runs_ += slab.size() - before; // wraps where runs were joined
    if (runs > run_limit_ && runs < UINT64_MAX / 2)
        throw CaseError(
            def_.file, brush.source->line,
            fmt::format(
                "<{}>: the drawn regions need more memory than this machine has left: {} runs "
                "of nodes so far; a larger dp or a smaller domain needs less",
                brush.source->command, runs));
}

bool Canvas::is_empty() const
{
    return std::all_of(field_.slabs.begin(), field_.slabs.end(),
                       [](const std::vector<Run>& slab) { return slab.empty(); });
}

void Canvas::reset()
{
    for (auto& slab : field_.slabs) slab.clear();
    walls_.reset();
    off_lattice_.reset();
}

void Canvas::cut_to_zone()
{
    const std::vector<Spans> beyond = nodes_beyond_zone(def_.vres, def_.zone, field_);
    parallel_for(beyond.size(), threads_,
                 [&](std::size_t x)
                 {
                     if (!beyond[x].empty()) fppg::paint(field_.slabs[x], beyond[x], 0);
                 });
    walls_.cut_where([&](const Vec3& p)
                     { return is_beyond_zone(def_.vres, def_.zone, field_.grid, p); });
}

RunField Canvas::take()
{
    off_lattice_.finish();
    if (def_.vres.is_active() && walls_.has_walls()) cut_to_zone();
    walls_.finish();
    return std::move(field_);
}

} // namespace fppg
