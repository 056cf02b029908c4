#include "lattice/fill_level.h"

#include "core/parallel.h"

#include <algorithm>
#include <numeric>

namespace fppg
{
namespace
{

/// The number of nodes up to a height and the height of the highest of them.
struct Sum
{
    std::uint64_t nodes = 0;
    double highest = -infinity;
};

Sum sum_up_to(const std::vector<Spans>& nodes, const NodeHeights& heights, double limit,
              int threads)
{
    std::vector<Sum> of_slab(nodes.size());
    parallel_for(
        nodes.size(), threads,
        [&](std::size_t i)
        {
            const auto x = static_cast<std::int64_t>(i);
            for (const Span& s : nodes_up_to(nodes[i], x, heights, limit))
            {
                of_slab[i].nodes += s.z_end - s.z_begin;
                of_slab[i].highest =
                    std::max({of_slab[i].highest, heights.at(x, s.y, s.z_begin),
                              heights.at(x, s.y, static_cast<std::int64_t>(s.z_end) - 1)});
            }
        },
        16);
    Sum all;
    for (const Sum& s : of_slab)
    {
        all.nodes += s.nodes;
        all.highest = std::max(all.highest, s.highest);
    }
    return all;
}

double lowest_height(const std::vector<Spans>& nodes, const NodeHeights& heights)
{
    double lowest = infinity;
    for (std::size_t i = 0; i < nodes.size(); ++i)
        for (const Span& s : nodes[i])
        {
            const auto x = static_cast<std::int64_t>(i);
            lowest = std::min({lowest, heights.at(x, s.y, s.z_begin),
                               heights.at(x, s.y, static_cast<std::int64_t>(s.z_end) - 1)});
        }
    return lowest;
}

} // namespace

std::uint64_t node_count(const std::vector<Spans>& nodes)
{
    std::uint64_t n = 0;
    for (const Spans& spans : nodes)
        for (const Span& s : spans) n += s.z_end - s.z_begin;
    return n;
}

Spans nodes_up_to(const Spans& spans, std::int64_t x, const NodeHeights& heights, double limit)
{
    return part_of_columns(
        spans, [&](std::uint32_t y, std::uint32_t z) { return heights.at(x, y, z) <= limit; });
}

FillLevel level_at(const std::vector<Spans>& nodes, const NodeHeights& heights, double limit,
                   int threads)
{
    const Sum sum = sum_up_to(nodes, heights, limit + NodeHeights::tolerance, threads);
    return {sum.nodes > 0 ? sum.highest : lowest_height(nodes, heights), sum.nodes};
}

FillLevel level_of_count(const std::vector<Spans>& nodes, const NodeHeights& heights, double count,
                         int threads)
{
    const Sum all = sum_up_to(nodes, heights, infinity, threads);
    if (all.nodes == 0) return {};
    if (count >= static_cast<double>(all.nodes)) return {all.highest, all.nodes};
    // The layer with which the number is reached lies between these.
    double below = lowest_height(nodes, heights) - 1;
    double above = all.highest;
    while (count > 0 && above - below > 0.1 * NodeHeights::tolerance)
    {
        const double middle = std::midpoint(below, above);
        const Sum sum = sum_up_to(nodes, heights, middle, threads);
        (static_cast<double>(sum.nodes) < count ? below : above) = middle;
    }
    const FillLevel without = level_at(nodes, heights, below - 2 * NodeHeights::tolerance, threads);
    const FillLevel with = level_at(nodes, heights, above, threads);
    const bool takes_layer =
        static_cast<double>(with.nodes) - count < count - static_cast<double>(without.nodes);
    return takes_layer ? with : without;
}

} // namespace fppg
