#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#if defined(__SSE2__)
#include <immintrin.h>
#else
#include <cmath>
#endif

namespace fppg
{

/// Eight numbers that go through the loops side by side. With AVX2 they are one register, without
/// it two or eight: the same sums in the same order, so that results do not depend on the machine.
using Lanes = float __attribute__((vector_size(32)));
/// Four numbers, half of the lanes.
using HalfLanes = float __attribute__((vector_size(16)));
using LaneMask = std::int32_t __attribute__((vector_size(32)));
/// Four numbers of double precision, a register as well.
using DoubleLanes = double __attribute__((vector_size(32)));
using DoubleMask = std::int64_t __attribute__((vector_size(32)));

inline constexpr std::size_t lane_count = 8;

/// Loops over lanes are written once, as functions that are inlined into one that may use AVX2 and
/// one that may not; is_avx2_there() says which to call.
#define FPPG_LANES [[gnu::always_inline]] inline
#if defined(__x86_64__)
#define FPPG_AVX2 [[gnu::target("avx2,popcnt")]]
inline bool is_avx2_there()
{
    static const bool is_there =
        __builtin_cpu_supports("avx2") != 0 && __builtin_cpu_supports("popcnt") != 0;
    return is_there;
}
#else
#define FPPG_AVX2
inline bool is_avx2_there()
{
    return false;
}
#endif

FPPG_LANES Lanes lanes_of(float value)
{
    const HalfLanes first{value};
    return __builtin_shufflevector(first, first, 0, 0, 0, 0, 0, 0, 0, 0);
}

FPPG_LANES Lanes larger(const Lanes& a, const Lanes& b)
{
    return a > b ? a : b;
}

FPPG_LANES Lanes smaller(const Lanes& a, const Lanes& b)
{
    return a < b ? a : b;
}

/// One bit a lane that is set.
FPPG_LANES unsigned set_lanes(const LaneMask& mask)
{
#if defined(__SSE2__)
    const auto low = reinterpret_cast<__m128>(__builtin_shufflevector(mask, mask, 0, 1, 2, 3));
    const auto high = reinterpret_cast<__m128>(__builtin_shufflevector(mask, mask, 4, 5, 6, 7));
    return static_cast<unsigned>(_mm_movemask_ps(low) | _mm_movemask_ps(high) << 4);
#else
    unsigned set = 0;
    for (unsigned l = 0; l < lane_count; ++l) set |= mask[l] != 0 ? 1u << l : 0;
    return set;
#endif
}

FPPG_LANES DoubleLanes larger(const DoubleLanes& a, const DoubleLanes& b)
{
    return a > b ? a : b;
}

FPPG_LANES DoubleLanes smaller(const DoubleLanes& a, const DoubleLanes& b)
{
    return a < b ? a : b;
}

FPPG_LANES bool is_any_set(const DoubleMask& mask)
{
    return (mask[0] | mask[1] | mask[2] | mask[3]) != 0;
}

FPPG_LANES Lanes square_root(const Lanes& squared)
{
#if defined(__SSE2__)
    const __m128 low = _mm_sqrt_ps(__builtin_shufflevector(squared, squared, 0, 1, 2, 3));
    const __m128 high = _mm_sqrt_ps(__builtin_shufflevector(squared, squared, 4, 5, 6, 7));
    return __builtin_shufflevector(low, high, 0, 1, 2, 3, 4, 5, 6, 7);
#else
    Lanes root;
    for (std::size_t l = 0; l < lane_count; ++l) root[l] = std::sqrt(squared[l]);
    return root;
#endif
}

FPPG_LANES HalfLanes low_half(const Lanes& v)
{
    return __builtin_shufflevector(v, v, 0, 1, 2, 3);
}

FPPG_LANES HalfLanes high_half(const Lanes& v)
{
    return __builtin_shufflevector(v, v, 4, 5, 6, 7);
}

FPPG_LANES float sum_of(const Lanes& v)
{
    const HalfLanes four = low_half(v) + high_half(v);
    const HalfLanes two = four + __builtin_shufflevector(four, four, 2, 3, 2, 3);
    return two[0] + two[1];
}

FPPG_LANES float smallest_of(const Lanes& v)
{
    const HalfLanes low = low_half(v);
    const HalfLanes high = high_half(v);
    const HalfLanes four = high < low ? high : low;
    const HalfLanes turned = __builtin_shufflevector(four, four, 2, 3, 2, 3);
    const HalfLanes two = turned < four ? turned : four;
    return two[1] < two[0] ? two[1] : two[0];
}

/// values[indices[0..7]].
FPPG_LANES Lanes gathered(const float* values, const std::uint32_t* indices)
{
    return Lanes{values[indices[0]], values[indices[1]], values[indices[2]], values[indices[3]],
                 values[indices[4]], values[indices[5]], values[indices[6]], values[indices[7]]};
}

/// For every set of eight lanes their numbers, a byte each, for taking just these out of a
/// register.
struct LaneOrders
{
    std::array<std::uint64_t, 256> of{};

    constexpr LaneOrders()
    {
        for (std::size_t set = 0; set < of.size(); ++set)
            for (unsigned lane = 0, count = 0; lane < lane_count; ++lane)
                if ((set >> lane & 1) != 0) of[set] |= std::uint64_t{lane} << (8 * count++);
    }
};
inline constexpr LaneOrders lane_orders;

struct LanePoints
{
    Lanes x, y, z;
    Lanes fourth{}; ///< of packed points
};

/// From a point's neighbours to it.
struct LaneOffsets
{
    Lanes x, y, z, squared;
    Lanes fourth; ///< that of packed neighbours
};

/// Points by index, out of one array an axis.
struct AxesGather
{
    const float* x;
    const float* y;
    const float* z;

    FPPG_LANES LanePoints one(std::uint32_t i) const
    {
        return {lanes_of(x[i]), lanes_of(y[i]), lanes_of(z[i])};
    }
    FPPG_LANES LanePoints eight(const std::uint32_t* i) const
    {
        return {gathered(x, i), gathered(y, i), gathered(z, i)};
    }
};

/// Points by index, out of one array of points: a third of the loads.
struct PackedGather
{
    const HalfLanes* points;

    FPPG_LANES LanePoints one(std::uint32_t i) const
    {
        return {lanes_of(points[i][0]), lanes_of(points[i][1]), lanes_of(points[i][2])};
    }
    FPPG_LANES LanePoints eight(const std::uint32_t* i) const
    {
        const Lanes a = pair(points[i[0]], points[i[4]]);
        const Lanes b = pair(points[i[1]], points[i[5]]);
        const Lanes c = pair(points[i[2]], points[i[6]]);
        const Lanes d = pair(points[i[3]], points[i[7]]);
        const Lanes ab = __builtin_shufflevector(a, b, 0, 8, 1, 9, 4, 12, 5, 13);
        const Lanes cd = __builtin_shufflevector(c, d, 0, 8, 1, 9, 4, 12, 5, 13);
        const Lanes ab_z = __builtin_shufflevector(a, b, 2, 10, 3, 11, 6, 14, 7, 15);
        const Lanes cd_z = __builtin_shufflevector(c, d, 2, 10, 3, 11, 6, 14, 7, 15);
        return {__builtin_shufflevector(ab, cd, 0, 1, 8, 9, 4, 5, 12, 13),
                __builtin_shufflevector(ab, cd, 2, 3, 10, 11, 6, 7, 14, 15),
                __builtin_shufflevector(ab_z, cd_z, 0, 1, 8, 9, 4, 5, 12, 13),
                __builtin_shufflevector(ab_z, cd_z, 2, 3, 10, 11, 6, 7, 14, 15)};
    }

private:
    FPPG_LANES static Lanes pair(const HalfLanes& low, const HalfLanes& high)
    {
        return __builtin_shufflevector(low, high, 0, 1, 2, 3, 4, 5, 6, 7);
    }
};

/// Neighbours of one point by eights. The last eight are filled up with what comes after them in
/// the list, whose distances are replaced by a large one.
///
/// Gather  AxesGather or PackedGather
template <typename Gather>
class NeighbourLanes
{
public:
    FPPG_LANES NeighbourLanes(const Gather& gather, std::uint32_t point)
        : gather_(gather), at_(gather.one(point))
    {
    }

    /// Calls visit(offsets) for each eight; offsets lead from the neighbour to the point.
    ///
    /// indices  n of them, and behind them 7 more that are some points' (NeighbourList's are)
    template <typename Visit>
    FPPG_LANES void for_each(const std::uint32_t* indices, std::size_t n, const Visit& visit) const
    {
        std::size_t k = 0;
        for (; k + lane_count <= n; k += lane_count) visit(offsets(indices + k));
        if (k == n) return;
        const auto left = static_cast<std::int32_t>(n - k);
        LaneOffsets o = offsets(indices + k);
        o.squared = LaneMask{0, 1, 2, 3, 4, 5, 6, 7} < left ? o.squared : lanes_of(far_away);
        visit(o);
    }

private:
    static constexpr float far_away = 1e30f;

    FPPG_LANES LaneOffsets offsets(const std::uint32_t* indices) const
    {
        const LanePoints p = gather_.eight(indices);
        LaneOffsets o{at_.x - p.x, at_.y - p.y, at_.z - p.z, Lanes{}, p.fourth};
        o.squared = o.x * o.x + o.y * o.y + o.z * o.z;
        return o;
    }

    Gather gather_;
    LanePoints at_;
};

} // namespace fppg
