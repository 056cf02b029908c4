#include "lattice/redraw.h"

#include "core/parallel.h"

#include <algorithm>
#include <array>

namespace fppg
{
namespace
{

std::vector<char> wanted_mks(const MkFilter& filter, std::uint16_t mk_bound_first)
{
    std::vector<char> wanted(65536, 0);
    for (std::uint32_t mk = 1; mk < 65536; ++mk)
    {
        const MkKind kind = mk >= mk_bound_first ? MkKind::Bound : MkKind::Fluid;
        wanted[mk] = kind == filter.kind && (!filter.mk || *filter.mk == mk);
    }
    return wanted;
}

/// Nodes of a type in every slab; void ones inside `box` only.
std::vector<Spans> nodes_of(const RunField& field, const MkFilter& filter, const NodeBox& box,
                            std::uint16_t mk_bound_first, int threads)
{
    std::vector<Spans> out(field.slabs.size());
    const std::vector<char> wanted = wanted_mks(filter, mk_bound_first);
    parallel_for(field.slabs.size(), threads,
                 [&](std::size_t x)
                 {
                     const auto ix = static_cast<std::int64_t>(x);
                     if (box.is_empty() || ix < box.begin[0] || ix >= box.end[0]) return;
                     if (filter.kind == MkKind::Void)
                         out[x] = complement(occupied(field.slabs[x]), box);
                     else
                         out[x] = clip_to_box(select(field.slabs[x], wanted), box);
                 });
    return out;
}

/// Appends `spans` moved by (dy, dz), cut at the lattice.
void append_moved(const Spans& spans, int dy, int dz_low, int dz_high, const LatticeGrid& grid,
                  Spans& out)
{
    for (const Span& s : spans)
    {
        const std::int64_t y = static_cast<std::int64_t>(s.y) + dy;
        if (y < 0 || y >= grid.n[1]) continue;
        const std::int64_t begin =
            std::max<std::int64_t>(static_cast<std::int64_t>(s.z_begin) + dz_low, 0);
        const std::int64_t end =
            std::min<std::int64_t>(static_cast<std::int64_t>(s.z_end) + dz_high, grid.n[2]);
        if (begin < end)
            out.push_back({static_cast<std::uint32_t>(y), static_cast<std::uint32_t>(begin),
                           static_cast<std::uint32_t>(end)});
    }
}

/// Whether a node can be both a target and a border.
bool may_share_nodes(const MkFilter& a, const MkFilter& b)
{
    return a.kind == b.kind && (!a.mk || !b.mk || *a.mk == *b.mk);
}

/// One slab of the lattice, node by node; empty where it has no targets.
struct SlabMarks
{
    std::vector<char> is_target;
    std::vector<char> is_marked;
};

/// Targets beside a border, where nodes can be both: border nodes act one after another in the
/// order of x, y and z, and one that has been marked acts no more. Found by experiment with GenCase
/// v5.0 (24 random cases of redrawnear with equal types; the order of the axes changes nothing).
std::vector<Spans> mark_in_turn(const std::vector<Spans>& targets,
                                const std::vector<Spans>& borders,
                                const std::array<bool, 6>& directions, const LatticeGrid& grid)
{
    const auto n_y = static_cast<std::int64_t>(grid.n[1]);
    const auto n_z = static_cast<std::int64_t>(grid.n[2]);
    const std::size_t n_slabs = targets.size();
    const auto [top, bottom, to_right, to_left, back, front] = directions;
    const auto begin_slab = [&](std::size_t x, SlabMarks& slab)
    {
        const bool has_targets = x < n_slabs && !targets[x].empty();
        slab.is_target.assign(has_targets ? static_cast<std::size_t>(n_y * n_z) : 0, 0);
        slab.is_marked = slab.is_target;
        if (!has_targets) return;
        for (const Span& s : targets[x])
        {
            const auto row = slab.is_target.begin() + static_cast<std::int64_t>(s.y) * n_z;
            std::fill(row + s.z_begin, row + s.z_end, char{1});
        }
    };
    const auto mark = [&](SlabMarks& slab, std::int64_t y, std::int64_t z)
    {
        if (slab.is_target.empty() || y < 0 || y >= n_y || z < 0 || z >= n_z) return;
        const auto node = static_cast<std::size_t>(y * n_z + z);
        if (slab.is_target[node] != 0) slab.is_marked[node] = 1;
    };
    const auto marked_spans = [&](const SlabMarks& slab, std::size_t x)
    {
        Spans marked;
        for (const Span& s : targets[x])
            for (std::uint32_t z = s.z_begin; z < s.z_end; ++z)
                if (slab.is_marked[static_cast<std::size_t>(s.y * n_z + z)] != 0)
                    marked.push_back({s.y, z, z + 1});
        sort_and_join(marked);
        return marked;
    };

    std::vector<Spans> out(n_slabs);
    std::array<SlabMarks, 3> slabs; // Before, at and after the one whose borders act.
    begin_slab(n_slabs, slabs[0]);
    begin_slab(0, slabs[1]);
    for (std::size_t x = 0; x < n_slabs; ++x)
    {
        auto& [before, here, after] = slabs;
        begin_slab(x + 1, after);
        for (const Span& s : borders[x])
            for (std::int64_t z = s.z_begin; z < s.z_end; ++z)
            {
                const auto y = static_cast<std::int64_t>(s.y);
                if (!here.is_marked.empty() &&
                    here.is_marked[static_cast<std::size_t>(y * n_z + z)] != 0)
                    continue;
                if (top) mark(here, y, z + 1);
                if (bottom) mark(here, y, z - 1);
                if (to_right) mark(after, y, z);
                if (to_left) mark(before, y, z);
                if (back) mark(here, y + 1, z);
                if (front) mark(here, y - 1, z);
            }
        if (x > 0) out[x - 1] = marked_spans(before, x - 1);
        std::rotate(slabs.begin(), slabs.begin() + 1, slabs.end());
    }
    if (n_slabs > 0) out[n_slabs - 1] = marked_spans(slabs[0], n_slabs - 1);
    return out;
}

} // namespace

std::vector<Spans> redraw_nodes(const RunField& field, const RedrawOp& op, const NodeBox& box,
                                std::uint16_t mk_bound_first, int threads)
{
    std::vector<Spans> out(field.slabs.size());
    if (op.filters.empty())
    {
        // redraw alone means every node; redrawbox alone means none.
        if (op.region) return out;
        for (std::size_t x = 0; x < out.size(); ++x) out[x] = complement({}, box);
        return out;
    }
    for (const MkFilter& filter : op.filters)
    {
        const std::vector<Spans> nodes = nodes_of(field, filter, box, mk_bound_first, threads);
        for (std::size_t x = 0; x < out.size(); ++x) out[x] = unite(out[x], nodes[x]);
    }
    return out;
}

std::vector<Spans> redraw_near_nodes(const RunField& field, const RedrawNearOp& op,
                                     const NodeBox& box, const SpanSet* mask,
                                     std::uint16_t mk_bound_first, int threads)
{
    const NodeBox whole = whole_lattice(field.grid);
    // A border node one step outside the box counts for a target inside it.
    NodeBox reach = box;
    for (std::size_t axis = 0; axis < 3; ++axis)
    {
        --reach.begin[axis];
        ++reach.end[axis];
    }
    std::vector<Spans> targets = nodes_of(field, op.target, box, mk_bound_first, threads);
    if (mask != nullptr)
        for (std::size_t x = 0; x < targets.size(); ++x)
            targets[x] = intersect(targets[x], mask->slabs[x]);
    const std::vector<Spans> borders =
        nodes_of(field, op.border, intersect(reach, whole), mk_bound_first, threads);
    const bool all_neighbours =
        std::none_of(op.directions.begin(), op.directions.end(), [](bool d) { return d; });
    if (!all_neighbours && may_share_nodes(op.target, op.border))
        return mark_in_turn(targets, borders, op.directions, field.grid);
    std::vector<Spans> out(field.slabs.size());
    parallel_for(field.slabs.size(), threads,
                 [&](std::size_t x)
                 {
                     if (targets[x].empty()) return;
                     const Spans* left = x > 0 ? &borders[x - 1] : nullptr;
                     const Spans* here = &borders[x];
                     const Spans* right = x + 1 < borders.size() ? &borders[x + 1] : nullptr;
                     Spans near;
                     if (all_neighbours)
                     {
                         // A node that is both is its own neighbour: a lone fluid node with
                         // fluid as target and border is redrawn (16 cases of GenCase v5.4.354).
                         for (int dy = -1; dy <= 1; ++dy)
                             for (const Spans* slab : {left, here, right})
                                 if (slab != nullptr)
                                     append_moved(*slab, dy, -1, 1, field.grid, near);
                     }
                     else
                     {
                         const auto& [top, bottom, to_right, to_left, back, front] = op.directions;
                         if (top) append_moved(borders[x], 0, 1, 1, field.grid, near);
                         if (bottom) append_moved(borders[x], 0, -1, -1, field.grid, near);
                         if (to_right && left != nullptr)
                             append_moved(*left, 0, 0, 0, field.grid, near);
                         if (to_left && right != nullptr)
                             append_moved(*right, 0, 0, 0, field.grid, near);
                         if (back) append_moved(borders[x], 1, 0, 0, field.grid, near);
                         if (front) append_moved(borders[x], -1, 0, 0, field.grid, near);
                     }
                     sort_and_join(near);
                     out[x] = intersect(targets[x], near);
                 });
    return out;
}

} // namespace fppg
