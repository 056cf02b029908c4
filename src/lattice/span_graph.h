#pragma once

#include "nodes/spans.h"

#include <algorithm>
#include <cstddef>
#include <optional>

namespace fppg
{

/// Spans of nodes in slabs that follow one another, as a graph: two are neighbours if a node of one
/// is a 6-neighbour of a node of the other. Memory grows with spans and rows, not with nodes.
class SpanGraph
{
public:
    struct Id
    {
        std::uint32_t slab = 0;
        std::uint32_t span = 0;
    };

    /// slabs  as in SpanSet, one entry per slab; all rows lie in [y_begin, y_begin + rows)
    SpanGraph(std::vector<Spans> slabs, std::uint32_t y_begin, std::size_t rows, int threads);

    std::size_t slab_count() const { return slabs_.size(); }
    const Spans& spans(std::size_t slab) const { return slabs_[slab].spans; }
    const Span& at(Id id) const { return slabs_[id.slab].spans[id.span]; }

    /// Calls visit(span of the lower row, span of the upper row) for all neighbours in two rows
    /// that lie side by side, upwards in z; rows count from the first one.
    template <typename Visit>
    void for_pairs(std::size_t low_slab, std::size_t low_row, std::size_t high_slab,
                   std::size_t high_row, const Visit& visit) const
    {
        const Slab& low = slabs_[low_slab];
        const Slab& high = slabs_[high_slab];
        std::uint32_t a = low.row_begin[low_row];
        std::uint32_t b = high.row_begin[high_row];
        const std::uint32_t a_end = low.row_begin[low_row + 1];
        const std::uint32_t b_end = high.row_begin[high_row + 1];
        while (a != a_end && b != b_end)
        {
            const Span& at_a = low.spans[a];
            const Span& at_b = high.spans[b];
            if (at_a.z_begin < at_b.z_end && at_b.z_begin < at_a.z_end) visit(a, b);
            if (at_a.z_end <= at_b.z_end)
                ++a;
            else
                ++b;
        }
    }

    std::size_t row_count() const { return rows_; }

    /// The span that holds a node; indices may lie anywhere.
    std::optional<Id> find(std::int64_t slab, std::int64_t y, std::int64_t z) const;

    /// Calls visit(id) for all neighbours of a span, in the order of rows y - 1 and y + 1 of its
    /// slab, then the slabs before and behind it, upwards in z.
    template <typename Visit>
    void for_neighbours(Id id, const Visit& visit) const
    {
        const Span from = at(id);
        const std::size_t row = from.y - y_begin_;
        if (row > 0) visit_row(id.slab, row - 1, from, visit);
        if (row + 1 < rows_) visit_row(id.slab, row + 1, from, visit);
        if (id.slab > 0) visit_row(id.slab - 1, row, from, visit);
        if (id.slab + 1 < slabs_.size()) visit_row(id.slab + 1, row, from, visit);
    }

private:
    struct Slab
    {
        Spans spans;
        std::vector<std::uint32_t> row_begin; ///< rows + 1 entries
    };

    template <typename Visit>
    void visit_row(std::size_t slab_index, std::size_t row, const Span& from,
                   const Visit& visit) const
    {
        const Slab& slab = slabs_[slab_index];
        const auto first = slab.spans.begin() + slab.row_begin[row];
        const auto last = slab.spans.begin() + slab.row_begin[row + 1];
        auto it = last - first > 8 ? std::lower_bound(first, last, from.z_begin,
                                                      [](const Span& s, std::uint32_t z)
                                                      { return s.z_end <= z; })
                                   : first;
        for (; it != last && it->z_begin < from.z_end; ++it)
            if (it->z_end > from.z_begin)
                visit(Id{static_cast<std::uint32_t>(slab_index),
                         static_cast<std::uint32_t>(it - slab.spans.begin())});
    }

    std::uint32_t y_begin_;
    std::size_t rows_;
    std::vector<Slab> slabs_;
};

/// The spans that are connected with one of `seeds`; one entry per slab.
std::vector<Spans> connected_spans(const SpanGraph& graph, const std::vector<SpanGraph::Id>& seeds,
                                   int threads);

} // namespace fppg
