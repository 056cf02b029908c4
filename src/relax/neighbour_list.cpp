#include "relax/neighbour_list.h"

#include <algorithm>
#include <array>
#include <bit>
#include <utility>

namespace fppg
{

namespace
{

/// Cells along an axis: three such numbers fill a word.
constexpr std::uint32_t most_cells = 1u << 21;
constexpr std::size_t points_a_block = 1 << 14;

/// Puts two empty bits before every bit of a number below 2^21.
std::uint64_t spread(std::uint64_t v)
{
    v = (v | v << 32) & 0x001F00000000FFFFu;
    v = (v | v << 16) & 0x001F0000FF0000FFu;
    v = (v | v << 8) & 0x100F00F00F00F00Fu;
    v = (v | v << 4) & 0x10C30C30C30C30C3u;
    v = (v | v << 2) & 0x1249249249249249u;
    return v;
}

/// Takes every third bit.
std::int64_t gathered(std::uint64_t v)
{
    v &= 0x1249249249249249u;
    v = (v | v >> 2) & 0x10C30C30C30C30C3u;
    v = (v | v >> 4) & 0x100F00F00F00F00Fu;
    v = (v | v >> 8) & 0x001F0000FF0000FFu;
    v = (v | v >> 16) & 0x001F00000000FFFFu;
    v = (v | v >> 32) & 0x00000000001FFFFFu;
    return static_cast<std::int64_t>(v);
}

std::uint64_t morton_key(std::int64_t i, std::int64_t j, std::int64_t k)
{
    return spread(static_cast<std::uint64_t>(i)) | spread(static_cast<std::uint64_t>(j)) << 1 |
           spread(static_cast<std::uint64_t>(k)) << 2;
}

/// Where the cells along one axis begin, and how many a unit of length there are.
struct CellAxis
{
    float min = 0;
    float scale = 1;
    std::uint64_t key(float x) const
    {
        return std::min(static_cast<std::uint32_t>((x - min) * scale), most_cells - 1);
    }
};

struct Keyed
{
    std::uint64_t key;
    std::uint32_t index;
};

/// Sorts by key, equal keys in the order in which they come. Least significant digits first; every
/// block of items counts its digits, so that all know where theirs go.
void sort_by_key(std::vector<Keyed>& items, std::uint64_t largest_key, int threads)
{
    constexpr unsigned digit_bits = 10;
    constexpr std::size_t digits = 1 << digit_bits;
    const std::size_t n = items.size();
    const std::size_t blocks = std::clamp<std::size_t>(n / points_a_block, 1, 64);
    const auto begin_of = [&](std::size_t block) { return n * block / blocks; };
    std::vector<Keyed> other(n);
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

std::vector<Keyed> sorted_keys(const PointArrays& points, float cell, int threads)
{
    std::array<CellAxis, 3> axes;
    float extent = 0;
    for (const std::size_t a : {0u, 1u, 2u})
    {
        const std::vector<float>& v = a == 0 ? points.x : a == 1 ? points.y : points.z;
        if (v.empty()) continue;
        const auto [low, high] = std::minmax_element(v.begin(), v.end());
        axes[a].min = *low;
        extent = std::max(extent, *high - *low);
    }
    // Larger cells serve as well, only slower.
    const float side = std::max(cell, extent / static_cast<float>(most_cells - 1));
    for (CellAxis& axis : axes) axis.scale = 1 / side;
    std::vector<Keyed> keys(points.size());
    parallel_for(
        keys.size(), threads,
        [&](std::size_t i)
        {
            keys[i] = {spread(axes[0].key(points.x[i])) | spread(axes[1].key(points.y[i])) << 1 |
                           spread(axes[2].key(points.z[i])) << 2,
                       static_cast<std::uint32_t>(i)};
        },
        points_a_block);
    const std::uint64_t along = std::bit_width(static_cast<std::uint32_t>(extent / side));
    sort_by_key(keys, (std::uint64_t{1} << std::min<std::uint64_t>(3 * along, 63)) - 1, threads);
    return keys;
}

} // namespace

std::vector<std::uint32_t> morton_order(const PointArrays& points, float cell, int threads)
{
    const std::vector<Keyed> keys = sorted_keys(points, cell, threads);
    std::vector<std::uint32_t> order(keys.size());
    for (std::size_t k = 0; k < keys.size(); ++k) order[k] = keys[k].index;
    return order;
}

void NeighbourList::sort_into_cells(const PointArrays& points, int threads)
{
    built_at_ = points;
    // A cell is a little larger than the reach, so that rounding moves no neighbour two cells off.
    const std::vector<Keyed> keys = sorted_keys(points, reach_ * 1.0001f, threads);
    order_.resize(keys.size());
    cell_keys_.clear();
    cell_begin_.clear();
    for (std::uint32_t k = 0; k < keys.size(); ++k)
    {
        order_[k] = keys[k].index;
        if (k > 0 && keys[k].key == keys[k - 1].key) continue;
        cell_keys_.push_back(keys[k].key);
        cell_begin_.push_back(k);
    }
    cell_begin_.push_back(static_cast<std::uint32_t>(keys.size()));
    make_block_table();
}

void NeighbourList::forget_cells()
{
    cell_keys_ = {};
    cell_begin_ = {};
    table_ = {};
}

void NeighbourList::make_block_table()
{
    std::size_t blocks = 0;
    for (std::size_t c = 0; c < cell_keys_.size(); ++c)
        blocks += c == 0 || cell_keys_[c] >> 6 != cell_keys_[c - 1] >> 6;
    const std::size_t slots = std::bit_ceil(std::max<std::size_t>(2 * blocks, 2));
    table_shift_ = 64 - std::countr_zero(slots);
    table_.assign(slots, {});
    Block* block = nullptr;
    for (std::uint32_t c = 0; c < cell_keys_.size(); ++c)
    {
        const std::uint64_t key = cell_keys_[c] >> 6;
        if (block == nullptr || block->key != key)
        {
            std::size_t slot = (key * 0x9E3779B97F4A7C15u) >> table_shift_;
            while (table_[slot].mask != 0) slot = (slot + 1) & (slots - 1);
            block = &table_[slot];
            block->key = key;
            block->first_cell = c;
        }
        block->mask |= std::uint64_t{1} << (cell_keys_[c] & 63);
    }
}

const NeighbourList::Block* NeighbourList::find_block(std::uint64_t key) const
{
    std::size_t slot = (key * 0x9E3779B97F4A7C15u) >> table_shift_;
    while (table_[slot].mask != 0)
    {
        if (table_[slot].key == key) return &table_[slot];
        slot = (slot + 1) & (table_.size() - 1);
    }
    return nullptr;
}

std::size_t NeighbourList::cell_of_row(std::size_t row) const
{
    const auto next = std::upper_bound(cell_begin_.begin(), cell_begin_.end(), row);
    return static_cast<std::size_t>(next - cell_begin_.begin()) - 1;
}

NeighbourList::Scratch& NeighbourList::scratch_of_thread()
{
    thread_local Scratch scratch;
    return scratch;
}

void NeighbourList::gather(std::size_t cell, const PointArrays& points, Scratch& scratch) const
{
    scratch.indices.clear();
    const std::uint64_t own = cell_keys_[cell];
    const std::array<std::int64_t, 3> at{gathered(own), gathered(own >> 1), gathered(own >> 2)};
    std::array<std::int64_t, 3> low;
    std::array<std::int64_t, 3> high;
    for (std::size_t a = 0; a < 3; ++a)
    {
        low[a] = std::max<std::int64_t>(at[a] - 1, 0);
        high[a] = std::min<std::int64_t>(at[a] + 1, most_cells - 1);
    }
    const auto visit_block = [&](std::int64_t bi, std::int64_t bj, std::int64_t bk)
    {
        const Block* block = find_block(morton_key(bi, bj, bk));
        if (block == nullptr) return;
        for (std::int64_t k = std::max(low[2], 4 * bk); k <= std::min(high[2], 4 * bk + 3); ++k)
            for (std::int64_t j = std::max(low[1], 4 * bj); j <= std::min(high[1], 4 * bj + 3); ++j)
                for (std::int64_t i = std::max(low[0], 4 * bi); i <= std::min(high[0], 4 * bi + 3);
                     ++i)
                {
                    const std::uint64_t bit = std::uint64_t{1} << (morton_key(i, j, k) & 63);
                    if ((block->mask & bit) == 0) continue;
                    const std::size_t c =
                        block->first_cell +
                        static_cast<std::size_t>(std::popcount(block->mask & (bit - 1)));
                    for (std::uint32_t row = cell_begin_[c]; row < cell_begin_[c + 1]; ++row)
                        scratch.indices.push_back(order_[row]);
                }
    };
    for (std::int64_t k = low[2] >> 2; k <= high[2] >> 2; ++k)
        for (std::int64_t j = low[1] >> 2; j <= high[1] >> 2; ++j)
            for (std::int64_t i = low[0] >> 2; i <= high[0] >> 2; ++i) visit_block(i, j, k);
    const std::size_t n = scratch.indices.size();
    if (scratch.x.size() < n)
        for (auto* v : {&scratch.x, &scratch.y, &scratch.z, &scratch.squared}) v->resize(2 * n);
    if (scratch.found.capacity() < n) scratch.found.reserve(2 * n);
    for (std::size_t k = 0; k < n; ++k)
    {
        scratch.x[k] = points.x[scratch.indices[k]];
        scratch.y[k] = points.y[scratch.indices[k]];
        scratch.z[k] = points.z[scratch.indices[k]];
    }
}

void NeighbourList::find_near(std::uint32_t i, const PointArrays& points, Scratch& scratch) const
{
    const std::size_t n = scratch.indices.size();
    const float x = points.x[i];
    const float y = points.y[i];
    const float z = points.z[i];
    const float* xs = scratch.x.data();
    const float* ys = scratch.y.data();
    const float* zs = scratch.z.data();
    float* squared = scratch.squared.data();
#pragma omp simd
    for (std::size_t k = 0; k < n; ++k)
    {
        const float dx = xs[k] - x;
        const float dy = ys[k] - y;
        const float dz = zs[k] - z;
        squared[k] = dx * dx + dy * dy + dz * dz;
    }
    const float limit = reach_ * reach_;
    scratch.found.resize(n);
    std::uint32_t* found = scratch.found.data();
    const std::uint32_t* indices = scratch.indices.data();
    std::size_t count = 0;
    // Written in any case and counted where it is near: no branch to foretell.
    for (std::size_t k = 0; k < n; ++k)
    {
        found[count] = indices[k];
        count += static_cast<std::size_t>(squared[k] <= limit) & (indices[k] != i);
    }
    scratch.found.resize(count);
}

bool NeighbourList::is_outdated(const PointArrays& points, int threads) const
{
    const std::size_t n = points.size();
    if (n != built_at_.size()) return true;
    const float limit = 0.25f * skin_ * skin_;
    const std::size_t blocks = (n + points_a_block - 1) / points_a_block;
    std::vector<char> is_far(blocks, 0);
    parallel_for(blocks, threads,
                 [&](std::size_t b)
                 {
                     float largest = 0;
                     const std::size_t end = std::min(n, (b + 1) * points_a_block);
#pragma omp simd reduction(max : largest)
                     for (std::size_t i = b * points_a_block; i < end; ++i)
                     {
                         const float dx = points.x[i] - built_at_.x[i];
                         const float dy = points.y[i] - built_at_.y[i];
                         const float dz = points.z[i] - built_at_.z[i];
                         largest = std::max(largest, dx * dx + dy * dy + dz * dz);
                     }
                     is_far[b] = largest > limit;
                 });
    return std::find(is_far.begin(), is_far.end(), 1) != is_far.end();
}

} // namespace fppg
