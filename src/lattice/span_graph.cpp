#include "lattice/span_graph.h"

#include "core/parallel.h"

namespace fppg
{

SpanGraph::SpanGraph(std::vector<Spans> slabs, std::uint32_t y_begin, std::size_t rows, int threads)
    : y_begin_(y_begin), rows_(rows), slabs_(slabs.size())
{
    parallel_for(slabs.size(), threads,
                 [&](std::size_t i)
                 {
                     Slab& slab = slabs_[i];
                     slab.spans = std::move(slabs[i]);
                     slab.row_begin.assign(rows + 1, 0);
                     for (const Span& s : slab.spans) ++slab.row_begin[s.y - y_begin + 1];
                     for (std::size_t r = 0; r < rows; ++r)
                         slab.row_begin[r + 1] += slab.row_begin[r];
                 });
}

std::optional<SpanGraph::Id> SpanGraph::find(std::int64_t slab, std::int64_t y,
                                             std::int64_t z) const
{
    const std::int64_t row = y - y_begin_;
    if (slab < 0 || row < 0 || slab >= static_cast<std::int64_t>(slabs_.size()) ||
        row >= static_cast<std::int64_t>(rows_))
        return std::nullopt;
    const Slab& at = slabs_[static_cast<std::size_t>(slab)];
    const auto first = at.spans.begin() + at.row_begin[static_cast<std::size_t>(row)];
    const auto last = at.spans.begin() + at.row_begin[static_cast<std::size_t>(row) + 1];
    const auto it = std::upper_bound(
        first, last, z, [](std::int64_t value, const Span& s) { return value < s.z_begin; });
    if (it == first || std::prev(it)->z_end <= z) return std::nullopt;
    return Id{static_cast<std::uint32_t>(slab),
              static_cast<std::uint32_t>(std::prev(it) - at.spans.begin())};
}

std::vector<Spans> connected_spans(const SpanGraph& graph, const std::vector<SpanGraph::Id>& seeds,
                                   int threads)
{
    std::vector<std::vector<char>> is_reached(graph.slab_count());
    for (std::size_t i = 0; i < is_reached.size(); ++i) is_reached[i].resize(graph.spans(i).size());
    std::vector<SpanGraph::Id> stack;
    const auto reach = [&](SpanGraph::Id id)
    {
        char& reached = is_reached[id.slab][id.span];
        if (reached) return;
        reached = 1;
        stack.push_back(id);
    };
    for (const SpanGraph::Id& seed : seeds) reach(seed);
    while (!stack.empty())
    {
        const SpanGraph::Id id = stack.back();
        stack.pop_back();
        graph.for_neighbours(id, reach);
    }
    std::vector<Spans> out(graph.slab_count());
    parallel_for(out.size(), threads,
                 [&](std::size_t i)
                 {
                     const Spans& spans = graph.spans(i);
                     for (std::size_t k = 0; k < spans.size(); ++k)
                         if (is_reached[i][k]) out[i].push_back(spans[k]);
                 });
    return out;
}

} // namespace fppg
