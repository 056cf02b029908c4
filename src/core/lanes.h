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
using LaneMask = std::int32_t __attribute__((vector_size(32)));

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
    return Lanes{} + value;
}

FPPG_LANES Lanes larger(const Lanes& a, const Lanes& b)
{
    return a > b ? a : b;
}

FPPG_LANES Lanes smaller(const Lanes& a, const Lanes& b)
{
    return a < b ? a : b;
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

FPPG_LANES float sum_of(const Lanes& v)
{
    return ((v[0] + v[4]) + (v[2] + v[6])) + ((v[1] + v[5]) + (v[3] + v[7]));
}

FPPG_LANES float smallest_of(const Lanes& v)
{
    float least = v[0];
    for (std::size_t l = 1; l < lane_count; ++l) least = v[l] < least ? v[l] : least;
    return least;
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

/// Neighbours of one point by eights. The last eight are filled up with what comes after them in
/// the list, whose distances are replaced by a large one.
class NeighbourLanes
{
public:
    struct Offsets
    {
        Lanes x, y, z, squared;
    };

    FPPG_LANES NeighbourLanes(const float* xs, const float* ys, const float* zs,
                              std::uint32_t point)
        : xs_(xs),
          ys_(ys),
          zs_(zs),
          x_(lanes_of(xs[point])),
          y_(lanes_of(ys[point])),
          z_(lanes_of(zs[point]))
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
        Offsets o = offsets(indices + k);
        o.squared = LaneMask{0, 1, 2, 3, 4, 5, 6, 7} < left ? o.squared : lanes_of(far_away);
        visit(o);
    }

private:
    static constexpr float far_away = 1e30f;

    FPPG_LANES Offsets offsets(const std::uint32_t* indices) const
    {
        Offsets o;
        o.x = x_ - gathered(xs_, indices);
        o.y = y_ - gathered(ys_, indices);
        o.z = z_ - gathered(zs_, indices);
        o.squared = o.x * o.x + o.y * o.y + o.z * o.z;
        return o;
    }

    const float* xs_;
    const float* ys_;
    const float* zs_;
    Lanes x_, y_, z_;
};

} // namespace fppg
