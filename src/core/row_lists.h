#pragma once

#include "core/parallel.h"

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <numeric>
#include <span>
#include <vector>

namespace fppg
{

/// Values in rows of any length, one behind the other.
template <typename Value>
struct RowLists
{
    std::vector<std::size_t> first; ///< per row, and one past the end
    std::vector<Value> values;

    std::span<const Value> row(std::size_t r) const
    {
        return {values.data() + first[r], values.data() + first[r + 1]};
    }
};

/// Puts what belongs to items into rows; the values of a row come in ascending order.
///
/// for_item(item, add)  calls add(row, value) for each; the same ones every time it is called, and
///                      from several threads
template <typename Value, typename ForItem>
RowLists<Value> make_row_lists(std::size_t rows, std::size_t items, int threads,
                               const ForItem& for_item)
{
    constexpr std::size_t chunk = 4096;
    RowLists<Value> out;
    out.first.assign(rows + 1, 0);
    parallel_for(
        items, threads,
        [&](std::size_t item)
        {
            for_item(
                item, [&](std::size_t row, const Value&)
                { std::atomic_ref(out.first[row + 1]).fetch_add(1, std::memory_order_relaxed); });
        },
        chunk);
    std::partial_sum(out.first.begin(), out.first.end(), out.first.begin());
    out.values.resize(out.first.back());
    std::vector<std::size_t> next(out.first.begin(), out.first.end() - 1);
    parallel_for(
        items, threads,
        [&](std::size_t item)
        {
            for_item(
                item,
                [&](std::size_t row, const Value& value) {
                    out.values[std::atomic_ref(next[row]).fetch_add(1, std::memory_order_relaxed)] =
                        value;
                });
        },
        chunk);
    // The order in which threads came does not stay.
    parallel_for(
        rows, threads,
        [&](std::size_t row)
        {
            std::sort(out.values.begin() + static_cast<std::ptrdiff_t>(out.first[row]),
                      out.values.begin() + static_cast<std::ptrdiff_t>(out.first[row + 1]));
        },
        chunk);
    return out;
}

} // namespace fppg
