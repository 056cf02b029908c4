#pragma once

#include <algorithm>
#include <vector>

#include "core/parallel.h"

namespace fppg
{

/// Sorts by `less`, which must order all elements totally (no two equal ones), so that the result
/// does not depend on the number of threads. Sorts blocks, then merges pairs of them.
template <typename T, typename Less>
void parallel_sort(std::vector<T>& items, int threads, const Less& less)
{
    constexpr std::size_t smallest_block = 1 << 15;
    std::size_t blocks = 1;
    while (blocks < static_cast<std::size_t>(std::max(threads, 1)) &&
           items.size() / (2 * blocks) >= smallest_block)
        blocks *= 2;
    const auto at = [&](std::size_t block, std::size_t of)
    { return items.begin() + static_cast<std::ptrdiff_t>(items.size() * block / of); };
    parallel_for(blocks, threads,
                 [&](std::size_t i) { std::sort(at(i, blocks), at(i + 1, blocks), less); });
    for (std::size_t left = blocks; left > 1; left /= 2)
        parallel_for(left / 2, threads,
                     [&](std::size_t i) {
                         std::inplace_merge(at(2 * i, left), at(2 * i + 1, left),
                                            at(2 * i + 2, left), less);
                     });
}

} // namespace fppg
