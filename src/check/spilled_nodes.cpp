#include "check/spilled_nodes.h"

#include <algorithm>
#include <functional>
#include <queue>
#include <utility>

namespace fppg
{
namespace
{

constexpr std::uint32_t never = UINT32_MAX;

/// Runs with the column of each.
struct Runs
{
    const FillNodes& nodes;
    std::vector<std::size_t> columns;

    explicit Runs(const FillNodes& all) : nodes(all), columns(all.runs.size())
    {
        for (std::size_t c = 0; c + 1 < nodes.begins.size(); ++c)
            for (std::uint64_t r = nodes.begins[c]; r < nodes.begins[c + 1]; ++r) columns[r] = c;
    }
    bool is_in_box(std::uint64_t r) const { return nodes.side_of(columns[r], nodes.runs[r]) < 0; }
    /// What of a run is not above a height.
    FillNodes::NodeRun up_to(std::uint64_t r, std::uint32_t top) const
    {
        return {nodes.runs[r].begin, std::min(nodes.runs[r].end, top + 1)};
    }
};

/// Runs that fluid comes to without rising above a height.
std::vector<std::uint8_t> reached_below(const Runs& runs, const std::vector<std::uint8_t>& at_first,
                                        std::uint32_t top)
{
    std::vector<std::uint8_t> reached(at_first.size(), 0);
    std::vector<std::uint64_t> next;
    const auto reach = [&](std::uint64_t r)
    {
        if (reached[r] || runs.nodes.runs[r].begin > top || !runs.is_in_box(r)) return;
        reached[r] = 1;
        next.push_back(r);
    };
    for (std::uint64_t r = 0; r < at_first.size(); ++r)
        if (at_first[r]) reach(r);
    while (!next.empty())
    {
        const std::uint64_t r = next.back();
        next.pop_back();
        runs.nodes.for_each_beside(runs.columns[r], runs.up_to(r, top),
                                   [&](std::uint64_t other, std::size_t) { reach(other); });
    }
    return reached;
}

/// Per run the least height from which fluid runs down out of the box, past runs that hold it.
std::vector<std::uint32_t> draining_heights(const Runs& runs, const std::vector<std::uint8_t>& wet,
                                            const std::vector<std::uint8_t>& holds,
                                            std::uint32_t top)
{
    const auto bottom = static_cast<std::uint32_t>(runs.nodes.beyond[2]);
    std::vector<std::uint32_t> heights(wet.size(), never);
    using Entry = std::pair<std::uint32_t, std::uint64_t>;
    std::priority_queue<Entry, std::vector<Entry>, std::greater<>> open;
    const auto lower = [&](std::uint64_t r, std::uint32_t height)
    {
        height = std::max({height, runs.nodes.runs[r].begin, holds[r] ? top + 1 : 0});
        if (!wet[r] || !runs.is_in_box(r) || height >= std::min(heights[r], runs.nodes.runs[r].end))
            return;
        heights[r] = height;
        open.emplace(height, r);
    };
    for (std::uint64_t r = 0; r < wet.size(); ++r)
        if (runs.nodes.runs[r].begin == bottom && !holds[r]) lower(r, bottom);
    while (!open.empty())
    {
        const auto [height, r] = open.top();
        open.pop();
        if (height > heights[r]) continue;
        runs.nodes.for_each_beside(runs.columns[r], {height, runs.nodes.runs[r].end},
                                   [&, from = height](std::uint64_t other, std::size_t)
                                   { lower(other, from); });
    }
    return heights;
}

} // namespace

void leave_out_spilled(FillNodes& nodes, const FluidAtStart& fluid, std::uint32_t above,
                       std::vector<std::uint8_t>& wet)
{
    const Runs runs(nodes);
    const std::vector<std::uint8_t> holds = reached_below(runs, fluid.is_beside, fluid.top);
    const std::vector<std::uint32_t> heights = draining_heights(runs, wet, holds, fluid.top);
    for (std::uint64_t r = 0; r < wet.size(); ++r)
    {
        FillNodes::NodeRun& run = nodes.runs[r];
        if (heights[r] <= run.begin)
            wet[r] = 0;
        else if (heights[r] != never)
            run.end = std::min(run.end, heights[r] + above);
    }
}

} // namespace fppg
