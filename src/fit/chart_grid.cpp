#include "fit/chart_grid.h"

#include "core/lanes.h"

#include <algorithm>
#include <bit>

namespace fppg
{

namespace
{

FPPG_LANES Lanes loaded(const float* values)
{
    Lanes v;
    __builtin_memcpy(&v, values, sizeof v);
    return v;
}

struct Near
{
    float* x;
    float* y;
    float* z;
    std::uint32_t* index;
};

/// The points of a block.
struct BlockArrays
{
    const float* x;
    const float* y;
    const float* z;
    const std::uint32_t* index;
};

/// Points of a block (sixteen of them) that are near, to be put behind the `count` found.
std::size_t take_near_plain(const BlockArrays& block, const std::array<float, 4>& search,
                            const Near& near, std::size_t count)
{
    const auto [xs, ys, zs, indices] = block;
    for (std::size_t n = 0; n < 16; ++n)
    {
        const float x = xs[n] - search[0];
        const float y = ys[n] - search[1];
        const float z = zs[n] - search[2];
        const float squared = x * x + y * y + z * z;
        near.x[count] = x;
        near.y[count] = y;
        near.z[count] = z;
        near.index[count] = indices[n];
        count += squared < search[3];
    }
    return count;
}

#if defined(__x86_64__)

FPPG_AVX2 std::size_t take_near_avx2(const BlockArrays& block, const std::array<float, 4>& search,
                                     const Near& near, std::size_t count)
{
    const auto [xs, ys, zs, indices] = block;
    for (std::size_t n = 0; n < 16; n += lane_count)
    {
        const __m256 x = _mm256_sub_ps(_mm256_loadu_ps(xs + n), _mm256_set1_ps(search[0]));
        const __m256 y = _mm256_sub_ps(_mm256_loadu_ps(ys + n), _mm256_set1_ps(search[1]));
        const __m256 z = _mm256_sub_ps(_mm256_loadu_ps(zs + n), _mm256_set1_ps(search[2]));
        const __m256 squared = _mm256_add_ps(
            _mm256_add_ps(_mm256_mul_ps(x, x), _mm256_mul_ps(y, y)), _mm256_mul_ps(z, z));
        const auto set = static_cast<unsigned>(
            _mm256_movemask_ps(_mm256_cmp_ps(squared, _mm256_set1_ps(search[3]), _CMP_LT_OQ)));
        if (set == 0) continue;
        const __m256i order =
            _mm256_cvtepu8_epi32(_mm_cvtsi64_si128(static_cast<long long>(lane_orders.of[set])));
        _mm256_storeu_ps(near.x + count, _mm256_permutevar8x32_ps(x, order));
        _mm256_storeu_ps(near.y + count, _mm256_permutevar8x32_ps(y, order));
        _mm256_storeu_ps(near.z + count, _mm256_permutevar8x32_ps(z, order));
        _mm256_storeu_si256(
            reinterpret_cast<__m256i*>(near.index + count),
            _mm256_permutevar8x32_epi32(
                _mm256_loadu_si256(reinterpret_cast<const __m256i*>(indices + n)), order));
        count += static_cast<std::size_t>(std::popcount(set));
    }
    return count;
}

#else

constexpr auto take_near_avx2 = take_near_plain;

#endif

FPPG_LANES NearestPoint nearest_in_lanes(const NearPoints& near, const std::array<float, 3>& shift)
{
    const Lanes sx = lanes_of(shift[0]);
    const Lanes sy = lanes_of(shift[1]);
    const Lanes sz = lanes_of(shift[2]);
    Lanes best = lanes_of(far_away_dp);
    LaneMask best_at{};
    LaneMask at{0, 1, 2, 3, 4, 5, 6, 7};
    for (std::size_t n = 0; n < near.count; n += lane_count)
    {
        const Lanes x = loaded(near.x.data() + n) - sx;
        const Lanes y = loaded(near.y.data() + n) - sy;
        const Lanes z = loaded(near.z.data() + n) - sz;
        const Lanes squared = x * x + y * y + z * z;
        best_at = squared < best ? at : best_at;
        best = smaller(squared, best);
        at += 8;
    }
    NearestPoint found{best[0], static_cast<std::uint32_t>(best_at[0])};
    for (std::size_t l = 1; l < lane_count; ++l)
        if (best[l] < found.squared) found = {best[l], static_cast<std::uint32_t>(best_at[l])};
    return found;
}

FPPG_LANES NearestPoints nearest_of_each(const NearPoints& near, const EightNumbers& xs,
                                         const EightNumbers& ys, const EightNumbers& zs)
{
    const Lanes x = loaded(xs.data());
    const Lanes y = loaded(ys.data());
    const Lanes z = loaded(zs.data());
    Lanes best = lanes_of(far_away_dp);
    LaneMask best_at{};
    for (std::size_t n = 0; n < near.count; ++n)
    {
        const Lanes dx = near.x[n] - x;
        const Lanes dy = near.y[n] - y;
        const Lanes dz = near.z[n] - z;
        const Lanes squared = dx * dx + dy * dy + dz * dz;
        best_at = squared < best ? LaneMask{} + static_cast<std::int32_t>(n) : best_at;
        best = smaller(squared, best);
    }
    NearestPoints found;
    for (std::size_t l = 0; l < lane_count; ++l)
    {
        found.squared[l] = best[l];
        found.at[l] = static_cast<std::uint32_t>(best_at[l]);
    }
    return found;
}

NearestPoint nearest_plain(const NearPoints& near, const std::array<float, 3>& shift)
{
    return nearest_in_lanes(near, shift);
}
FPPG_AVX2 NearestPoint nearest_avx2(const NearPoints& near, const std::array<float, 3>& shift)
{
    return nearest_in_lanes(near, shift);
}
NearestPoints nearest_of_each_plain(const NearPoints& near, const EightNumbers& xs,
                                    const EightNumbers& ys, const EightNumbers& zs)
{
    return nearest_of_each(near, xs, ys, zs);
}
FPPG_AVX2 NearestPoints nearest_of_each_avx2(const NearPoints& near, const EightNumbers& xs,
                                             const EightNumbers& ys, const EightNumbers& zs)
{
    return nearest_of_each(near, xs, ys, zs);
}

} // namespace

void NearPoints::reserve(std::size_t n)
{
    const std::size_t room = n + 3 * lane_count;
    if (x.size() >= room) return;
    x.resize(room);
    y.resize(room);
    z.resize(room);
    index.resize(room);
}

void NearPoints::push_back(const Vec3& offset, std::uint32_t point)
{
    reserve(count + 1);
    x[count] = static_cast<float>(offset.x);
    y[count] = static_cast<float>(offset.y);
    z[count] = static_cast<float>(offset.z);
    index[count++] = point;
    for (std::size_t n = count; n % lane_count != 0; ++n) x[n] = far_away_dp;
}

void ChartGrid::start(double dp, const Vec3& origin)
{
    dp_ = dp;
    per_dp_ = 1 / dp;
    origin_ = origin;
    points_.clear();
    blocks_.clear();
    for (const std::uint32_t slot : used_) heads_[slot] = none;
    used_.clear();
}

void ChartGrid::add(const Vec3& point)
{
    const Vec3 p = in_dp(point);
    const std::size_t slot = slot_of(cell_of(p.x), cell_of(p.y), cell_of(p.z));
    if (heads_[slot] == none) used_.push_back(static_cast<std::uint32_t>(slot));
    if (heads_[slot] == none || blocks_[heads_[slot]].count == Block::capacity)
    {
        blocks_.emplace_back();
        blocks_.back().next = heads_[slot];
        heads_[slot] = static_cast<std::uint32_t>(blocks_.size() - 1);
    }
    Block& block = blocks_[heads_[slot]];
    block.x[block.count] = static_cast<float>(p.x);
    block.y[block.count] = static_cast<float>(p.y);
    block.z[block.count] = static_cast<float>(p.z);
    block.index[block.count++] = size();
    points_.push_back(point);
}

void ChartGrid::find_near(const Vec3& place, double radius, NearPoints& near) const
{
    const Vec3 p = in_dp(place);
    const std::array<float, 4> search{static_cast<float>(p.x), static_cast<float>(p.y),
                                      static_cast<float>(p.z), static_cast<float>(radius * radius)};
    const auto take_near = is_avx2_there() ? take_near_avx2 : take_near_plain;
    const std::array<std::int64_t, 3> low{cell_of(p.x - radius), cell_of(p.y - radius),
                                          cell_of(p.z - radius)};
    const std::array<std::int64_t, 3> high{cell_of(p.x + radius), cell_of(p.y + radius),
                                           cell_of(p.z + radius)};
    std::size_t count = 0;
    // Nested because the cells around a place are walked along three axes.
    for (auto i = low[0]; i <= high[0]; ++i)
        for (auto j = low[1]; j <= high[1]; ++j)
            for (auto k = low[2]; k <= high[2]; ++k)
                for (std::uint32_t b = heads_[slot_of(i, j, k)]; b != none; b = blocks_[b].next)
                {
                    near.reserve(count + Block::capacity);
                    const Block& block = blocks_[b];
                    count = take_near(
                        {block.x.data(), block.y.data(), block.z.data(), block.index.data()},
                        search, {near.x.data(), near.y.data(), near.z.data(), near.index.data()},
                        count);
                }
    near.reserve(count);
    near.count = count;
    for (std::size_t n = count; n < count + lane_count; ++n) near.x[n] = far_away_dp;
}

NearestPoint nearest_to(const NearPoints& near, const Vec3& shift)
{
    const std::array<float, 3> s{static_cast<float>(shift.x), static_cast<float>(shift.y),
                                 static_cast<float>(shift.z)};
    return is_avx2_there() ? nearest_avx2(near, s) : nearest_plain(near, s);
}

NearestPoints nearest_to_each(const NearPoints& near, const EightNumbers& xs,
                              const EightNumbers& ys, const EightNumbers& zs)
{
    return is_avx2_there() ? nearest_of_each_avx2(near, xs, ys, zs)
                           : nearest_of_each_plain(near, xs, ys, zs);
}

} // namespace fppg
