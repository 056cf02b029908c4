#include "lattice/cavity.h"

#include "fppg/error.h"

#include "core/parallel.h"
#include "lattice/fill_level.h"
#include "lattice/point_text.h"
#include "lattice/span_graph.h"

#include <fmt/format.h>

#include <algorithm>
#include <queue>
#include <tuple>

namespace fppg
{
namespace
{

using Slabs = std::vector<Spans>;

/// The spans moved by some rows, those before row 0 left out.
Spans moved_rows(const Spans& spans, int by)
{
    Spans out;
    out.reserve(spans.size());
    for (const Span& s : spans)
        if (static_cast<std::int64_t>(s.y) + by >= 0)
            out.push_back({static_cast<std::uint32_t>(static_cast<std::int64_t>(s.y) + by),
                           s.z_begin, s.z_end});
    return out;
}

class CavityFinder
{
public:
    CavityFinder(const RunField& field, const CavityOptions& options, int threads)
        : field_(field),
          options_(options),
          threads_(threads),
          width_(static_cast<std::uint32_t>(options.gap_nodes)),
          is_2d_(field.grid.is_2d)
    {
    }

    Cavity run()
    {
        set_box();
        check_seed();
        Slabs empty = empty_nodes();
        const SpanGraph cells(eroded(empty), 0, size_[1], threads_);
        const Slabs reached_cells = reach(cells);
        const Slabs outer_cells = cells_outside(cells);
        const Slabs elsewhere_cells =
            each([&](std::size_t x) { return subtract(cells.spans(x), reached_cells[x]); });
        Slabs nodes = limited(dilated(reached_cells));
        if (width_ > 0)
        {
            empty = limited(std::move(empty));
            const Slabs elsewhere = limited(dilated(elsewhere_cells));
            nodes = with_narrow_places(std::move(nodes), empty, elsewhere);
            list_gaps(nodes, empty, limited(dilated(outer_cells)));
        }
        to_lattice(nodes);
        return std::move(out_);
    }

private:
    /// Spans of each slab of the box from the index of the slab.
    template <typename Make>
    Slabs each(const Make& make) const
    {
        Slabs out(size_[0]);
        parallel_for(
            out.size(), threads_, [&](std::size_t x) { out[x] = make(x); }, 4);
        return out;
    }

    const Spans& slab_or_none(const Slabs& slabs, std::size_t x, int by) const
    {
        static const Spans none;
        const std::int64_t at = static_cast<std::int64_t>(x) + by;
        return at >= 0 && at < static_cast<std::int64_t>(slabs.size())
                   ? slabs[static_cast<std::size_t>(at)]
                   : none;
    }

    Vec3 place(double x, double y, double z) const
    {
        const Vec3 index{x + static_cast<double>(heights_.begin[0]),
                         y + static_cast<double>(heights_.begin[1]),
                         z + static_cast<double>(heights_.begin[2])};
        return field_.grid.place(index);
    }

    /// The box around all drawn nodes with room for a cube all around: who gets there is outside.
    /// It may reach out of the lattice, where all is empty.
    void set_box()
    {
        std::array<std::int64_t, 3> low{INT64_MAX, INT64_MAX, INT64_MAX};
        std::array<std::int64_t, 3> high{INT64_MIN, INT64_MIN, INT64_MIN};
        for (std::size_t x = 0; x < field_.slabs.size(); ++x)
            for (const Run& r : field_.slabs[x])
            {
                const std::array<std::int64_t, 3> first{static_cast<std::int64_t>(x), r.y,
                                                        r.z_begin};
                const std::array<std::int64_t, 3> last{static_cast<std::int64_t>(x), r.y,
                                                       static_cast<std::int64_t>(r.z_end) - 1};
                for (std::size_t axis = 0; axis < 3; ++axis)
                {
                    low[axis] = std::min(low[axis], first[axis]);
                    high[axis] = std::max(high[axis], last[axis]);
                }
            }
        const Node& seed = options_.seed;
        for (std::size_t axis = 0; axis < 3; ++axis)
        {
            const std::int64_t at = seed[static_cast<int>(axis)];
            if (at < low[axis] || at > high[axis])
                throw GeometryError(fmt::format("the seed {} lies outside of all that is drawn",
                                                text(position(seed, field_.grid))));
            const std::int64_t room = is_2d_ && axis == 1 ? 0 : width_ + 1;
            heights_.begin[axis] = low[axis] - room;
            size_[axis] = static_cast<std::size_t>(high[axis] - low[axis] + 1 + 2 * room);
        }
        heights_.up = up_in_steps(options_.up, field_.grid);
        for (int axis = 0; axis < 3; ++axis)
            if (!(is_2d_ && axis == 1)) lowest_corner_ += width_ * std::min(0.0, options_.up[axis]);
    }

    void check_seed() const
    {
        const Node& seed = options_.seed;
        for (const Run& r : field_.slabs[static_cast<std::size_t>(seed.x)])
            if (r.y == seed.y && seed.z >= r.z_begin && seed.z < r.z_end)
                throw GeometryError(fmt::format(
                    "the seed {} is not on an empty node: {}", text(position(seed, field_.grid)),
                    r.is_covered ? "it is too near to a body-fitted wall"
                                 : fmt::format("mk {} is drawn there", r.mk)));
    }

    Slabs empty_nodes() const
    {
        const NodeBox box{{0, 0, 0},
                          {static_cast<std::int64_t>(size_[0]), static_cast<std::int64_t>(size_[1]),
                           static_cast<std::int64_t>(size_[2])}};
        return each(
            [&](std::size_t x)
            {
                const std::int64_t slab = static_cast<std::int64_t>(x) + heights_.begin[0];
                Spans drawn;
                if (slab >= 0 && slab < static_cast<std::int64_t>(field_.slabs.size()))
                    drawn = occupied(field_.slabs[static_cast<std::size_t>(slab)]);
                for (Span& s : drawn)
                {
                    s.y = static_cast<std::uint32_t>(s.y - heights_.begin[1]);
                    s.z_begin = static_cast<std::uint32_t>(s.z_begin - heights_.begin[2]);
                    s.z_end = static_cast<std::uint32_t>(s.z_end - heights_.begin[2]);
                }
                return complement(drawn, box);
            });
    }

    /// The lowest corners of all cubes of empty nodes.
    Slabs eroded(const Slabs& empty) const
    {
        if (width_ == 0) return empty;
        const Slabs in_slab = each(
            [&](std::size_t x)
            {
                Spans columns;
                for (const Span& s : empty[x])
                    if (s.z_end - s.z_begin > width_)
                        columns.push_back({s.y, s.z_begin, s.z_end - width_});
                Spans out = columns;
                for (int j = 1; !is_2d_ && j <= static_cast<int>(width_); ++j)
                    out = intersect(out, moved_rows(columns, -j));
                return out;
            });
        return each(
            [&](std::size_t x)
            {
                Spans out = in_slab[x];
                for (int j = 1; j <= static_cast<int>(width_); ++j)
                    out = intersect(out, slab_or_none(in_slab, x, j));
                return out;
            });
    }

    /// The nodes of cubes.
    Slabs dilated(const Slabs& cells) const
    {
        if (width_ == 0) return cells;
        const Slabs in_slab = each(
            [&](std::size_t x)
            {
                Spans columns = cells[x];
                for (Span& s : columns) s.z_end += width_;
                sort_and_join(columns);
                Spans out = columns;
                for (int j = 1; !is_2d_ && j <= static_cast<int>(width_); ++j)
                    out = unite(out, moved_rows(columns, j));
                return out;
            });
        return each(
            [&](std::size_t x)
            {
                Spans out = in_slab[x];
                for (int j = 1; j <= static_cast<int>(width_); ++j)
                    out = unite(out, slab_or_none(in_slab, x, -j));
                return out;
            });
    }

    /// Nodes and all their 6-neighbours.
    Slabs grown(const Slabs& nodes) const
    {
        return each(
            [&](std::size_t x)
            {
                Spans out = nodes[x];
                for (Span& s : out)
                {
                    if (s.z_begin > 0) --s.z_begin;
                    ++s.z_end;
                }
                sort_and_join(out);
                if (!is_2d_)
                    for (const int by : {-1, 1}) out = unite(out, moved_rows(nodes[x], by));
                for (const int by : {-1, 1}) out = unite(out, slab_or_none(nodes, x, by));
                return out;
            });
    }

    /// Of an open cavity the nodes below the way out.
    Slabs limited(Slabs nodes) const
    {
        if (!out_.opening) return nodes;
        return each(
            [&](std::size_t x)
            {
                return nodes_up_to(nodes[x], static_cast<std::int64_t>(x), heights_,
                                   out_.opening->height - NodeHeights::tolerance);
            });
    }

    struct Reach
    {
        double height = infinity; ///< at least so high goes the way from the seed
        std::array<std::uint32_t, 3> highest{0, 0, 0}; ///< the cube where it does
    };

    double cell_height(std::int64_t x, std::int64_t y, std::int64_t z) const
    {
        return heights_.at(x, y, z) + lowest_corner_;
    }

    /// Where a cube comes to rest that goes down the steepest way, step by step.
    Reach run_down(const SpanGraph& cells, std::array<std::int64_t, 3> at) const
    {
        double height = cell_height(at[0], at[1], at[2]);
        for (;;)
        {
            std::array<std::int64_t, 3> lowest = at;
            for (std::size_t axis = 0; axis < 3; ++axis)
                for (const int by : {-1, 1})
                {
                    std::array<std::int64_t, 3> next = at;
                    next[axis] += by;
                    const double there = cell_height(next[0], next[1], next[2]);
                    if (there > height - NodeHeights::tolerance ||
                        !cells.find(next[0], next[1], next[2]))
                        continue;
                    height = there;
                    lowest = next;
                }
            if (lowest == at) break;
            at = lowest;
        }
        return {height,
                {static_cast<std::uint32_t>(at[0]), static_cast<std::uint32_t>(at[1]),
                 static_cast<std::uint32_t>(at[2])}};
    }

    /// The spans of cubes that the seed reaches, from the lowest way to the highest, until one is
    /// outside. Returns those below the way out.
    Slabs reach(const SpanGraph& cells)
    {
        using Id = SpanGraph::Id;
        using Item = std::tuple<double, std::uint32_t, std::uint32_t>;
        std::vector<std::vector<Reach>> reached(cells.slab_count());
        for (std::size_t x = 0; x < reached.size(); ++x) reached[x].resize(cells.spans(x).size());
        std::priority_queue<Item, std::vector<Item>, std::greater<>> queue;
        const auto offer = [&](Id id, const Reach& by)
        {
            Reach& known = reached[id.slab][id.span];
            if (by.height >= known.height) return;
            known = by;
            queue.emplace(by.height, id.slab, id.span);
        };
        std::array<std::int64_t, 3> at{};
        for (int axis = 0; axis < 3; ++axis)
            at[static_cast<std::size_t>(axis)] =
                options_.seed[axis] - heights_.begin[static_cast<std::size_t>(axis)];
        const std::int64_t w = width_;
        for (std::int64_t x = at[0] - w; x <= at[0]; ++x)
            for (std::int64_t y = is_2d_ ? at[1] : at[1] - w; y <= at[1]; ++y)
                for (std::int64_t z = at[2] - w; z <= at[2]; ++z)
                    if (cells.find(x, y, z))
                    {
                        const Reach start = run_down(cells, {x, y, z});
                        offer(*cells.find(start.highest[0], start.highest[1], start.highest[2]),
                              start);
                    }
        if (queue.empty())
            throw GeometryError(fmt::format(
                "the seed {} lies in a gap: there are fewer than {} empty nodes side by side",
                text(position(options_.seed, field_.grid)), width_ + 1));

        const bool rises = options_.up.z >= 0;
        Reach out;
        while (!queue.empty())
        {
            const auto [height, top_slab, span] = queue.top();
            if (height >= out.height) break;
            queue.pop();
            const auto slab = top_slab; // clang 14 captures no structured binding
            const Id id{slab, span};
            const Reach from = reached[slab][span];
            if (height > from.height) continue;
            const Span& s = cells.at(id);
            leave(slab, s, from, out);
            cells.for_neighbours(id,
                                 [&](Id next)
                                 {
                                     const Span& t = cells.at(next);
                                     const std::uint32_t z = rises ? std::max(s.z_begin, t.z_begin)
                                                                   : std::min(s.z_end, t.z_end) - 1;
                                     Reach to = over(from, slab, s.y, z);
                                     to = over(to, next.slab, t.y, z);
                                     offer(next, to);
                                 });
        }
        if (out.height < infinity)
        {
            const double half = 0.5 * width_;
            out_.opening = {out.height,
                            place(out.highest[0] + half, out.highest[1] + (is_2d_ ? 0 : half),
                                  out.highest[2] + half)};
        }
        return each(
            [&](std::size_t x)
            {
                const double limit = out.height - NodeHeights::tolerance;
                Spans kept;
                for (std::size_t k = 0; k < reached[x].size(); ++k)
                    if (reached[x][k].height <= limit && reached[x][k].height < infinity)
                        kept.push_back(cells.spans(x)[k]);
                return nodes_up_to(kept, static_cast<std::int64_t>(x), heights_,
                                   limit - lowest_corner_);
            });
    }

    Reach over(const Reach& from, std::uint32_t x, std::uint32_t y, std::uint32_t z) const
    {
        const double height = cell_height(x, y, z);
        return height > from.height ? Reach{height, {x, y, z}} : from;
    }

    bool is_last(std::size_t index, std::size_t axis) const
    {
        return index == 0 || index + width_ + 1 >= size_[axis];
    }

    /// The ways out of the box from a span of cubes.
    void leave(std::uint32_t x, const Span& s, const Reach& from, Reach& out) const
    {
        const auto take = [&](const Reach& r)
        {
            if (r.height < out.height) out = r;
        };
        if (is_last(x, 0) || (!is_2d_ && is_last(s.y, 1)))
            take(from);
        else if (s.z_begin == 0)
            take(over(from, x, s.y, s.z_begin));
        if (is_last(s.z_end - 1, 2)) take(over(from, x, s.y, s.z_end - 1));
    }

    /// All cubes that are connected with the border of the box.
    Slabs cells_outside(const SpanGraph& cells) const
    {
        std::vector<SpanGraph::Id> seeds;
        for (const std::size_t x : {std::size_t{0}, size_[0] - 1 - width_})
            for (std::size_t k = 0; k < cells.spans(x).size(); ++k)
                seeds.push_back({static_cast<std::uint32_t>(x), static_cast<std::uint32_t>(k)});
        return connected_spans(cells, seeds, threads_);
    }

    /// The spans of a graph that have nodes in a set, as where to begin.
    std::vector<SpanGraph::Id> spans_at(const SpanGraph& graph, const Slabs& where) const
    {
        std::vector<SpanGraph::Id> found;
        for (std::size_t x = 0; x < where.size(); ++x)
            for (const Span& s : intersect(graph.spans(x), where[x]))
                found.push_back(*graph.find(static_cast<std::int64_t>(x), s.y, s.z_begin));
        return found;
    }

    /// Adds to the cavity the places where no cube fits: wholly where they lead nowhere else, or
    /// else the nodes that are fewer steps away from the cavity than from where they lead.
    Slabs with_narrow_places(Slabs nodes, const Slabs& empty, const Slabs& elsewhere) const
    {
        const Slabs others = each([&](std::size_t x) { return subtract(elsewhere[x], nodes[x]); });
        const SpanGraph narrow(
            each([&](std::size_t x)
                 { return subtract(subtract(empty[x], nodes[x]), elsewhere[x]); }),
            0, size_[1], threads_);
        const Slabs from_nodes = connected_spans(narrow, spans_at(narrow, grown(nodes)), threads_);
        const Slabs from_others =
            connected_spans(narrow, spans_at(narrow, grown(others)), threads_);
        Slabs undecided =
            each([&](std::size_t x) { return intersect(from_nodes[x], from_others[x]); });
        nodes = each([&](std::size_t x)
                     { return unite(nodes[x], subtract(from_nodes[x], undecided[x])); });
        Slabs front = nodes;
        Slabs other_front = others;
        const auto is_empty = [](const Spans& spans) { return spans.empty(); };
        while (!std::all_of(front.begin(), front.end(), is_empty))
        {
            const Slabs around = grown(front);
            const Slabs other_around = grown(other_front);
            other_front =
                each([&](std::size_t x) { return intersect(other_around[x], undecided[x]); });
            front = each([&](std::size_t x)
                         { return subtract(intersect(around[x], undecided[x]), other_front[x]); });
            parallel_for(
                nodes.size(), threads_,
                [&](std::size_t x)
                {
                    if (!front[x].empty())
                    {
                        nodes[x] = unite(nodes[x], front[x]);
                        undecided[x] = subtract(undecided[x], front[x]);
                    }
                    if (!other_front[x].empty())
                        undecided[x] = subtract(undecided[x], other_front[x]);
                },
                4);
        }
        return nodes;
    }

    /// The gaps are where the cavity touches empty nodes that are not in it; nodes near to one
    /// another are one gap.
    void list_gaps(const Slabs& nodes, const Slabs& empty, const Slabs& outside)
    {
        const SpanGraph beyond(each([&](std::size_t x) { return subtract(empty[x], nodes[x]); }), 0,
                               size_[1], threads_);
        const Slabs touching = grown(each([&](std::size_t x) { return beyond.spans(x); }));
        const Slabs gaps = each([&](std::size_t x) { return intersect(nodes[x], touching[x]); });
        const Slabs near_outside =
            grown(connected_spans(beyond, spans_at(beyond, outside), threads_));
        const Slabs wide = each(
            [&](std::size_t x)
            {
                Spans all;
                for (const int by : {-1, 0, 1}) all = unite(all, slab_or_none(gaps, x, by));
                Spans rows = all;
                if (!is_2d_)
                    for (const int by : {-1, 1}) rows = unite(rows, moved_rows(all, by));
                for (Span& s : rows)
                {
                    if (s.z_begin > 0) --s.z_begin;
                    ++s.z_end;
                }
                sort_and_join(rows);
                return rows;
            });
        const SpanGraph graph(wide, 0, size_[1] + 1, threads_);
        std::vector<std::vector<std::size_t>> gap_of(graph.slab_count());
        for (std::size_t x = 0; x < gap_of.size(); ++x)
            gap_of[x].assign(graph.spans(x).size(), SIZE_MAX);
        std::vector<Vec3> sums;
        for (std::size_t x = 0; x < gaps.size(); ++x)
        {
            const Spans leading_out = intersect(gaps[x], near_outside[x]);
            for (const Span& s : gaps[x])
            {
                const SpanGraph::Id id = *graph.find(static_cast<std::int64_t>(x), s.y, s.z_begin);
                if (gap_of[id.slab][id.span] == SIZE_MAX)
                {
                    mark(graph, id, out_.gaps.size(), gap_of);
                    out_.gaps.emplace_back();
                    sums.emplace_back();
                }
                const std::size_t gap = gap_of[id.slab][id.span];
                const double n = s.z_end - s.z_begin;
                out_.gaps[gap].nodes += s.z_end - s.z_begin;
                sums[gap] = sums[gap] + n * Vec3{static_cast<double>(x), static_cast<double>(s.y),
                                                 0.5 * (s.z_begin + (s.z_end - 1.0))};
            }
            for (const Span& s : leading_out)
            {
                const SpanGraph::Id id = *graph.find(static_cast<std::int64_t>(x), s.y, s.z_begin);
                out_.gaps[gap_of[id.slab][id.span]].leads_outside = true;
            }
        }
        for (std::size_t i = 0; i < sums.size(); ++i)
        {
            const Vec3 mean = sums[i] / static_cast<double>(out_.gaps[i].nodes);
            out_.gaps[i].center = place(mean.x, mean.y, mean.z);
        }
    }

    static void mark(const SpanGraph& graph, SpanGraph::Id from, std::size_t gap,
                     std::vector<std::vector<std::size_t>>& gap_of)
    {
        std::vector<SpanGraph::Id> stack{from};
        gap_of[from.slab][from.span] = gap;
        while (!stack.empty())
        {
            const SpanGraph::Id id = stack.back();
            stack.pop_back();
            graph.for_neighbours(id,
                                 [&](SpanGraph::Id next)
                                 {
                                     std::size_t& known = gap_of[next.slab][next.span];
                                     if (known != SIZE_MAX) return;
                                     known = gap;
                                     stack.push_back(next);
                                 });
        }
    }

    void to_lattice(const Slabs& nodes)
    {
        out_.nodes.resize(field_.slabs.size());
        for (std::size_t x = 0; x < nodes.size(); ++x)
        {
            if (nodes[x].empty()) continue;
            Spans& slab = out_.nodes[static_cast<std::size_t>(static_cast<std::int64_t>(x) +
                                                              heights_.begin[0])];
            for (const Span& s : nodes[x])
                slab.push_back({static_cast<std::uint32_t>(s.y + heights_.begin[1]),
                                static_cast<std::uint32_t>(s.z_begin + heights_.begin[2]),
                                static_cast<std::uint32_t>(s.z_end + heights_.begin[2])});
        }
        out_.node_count = node_count(out_.nodes);
    }

    const RunField& field_;
    CavityOptions options_;
    int threads_;
    std::uint32_t width_; ///< of a gap; cubes have one node more a side
    bool is_2d_;
    NodeHeights heights_; ///< of the indices in the box
    std::array<std::size_t, 3> size_{0, 0, 0};
    double lowest_corner_ = 0; ///< height of a cube's lowest node over its first one
    Cavity out_;
};

} // namespace

Cavity find_cavity(const RunField& field, const CavityOptions& options, int threads)
{
    return CavityFinder(field, options, threads).run();
}

} // namespace fppg
