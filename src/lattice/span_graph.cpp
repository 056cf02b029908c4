#include "lattice/span_graph.h"

#include "core/disjoint_set.h"
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

namespace
{

/// Slabs whose spans one thread joins.
constexpr std::size_t slabs_per_block = 16;

} // namespace

std::vector<Spans> connected_spans(const SpanGraph& graph, const std::vector<SpanGraph::Id>& seeds,
                                   int threads)
{
    const std::size_t slabs = graph.slab_count();
    std::vector<Spans> out(slabs);
    if (seeds.empty()) return out;
    std::vector<std::size_t> first(slabs + 1, 0);
    for (std::size_t i = 0; i < slabs; ++i) first[i + 1] = first[i] + graph.spans(i).size();
    using Sets = DisjointSets<std::size_t>; // of spans, each named by its first one
    Sets sets(first[slabs], Sets::Unset{});
    const auto join_slabs = [&](std::size_t i)
    {
        for (std::size_t row = 0; row < graph.row_count(); ++row)
            graph.for_pairs(i - 1, row, i, row,
                            [&](std::uint32_t a, std::uint32_t b)
                            { sets.join(first[i - 1] + a, first[i] + b); });
    };
    const std::size_t blocks = (slabs + slabs_per_block - 1) / slabs_per_block;
    parallel_for(blocks, threads,
                 [&](std::size_t block)
                 {
                     const std::size_t begin = block * slabs_per_block;
                     const std::size_t end = std::min(slabs, begin + slabs_per_block);
                     sets.separate(first[begin], first[end]);
                     for (std::size_t i = begin; i < end; ++i)
                     {
                         for (std::size_t row = 1; row < graph.row_count(); ++row)
                             graph.for_pairs(i, row - 1, i, row,
                                             [&](std::uint32_t a, std::uint32_t b)
                                             { sets.join(first[i] + a, first[i] + b); });
                         if (i > begin) join_slabs(i);
                     }
                 });
    for (std::size_t block = 1; block < blocks; ++block) join_slabs(block * slabs_per_block);

    std::vector<std::size_t> reached;
    for (const SpanGraph::Id& seed : seeds)
        reached.push_back(sets.first_of(first[seed.slab] + seed.span));
    std::sort(reached.begin(), reached.end());
    reached.erase(std::unique(reached.begin(), reached.end()), reached.end());
    parallel_for(
        slabs, threads,
        [&](std::size_t i)
        {
            const Spans& spans = graph.spans(i);
            for (std::size_t k = 0; k < spans.size(); ++k)
                if (std::binary_search(reached.begin(), reached.end(), sets.first_of(first[i] + k)))
                    out[i].push_back(spans[k]);
        });
    return out;
}

} // namespace fppg
