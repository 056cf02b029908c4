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
    Lanes x{}, y{}, z{}, px{}, py{}, pz{};
    const Lanes per_h = lanes_of(1 / h_dp);
    const std::uint32_t* at = near.data();
    const PointArrays& p = field.points;
    NeighbourLanes(AxesGather{p.x.data(), p.y.data(), p.z.data()}, i)
        .for_each(near.data(), near.size(),
                  [&](const LaneOffsets& o)
                  {
                      const Lanes s = slope(square_root(o.squared) * per_h);
                      const Lanes of_volume = s * gathered(field.volumes.data(), at);
                      const Lanes of_pressure = s * gathered(field.pressures.data(), at);
                      at += lane_count;
                      x += of_volume * o.x;
                      y += of_volume * o.y;
                      z += of_volume * o.z;
                      px += of_pressure * o.x;
                      py += of_pressure * o.y;
                      pz += of_pressure * o.z;
                  });
    return {sum_of(x), sum_of(y), sum_of(z), sum_of(px), sum_of(py), sum_of(pz)};
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
