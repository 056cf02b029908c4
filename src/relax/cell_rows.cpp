#include "relax/cell_rows.h"

#include "core/lanes.h"
#include "core/morton.h"
#include "core/parallel.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <limits>
#include <numeric>
#include <utility>

namespace fppg
{

namespace
{

constexpr std::size_t points_per_block = 1 << 14;

/// The cells of a block from one to another along an axis, a bit each.
///
/// low, high  what is outside of the block, 0 to 3, does not count
/// returns    bits by the last six of morton_key()
std::uint64_t cells_between(int axis, std::int64_t low, std::int64_t high)
{
    constexpr std::array<std::array<std::uint64_t, 4>, 3> planes = []
    {
        std::array<std::array<std::uint64_t, 4>, 3> out{};
        for (std::uint32_t cell = 0; cell < 64; ++cell)
            for (std::uint32_t a = 0; a < 3; ++a)
                out[a][(cell >> a & 1) | (cell >> (a + 3) & 1) << 1] |= std::uint64_t{1} << cell;
        return out;
    }();
    std::uint64_t out = 0;
    for (std::int64_t at = std::max<std::int64_t>(low, 0); at <= std::min<std::int64_t>(high, 3);
         ++at)
        out |= planes[static_cast<std::size_t>(axis)][static_cast<std::size_t>(at)];
    return out;
}

/// Where the cells along one axis begin, and how many a unit of length there are.
struct CellAxis
{
    float min = 0;
    float scale = 1;
    std::int64_t key(float x) const
    {
        return std::min(static_cast<std::uint32_t>((x - min) * scale), most_morton_cells - 1);
    }
};

struct Range
{
    float low = std::numeric_limits<float>::infinity();
    float high = -std::numeric_limits<float>::infinity();

    void add(const Range& other)
    {
        low = std::min(low, other.low);
        high = std::max(high, other.high);
    }
};

Range range_of(const std::vector<float>& values, int threads)
{
    std::vector<Range> blocks((values.size() + points_per_block - 1) / points_per_block);
    parallel_for(blocks.size(), threads,
                 [&](std::size_t b)
                 {
                     const std::size_t end = std::min(values.size(), (b + 1) * points_per_block);
                     for (std::size_t i = b * points_per_block; i < end; ++i)
                         blocks[b].add({values[i], values[i]});
                 });
    Range all;
    for (const Range& block : blocks) all.add(block);
    return all;
}

RawArray<Keyed> sorted_keys(const PointArrays& points, float cell, int threads)
{
    std::array<CellAxis, 3> axes;
    float extent = 0;
    for (const std::size_t a : {0u, 1u, 2u})
    {
        const std::vector<float>& v = a == 0 ? points.x : a == 1 ? points.y : points.z;
        if (v.empty()) continue;
        const Range range = range_of(v, threads);
        axes[a].min = range.low;
        extent = std::max(extent, range.high - range.low);
    }
    // Larger cells serve as well, only slower.
    const float side = std::max(cell, extent / static_cast<float>(most_morton_cells - 1));
    for (CellAxis& axis : axes) axis.scale = 1 / side;
    const std::size_t n = points.size();
    RawArray<Keyed> keys(n);
    parallel_for(
        n, threads,
        [&](std::size_t i)
        {
            keys[i] = {morton_key(axes[0].key(points.x[i]), axes[1].key(points.y[i]),
                                  axes[2].key(points.z[i])),
                       static_cast<std::uint32_t>(i)};
        },
        points_per_block);
    const std::uint64_t along = std::bit_width(static_cast<std::uint32_t>(extent / side));
    sort_by_key(keys, n, (std::uint64_t{1} << std::min<std::uint64_t>(3 * along, 63)) - 1, threads);
    return keys;
}

/// Points among which neighbours are looked for; behind them is room for eight more.
struct Candidates
{
    const float* x;
    const float* y;
    const float* z;
    const std::uint32_t* indices;
    std::size_t count;
};

FPPG_LANES Lanes loaded(const float* eight)
{
    Lanes out;
    std::memcpy(&out, eight, sizeof out);
    return out;
}

/// Distances from a point, which does not count itself.
struct NearPoint
{
    Lanes x, y, z;
    std::uint32_t itself;
    float limit; ///< squared

    FPPG_LANES Lanes squared(const Candidates& from, std::size_t k) const
    {
        const Lanes dx = loaded(from.x + k) - x;
        const Lanes dy = loaded(from.y + k) - y;
        const Lanes dz = loaded(from.z + k) - z;
        return dx * dx + dy * dy + dz * dz;
    }
};

/// Distances from a box.
struct NearBox
{
    std::array<Lanes, 3> low, high;
    float limit;
    static constexpr std::uint32_t itself = std::numeric_limits<std::uint32_t>::max();

    FPPG_LANES Lanes beyond(std::size_t axis, const float* at) const
    {
        const Lanes p = loaded(at);
        return larger(larger(low[axis] - p, p - high[axis]), Lanes{});
    }
    FPPG_LANES Lanes squared(const Candidates& from, std::size_t k) const
    {
        const Lanes dx = beyond(0, from.x + k);
        const Lanes dy = beyond(1, from.y + k);
        const Lanes dz = beyond(2, from.z + k);
        return dx * dx + dy * dy + dz * dz;
    }
};

/// The lanes from k on that count.
template <typename Near>
FPPG_LANES unsigned lanes_near(const Candidates& from, std::size_t k, const Near& near)
{
    LaneMask indices;
    std::memcpy(&indices, from.indices + k, sizeof indices);
    const LaneMask is_itself = indices == static_cast<std::int32_t>(near.itself);
    const LaneMask is_near = near.squared(from, k) <= near.limit;
    unsigned set = set_lanes(is_near & ~is_itself);
    if (from.count - k < lane_count) set &= (1u << (from.count - k)) - 1;
    return set;
}

/// Writes the indices of the candidates within reach, in their order; returns how many. Up to
/// eight more may be overwritten behind them.
template <typename Near>
std::size_t find_plain(const Candidates& from, const Near& near, std::uint32_t* found)
{
    std::size_t count = 0;
    for (std::size_t k = 0; k < from.count; k += lane_count)
        for (unsigned set = lanes_near(from, k, near); set != 0; set &= set - 1)
            found[count++] = from.indices[k + static_cast<std::size_t>(std::countr_zero(set))];
    return count;
}

#if defined(__x86_64__)

template <typename Near>
FPPG_AVX2 std::size_t find_avx2(const Candidates& from, const Near& near, std::uint32_t* found)
{
    std::size_t count = 0;
    for (std::size_t k = 0; k < from.count; k += lane_count)
    {
        const unsigned set = lanes_near(from, k, near);
        if (set == 0) continue;
        const __m256i indices =
            _mm256_loadu_si256(reinterpret_cast<const __m256i*>(from.indices + k));
        const __m256i order =
            _mm256_cvtepu8_epi32(_mm_cvtsi64_si128(static_cast<long long>(lane_orders.of[set])));
        _mm256_storeu_si256(reinterpret_cast<__m256i*>(found + count),
                            _mm256_permutevar8x32_epi32(indices, order));
        count += static_cast<std::size_t>(std::popcount(set));
    }
    return count;
}

#else

template <typename Near>
std::size_t find_avx2(const Candidates& from, const Near& near, std::uint32_t* found)
{
    return find_plain(from, near, found);
}

#endif

template <typename Near>
std::size_t find_within(const Candidates& from, const Near& near, std::uint32_t* found)
{
    return is_avx2_there() ? find_avx2(from, near, found) : find_plain(from, near, found);
}

/// Of the places of candidates those within reach of a point of a group, which are in the lanes.
FPPG_LANES std::size_t keep_near(const Candidates& from, const LanePoints& group, float limit,
                                 std::uint32_t* places, std::size_t count)
{
    std::size_t kept = 0;
    for (std::size_t f = 0; f < count; ++f)
    {
        const std::uint32_t k = places[f];
        const Lanes dx = group.x - lanes_of(from.x[k]);
        const Lanes dy = group.y - lanes_of(from.y[k]);
        const Lanes dz = group.z - lanes_of(from.z[k]);
        places[kept] = k;
        kept += set_lanes(dx * dx + dy * dy + dz * dz <= limit) != 0 ? 1 : 0;
    }
    return kept;
}

std::size_t keep_near_plain(const Candidates& from, const LanePoints& group, float limit,
                            std::uint32_t* places, std::size_t count)
{
    return keep_near(from, group, limit, places, count);
}

FPPG_AVX2 std::size_t keep_near_avx2(const Candidates& from, const LanePoints& group, float limit,
                                     std::uint32_t* places, std::size_t count)
{
    return keep_near(from, group, limit, places, count);
}

} // namespace

std::vector<std::uint32_t> morton_order(const PointArrays& points, float cell, int threads)
{
    const RawArray<Keyed> keys = sorted_keys(points, cell, threads);
    std::vector<std::uint32_t> order(points.size());
    parallel_for(
        order.size(), threads, [&](std::size_t k) { order[k] = keys[k].index; }, points_per_block);
    return order;
}

void CellRows::sort(const PointArrays& points, float reach, int threads)
{
    const RawArray<Keyed> keys = sorted_keys(points, reach * 1.0001f, threads);
    const std::size_t n = points.size();
    order_.resize(n);
    built_at_.resize(n);
    const auto is_first_of_cell = [&](std::size_t k)
    { return k == 0 || keys[k].key != keys[k - 1].key; };
    const std::size_t blocks = (n + points_per_block - 1) / points_per_block;
    std::vector<std::uint32_t> cells(blocks + 1, 0); // first of each block's
    const auto for_block = [&](std::size_t b, const auto& visit)
    {
        const std::size_t end = std::min(n, (b + 1) * points_per_block);
        for (std::size_t k = b * points_per_block; k < end; ++k) visit(k);
    };
    parallel_for(blocks, threads,
                 [&](std::size_t b)
                 {
                     for_block(b,
                               [&](std::size_t k)
                               {
                                   const std::uint32_t i = keys[k].index;
                                   order_[k] = i;
                                   built_at_.x[k] = points.x[i];
                                   built_at_.y[k] = points.y[i];
                                   built_at_.z[k] = points.z[i];
                                   cells[b + 1] += is_first_of_cell(k);
                               });
                 });
    for (std::size_t b = 0; b < blocks; ++b) cells[b + 1] += cells[b];
    cell_keys_.resize(cells[blocks]);
    cell_begin_.resize(cells[blocks] + 1);
    parallel_for(blocks, threads,
                 [&](std::size_t b)
                 {
                     std::size_t cell = cells[b];
                     for_block(b,
                               [&](std::size_t k)
                               {
                                   if (!is_first_of_cell(k)) return;
                                   cell_keys_[cell] = keys[k].key;
                                   cell_begin_[cell++] = static_cast<std::uint32_t>(k);
                               });
                 });
    cell_begin_.back() = static_cast<std::uint32_t>(n);
    make_block_table();
}

void CellRows::forget_cells()
{
    cell_keys_ = {};
    cell_begin_ = {};
    table_ = {};
}

void CellRows::make_block_table()
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

const CellRows::Block* CellRows::find_block(std::uint64_t key) const
{
    std::size_t slot = (key * 0x9E3779B97F4A7C15u) >> table_shift_;
    while (table_[slot].mask != 0)
    {
        if (table_[slot].key == key) return &table_[slot];
        slot = (slot + 1) & (table_.size() - 1);
    }
    return nullptr;
}

std::size_t CellRows::cell_of_row(std::size_t row) const
{
    const auto next = std::upper_bound(cell_begin_.begin(), cell_begin_.end(), row);
    return static_cast<std::size_t>(next - cell_begin_.begin()) - 1;
}

CellRows::Scratch& CellRows::scratch_of_thread()
{
    thread_local Scratch scratch;
    return scratch;
}

void CellRows::copy_rows(std::size_t begin, std::size_t end, Scratch& scratch) const
{
    const std::size_t first = scratch.count;
    scratch.count += end - begin;
    if (scratch.indices.size() < scratch.count + lane_count)
    {
        for (auto* v : {&scratch.x, &scratch.y, &scratch.z})
            v->resize(2 * scratch.count + lane_count);
        scratch.indices.resize(2 * scratch.count + lane_count);
        scratch.buffer.resize(scratch.indices.size());
        scratch.places.resize(scratch.indices.size());
        std::iota(scratch.places.begin(), scratch.places.end(), 0u);
    }
    for (std::size_t row = begin; row < end; ++row)
    {
        const std::size_t k = first + (row - begin);
        scratch.x[k] = built_at_.x[row];
        scratch.y[k] = built_at_.y[row];
        scratch.z[k] = built_at_.z[row];
        scratch.indices[k] = order_[row];
    }
}

void CellRows::gather(std::size_t cell, Scratch& scratch) const
{
    scratch.count = 0;
    const std::uint64_t own = cell_keys_[cell];
    const std::array<std::int64_t, 3> at{gathered(own), gathered(own >> 1), gathered(own >> 2)};
    std::array<std::int64_t, 3> low;
    std::array<std::int64_t, 3> high;
    for (std::size_t a = 0; a < 3; ++a)
    {
        low[a] = std::max<std::int64_t>(at[a] - 1, 0);
        high[a] = std::min<std::int64_t>(at[a] + 1, most_morton_cells - 1);
    }
    for (std::int64_t k = low[2] >> 2; k <= high[2] >> 2; ++k)
        for (std::int64_t j = low[1] >> 2; j <= high[1] >> 2; ++j)
            for (std::int64_t i = low[0] >> 2; i <= high[0] >> 2; ++i)
            {
                const Block* block = find_block(morton_key(i, j, k));
                if (block == nullptr) continue;
                const std::uint64_t wanted = cells_between(0, low[0] - 4 * i, high[0] - 4 * i) &
                                             cells_between(1, low[1] - 4 * j, high[1] - 4 * j) &
                                             cells_between(2, low[2] - 4 * k, high[2] - 4 * k);
                copy_cells(*block, block->mask & wanted, scratch);
            }
}

/// Copies the points of some of a block's cells: those that follow one another at once.
///
/// cells  a bit each, as in the block's mask
void CellRows::copy_cells(const Block& block, std::uint64_t cells, Scratch& scratch) const
{
    while (cells != 0)
    {
        const int first = std::countr_zero(cells);
        const int count = std::countr_one(cells >> first);
        const std::uint64_t before = (std::uint64_t{1} << first) - 1;
        const std::size_t c =
            block.first_cell + static_cast<std::size_t>(std::popcount(block.mask & before));
        copy_rows(cell_begin_[c], cell_begin_[c + static_cast<std::size_t>(count)], scratch);
        cells = first + count < 64 ? cells & (~std::uint64_t{0} << (first + count)) : 0;
    }
}

void CellRows::find_near(std::size_t row, float reach, Scratch& scratch) const
{
    const Candidates candidates{scratch.x.data(), scratch.y.data(), scratch.z.data(),
                                scratch.indices.data(), scratch.count};
    const NearPoint near{lanes_of(built_at_.x[row]), lanes_of(built_at_.y[row]),
                         lanes_of(built_at_.z[row]), order_[row], reach * reach};
    take_found(find_within(candidates, near, scratch.buffer.data()), scratch);
}

void CellRows::find_near_any(std::span<const std::uint32_t> rows, float reach,
                             Scratch& scratch) const
{
    const Candidates candidates{scratch.x.data(), scratch.y.data(), scratch.z.data(),
                                scratch.places.data(), scratch.count};
    LanePoints group;
    NearBox box;
    box.limit = reach * reach;
    // Nested because each lane goes into its axes' ranges.
    for (const std::size_t axis : {0u, 1u, 2u})
    {
        const std::vector<float>& at = axis == 0   ? built_at_.x
                                       : axis == 1 ? built_at_.y
                                                   : built_at_.z;
        Range range;
        Lanes lanes;
        for (std::size_t l = 0; l < lane_count; ++l)
        {
            lanes[l] = at[rows[std::min(l, rows.size() - 1)]];
            range.add({lanes[l], lanes[l]});
        }
        (axis == 0 ? group.x : axis == 1 ? group.y : group.z) = lanes;
        box.low[axis] = lanes_of(range.low);
        box.high[axis] = lanes_of(range.high);
    }
    const std::size_t count = find_within(candidates, box, scratch.buffer.data());
    const auto keep = is_avx2_there() ? keep_near_avx2 : keep_near_plain;
    take_found(keep(candidates, group, box.limit, scratch.buffer.data(), count), scratch);
}

bool CellRows::has_moved(const PointArrays& points, float distance, int threads) const
{
    const std::size_t n = points.size();
    if (n != built_at_.size()) return true;
    const float limit = distance * distance;
    const std::size_t blocks = (n + points_per_block - 1) / points_per_block;
    std::vector<char> is_far(blocks, 0);
    parallel_for(blocks, threads,
                 [&](std::size_t b)
                 {
                     float largest = 0;
                     const std::size_t end = std::min(n, (b + 1) * points_per_block);
                     for (std::size_t row = b * points_per_block; row < end; ++row)
                     {
                         const std::uint32_t i = order_[row];
                         const float dx = points.x[i] - built_at_.x[row];
                         const float dy = points.y[i] - built_at_.y[row];
                         const float dz = points.z[i] - built_at_.z[row];
                         largest = std::max(largest, dx * dx + dy * dy + dz * dz);
                     }
                     is_far[b] = largest > limit;
                 });
    return std::find(is_far.begin(), is_far.end(), 1) != is_far.end();
}

} // namespace fppg
