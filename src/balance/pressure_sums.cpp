#include "balance/pressure_sums.h"

#include "core/lanes.h"

namespace fppg
{
namespace
{

/// The shapes are those of FluidAtRest::slope().
struct WendlandSlope
{
    FPPG_LANES Lanes operator()(const Lanes& q) const
    {
        const Lanes s = larger(Lanes{}, 1 - 0.5f * q);
        return -5 * s * s * s;
    }
};

struct CubicSlope
{
    FPPG_LANES Lanes operator()(const Lanes& q) const
    {
        const Lanes s = larger(Lanes{}, 2 - q);
        return q > 1.0f ? -0.75f * s * s / q : 2.25f * q - 3;
    }
};

template <typename Slope>
FPPG_LANES PressureSums sum_up(const PressureField& field, std::uint32_t i,
                               std::span<const std::uint32_t> near, float h_dp, const Slope& slope)
{
    Lanes x{}, y{}, z{};
    const Lanes per_h = lanes_of(1 / h_dp);
    const Lanes own = lanes_of(field.pressures[i]);
    const std::uint32_t* at = near.data();
    NeighbourLanes(PackedGather{field.packed.data()}, i)
        .for_each(near.data(), near.size(),
                  [&](const LaneOffsets& o)
                  {
                      const Lanes f = slope(square_root(o.squared) * per_h) * o.fourth *
                                      (own + gathered(field.pressures.data(), at));
                      at += lane_count;
                      x += f * o.x;
                      y += f * o.y;
                      z += f * o.z;
                  });
    return {sum_of(x), sum_of(y), sum_of(z)};
}

FPPG_LANES PressureSums sum_either(const PressureField& field, std::uint32_t i,
                                   std::span<const std::uint32_t> near, float h_dp, bool is_cubic)
{
    return is_cubic ? sum_up(field, i, near, h_dp, CubicSlope{})
                    : sum_up(field, i, near, h_dp, WendlandSlope{});
}

PressureSums sum_plain(const PressureField& field, std::uint32_t i,
                       std::span<const std::uint32_t> near, float h_dp, bool is_cubic)
{
    return sum_either(field, i, near, h_dp, is_cubic);
}

FPPG_AVX2 PressureSums sum_avx2(const PressureField& field, std::uint32_t i,
                                std::span<const std::uint32_t> near, float h_dp, bool is_cubic)
{
    return sum_either(field, i, near, h_dp, is_cubic);
}

} // namespace

PressureSums pressure_sums(const PressureField& field, std::uint32_t i,
                           std::span<const std::uint32_t> near, float h_dp, bool is_cubic)
{
    return is_avx2_there() ? sum_avx2(field, i, near, h_dp, is_cubic)
                           : sum_plain(field, i, near, h_dp, is_cubic);
}

} // namespace fppg
