#include "core/morton.h"

#include "core/parallel.h"

#include <algorithm>
#include <array>
#include <utility>
#include <vector>

namespace fppg
{

// Least significant digits first; every block of items counts its digits, so that all know where
// theirs go.
void sort_by_key(RawArray<Keyed>& items, std::size_t n, std::uint64_t largest_key, int threads)
{
    constexpr std::size_t items_per_block = 1 << 14;
    constexpr unsigned digit_bits = 10;
    constexpr std::size_t digits = 1 << digit_bits;
    const std::size_t blocks = std::clamp<std::size_t>(n / items_per_block, 1, 64);
    const auto begin_of = [&](std::size_t block) { return n * block / blocks; };
    RawArray<Keyed> other(n);
    std::vector<std::array<std::uint32_t, digits>> counts(blocks);
    for (unsigned shift = 0; shift < 64 && largest_key >> shift != 0; shift += digit_bits)
    {
        const auto digit = [&](const Keyed& item) { return item.key >> shift & (digits - 1); };
        parallel_for(blocks, threads,
                     [&](std::size_t b)
                     {
                         counts[b].fill(0);
                         for (std::size_t k = begin_of(b); k < begin_of(b + 1); ++k)
                             ++counts[b][digit(items[k])];
                     });
        std::uint32_t sum = 0;
        for (std::size_t d = 0; d < digits; ++d)
            for (auto& count : counts) sum += std::exchange(count[d], sum);
        parallel_for(blocks, threads,
                     [&](std::size_t b)
                     {
                         for (std::size_t k = begin_of(b); k < begin_of(b + 1); ++k)
                             other[counts[b][digit(items[k])]++] = items[k];
                     });
        items.swap(other);
    }
}

} // namespace fppg
