#pragma once

#include <cstddef>
#include <cstdint>

#include "core/raw_array.h"

namespace fppg
{

/// Cells along an axis of a Morton (Z-shaped) curve: three such numbers fill a word.
inline constexpr std::uint32_t most_morton_cells = 1u << 21;

/// Puts two empty bits before every bit of a number below 2^21.
inline std::uint64_t interleaved(std::uint64_t v)
{
    v = (v | v << 32) & 0x001F00000000FFFFu;
    v = (v | v << 16) & 0x001F0000FF0000FFu;
    v = (v | v << 8) & 0x100F00F00F00F00Fu;
    v = (v | v << 4) & 0x10C30C30C30C30C3u;
    v = (v | v << 2) & 0x1249249249249249u;
    return v;
}

/// Takes every third bit.
inline std::int64_t gathered(std::uint64_t v)
{
    v &= 0x1249249249249249u;
    v = (v | v >> 2) & 0x10C30C30C30C30C3u;
    v = (v | v >> 4) & 0x100F00F00F00F00Fu;
    v = (v | v >> 8) & 0x001F0000FF0000FFu;
    v = (v | v >> 16) & 0x001F00000000FFFFu;
    v = (v | v >> 32) & 0x00000000001FFFFFu;
    return static_cast<std::int64_t>(v);
}

/// Place on the curve of cell (i, j, k), each in [0, most_morton_cells).
inline std::uint64_t morton_key(std::int64_t i, std::int64_t j, std::int64_t k)
{
    return interleaved(static_cast<std::uint64_t>(i)) |
           interleaved(static_cast<std::uint64_t>(j)) << 1 |
           interleaved(static_cast<std::uint64_t>(k)) << 2;
}

struct Keyed
{
    std::uint64_t key;
    std::uint32_t index;
};

/// Sorts the first n items by key, equal keys in the order in which they come, whatever the number
/// of threads.
///
/// largest_key  no key is larger; ten bits of it cost one pass over the items
void sort_by_key(RawArray<Keyed>& items, std::size_t n, std::uint64_t largest_key, int threads);

} // namespace fppg
