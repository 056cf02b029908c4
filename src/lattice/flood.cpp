#include "lattice/flood.h"

#include "core/parallel.h"
#include "lattice/span_graph.h"

#include <algorithm>

namespace fppg
{

std::vector<char> fillable_mks(const FillFilter& filter, std::uint16_t mk_bound_first)
{
    std::vector<char> named(65536, 0);
    const auto kind = [&](MkKind k) { return filter.names[static_cast<std::size_t>(k)]; };
    named[0] = kind(MkKind::Void);
    for (std::uint32_t mk = 1; mk < 65536; ++mk)
    {
        const bool is_bound = mk >= mk_bound_first;
        const auto& only = is_bound ? filter.mkbound : filter.mkfluid;
        named[mk] = kind(is_bound ? MkKind::Bound : MkKind::Fluid) && (!only || *only == mk);
    }
    if (filter.border)
        for (char& n : named) n = !n;
    return named;
}

std::vector<Spans> flood(const RunField& field, const Node& seed, const std::vector<char>& fillable,
                         const NodeBox& limits, const SpanSet* mask, int threads)
{
    std::vector<Spans> reached(field.slabs.size());
    const NodeBox box = intersect(limits, whole_lattice(field.grid));
    if (box.is_empty()) return reached;
    for (int axis = 0; axis < 3; ++axis)
        if (seed[axis] < box.begin[static_cast<std::size_t>(axis)] ||
            seed[axis] >= box.end[static_cast<std::size_t>(axis)])
            return reached;

    const auto x_begin = static_cast<std::size_t>(box.begin[0]);
    const auto slab_count = static_cast<std::size_t>(box.end[0] - box.begin[0]);
    const auto y_begin = static_cast<std::uint32_t>(box.begin[1]);
    const auto rows = static_cast<std::size_t>(box.end[1] - box.begin[1]);
    std::vector<char> borders(fillable);
    for (char& b : borders) b = !b;
    std::vector<Spans> intervals(slab_count);
    parallel_for(slab_count, threads,
                 [&](std::size_t i)
                 {
                     const std::size_t x = x_begin + i;
                     const std::vector<Run>& runs = field.slabs[x];
                     // Void nodes have no runs: when void is fillable, what is left after the
                     // borders is.
                     intervals[i] = fillable[0] ? complement(select(runs, borders), box)
                                                : clip_to_box(select(runs, fillable), box);
                     if (mask == nullptr) return;
                     const bool has = x >= mask->x_begin && x < mask->x_begin + mask->slabs.size();
                     intervals[i] =
                         has ? intersect(intervals[i], mask->slabs[x - mask->x_begin]) : Spans{};
                 });
    const SpanGraph graph(std::move(intervals), y_begin, rows, threads);
    const auto start = graph.find(seed.x - static_cast<std::int64_t>(x_begin), seed.y, seed.z);
    if (!start) return reached;
    std::vector<Spans> connected = connected_spans(graph, {*start}, threads);
    std::move(connected.begin(), connected.end(),
              reached.begin() + static_cast<std::ptrdiff_t>(x_begin));
    return reached;
}

} // namespace fppg
