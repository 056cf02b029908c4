#pragma once

#include "core/parallel.h"
#include "fit/chart_filler.h"

#include <condition_variable>
#include <memory>
#include <mutex>
#include <queue>
#include <utility>
#include <vector>

namespace fppg
{

/// Charts in an order that any number of threads can work through: a chart is ready when all charts
/// near it that belong to earlier waves are done. What a step sees of the charts near its own so
/// depends on the waves alone.
class ChartOrder
{
public:
    explicit ChartOrder(const Charts& charts) : charts_(&charts), waves_(charts.size(), 0)
    {
        for (std::uint32_t w = 0; w < charts.waves().size(); ++w)
            for (const std::uint32_t chart : charts.waves()[w]) waves_[chart] = w;
        awaited_.assign(charts.size(), 0);
        for (std::uint32_t chart = 0; chart < charts.size(); ++chart)
        {
            for (const std::uint32_t other : charts.near_charts(chart))
                awaited_[chart] += waves_[other] < waves_[chart];
            if (awaited_[chart] == 0) ready_.emplace(waves_[chart], chart);
        }
    }

    /// A chart that is ready, of the earliest wave; waits for one. To be called once a chart.
    std::uint32_t take()
    {
        std::unique_lock lock(guard_);
        is_one_ready_.wait(lock, [&] { return !ready_.empty(); });
        const std::uint32_t chart = ready_.top().second;
        ready_.pop();
        return chart;
    }

    void finish(std::uint32_t chart)
    {
        const std::lock_guard lock(guard_);
        for (const std::uint32_t other : charts_->near_charts(chart))
            if (waves_[other] > waves_[chart] && --awaited_[other] == 0)
                ready_.emplace(waves_[other], other);
        is_one_ready_.notify_all();
    }

private:
    using Place = std::pair<std::uint32_t, std::uint32_t>; ///< wave, chart

    const Charts* charts_;
    std::vector<std::uint32_t> waves_;
    std::vector<std::uint32_t> awaited_; ///< near charts of earlier waves that are not done
    std::priority_queue<Place, std::vector<Place>, std::greater<>> ready_;
    std::mutex guard_;
    std::condition_variable is_one_ready_;
};

/// Runs step(filler, chart) on every chart in their order; fillers keep their memory from chart to
/// chart. The result does not depend on the number of threads.
template <typename Step>
void for_each_chart(FillState& state, int threads, const Step& step)
{
    ChartOrder order(state.charts);
    std::vector<std::unique_ptr<ChartFiller>> idle;
    std::mutex guard;
    parallel_for(state.charts.size(), threads,
                 [&](std::size_t)
                 {
                     struct Turn
                     {
                         ChartOrder& order;
                         std::uint32_t chart;
                         // Whoever waits for this chart must go on even if it fails.
                         ~Turn() { order.finish(chart); }
                     };
                     const Turn turn{order, order.take()};
                     std::unique_ptr<ChartFiller> filler;
                     {
                         const std::lock_guard lock(guard);
                         if (!idle.empty())
                         {
                             filler = std::move(idle.back());
                             idle.pop_back();
                         }
                     }
                     if (!filler) filler = std::make_unique<ChartFiller>(state);
                     step(*filler, turn.chart);
                     const std::lock_guard lock(guard);
                     idle.push_back(std::move(filler));
                 });
}

} // namespace fppg
