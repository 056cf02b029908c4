#include "lattice/flood.h"

#include "core/parallel.h"

#include <algorithm>

namespace fppg
{
namespace
{

/// The fillable intervals of one slab, with an index by row.
struct Slab
{
    Spans intervals;
    std::vector<std::uint32_t> row_begin; ///< rows + 1 entries
    std::vector<char> is_reached;

    /// The interval that holds (row, z), or SIZE_MAX.
    std::size_t find(std::size_t row, std::int64_t z) const
    {
        const auto first = intervals.begin() + row_begin[row];
        const auto last = intervals.begin() + row_begin[row + 1];
        const auto it = std::upper_bound(
            first, last, z, [](std::int64_t value, const Span& s) { return value < s.z_begin; });
        if (it == first || std::prev(it)->z_end <= z) return SIZE_MAX;
        return static_cast<std::size_t>(std::prev(it) - intervals.begin());
    }
};

} // namespace

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
    std::vector<Slab> slabs(slab_count);
    parallel_for(
        slab_count, threads,
        [&](std::size_t i)
        {
            const std::vector<Run>& runs = field.slabs[x_begin + i];
            Slab& slab = slabs[i];
            // Void nodes have no runs: when void is fillable, what is left after the borders is.
            slab.intervals = fillable[0] ? complement(select(runs, borders), box)
                                         : clip_to_box(select(runs, fillable), box);
            if (mask != nullptr)
            {
                const std::size_t x = x_begin + i;
                const bool has = x >= mask->x_begin && x < mask->x_begin + mask->slabs.size();
                slab.intervals =
                    has ? intersect(slab.intervals, mask->slabs[x - mask->x_begin]) : Spans{};
            }
            slab.row_begin.assign(rows + 1, 0);
            for (const Span& s : slab.intervals) ++slab.row_begin[s.y - y_begin + 1];
            for (std::size_t r = 0; r < rows; ++r) slab.row_begin[r + 1] += slab.row_begin[r];
            slab.is_reached.assign(slab.intervals.size(), 0);
        });

    struct Item
    {
        std::uint32_t slab;
        std::uint32_t interval;
    };
    std::vector<Item> stack;
    const auto seed_slab = static_cast<std::size_t>(seed.x) - x_begin;
    const std::size_t start =
        slabs[seed_slab].find(static_cast<std::size_t>(seed.y) - y_begin, seed.z);
    if (start == SIZE_MAX) return reached;
    slabs[seed_slab].is_reached[start] = 1;
    stack.push_back({static_cast<std::uint32_t>(seed_slab), static_cast<std::uint32_t>(start)});
    const auto visit_row = [&](std::size_t slab_index, std::size_t row, const Span& from)
    {
        Slab& slab = slabs[slab_index];
        const auto first = slab.intervals.begin() + slab.row_begin[row];
        const auto last = slab.intervals.begin() + slab.row_begin[row + 1];
        auto it = last - first > 8 ? std::lower_bound(first, last, from.z_begin,
                                                      [](const Span& s, std::uint32_t z)
                                                      { return s.z_end <= z; })
                                   : first;
        for (; it != last && it->z_begin < from.z_end; ++it)
        {
            if (it->z_end <= from.z_begin) continue;
            const auto k = static_cast<std::size_t>(it - slab.intervals.begin());
            if (slab.is_reached[k]) continue;
            slab.is_reached[k] = 1;
            stack.push_back(
                {static_cast<std::uint32_t>(slab_index), static_cast<std::uint32_t>(k)});
        }
    };
    while (!stack.empty())
    {
        const Item item = stack.back();
        stack.pop_back();
        const Span from = slabs[item.slab].intervals[item.interval];
        const std::size_t row = from.y - y_begin;
        if (row > 0) visit_row(item.slab, row - 1, from);
        if (row + 1 < rows) visit_row(item.slab, row + 1, from);
        if (item.slab > 0) visit_row(item.slab - 1, row, from);
        if (item.slab + 1 < slab_count) visit_row(item.slab + 1, row, from);
    }
    parallel_for(slab_count, threads,
                 [&](std::size_t i)
                 {
                     Spans& out = reached[x_begin + i];
                     for (std::size_t k = 0; k < slabs[i].intervals.size(); ++k)
                         if (slabs[i].is_reached[k]) out.push_back(slabs[i].intervals[k]);
                 });
    return reached;
}

} // namespace fppg
