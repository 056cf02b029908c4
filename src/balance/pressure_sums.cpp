#include "balance/pressure_sums.h"

#include "core/lanes.h"

namespace fppg
{
namespace
{

/// The shapes are those of FluidAtRest::shape() and slope().
struct WendlandLanes
{
    FPPG_LANES Lanes shape(const Lanes& q) const
    {
        const Lanes s = larger(Lanes{}, 1 - 0.5f * q);
        return s * s * s * s * (2 * q + 1);
    }
    FPPG_LANES Lanes slope(const Lanes& q) const
    {
        const Lanes s = larger(Lanes{}, 1 - 0.5f * q);
        return -5 * s * s * s;
    }
};

struct CubicLanes
{
    FPPG_LANES Lanes shape(const Lanes& q) const
    {
        const Lanes s = larger(Lanes{}, 2 - q);
        return q > 1.0f ? 0.25f * s * s * s : 1 - 1.5f * q * q + 0.75f * q * q * q;
    }
    FPPG_LANES Lanes slope(const Lanes& q) const
    {
        const Lanes s = larger(Lanes{}, 2 - q);
        return q > 1.0f ? -0.75f * s * s / q : 2.25f * q - 3;
    }
};

template <typename Kernel>
FPPG_LANES PressureSums sum_up(const PressureField& field, std::uint32_t i,
                               std::span<const std::uint32_t> near, float h_dp,
                               const Kernel& kernel)
{
    Lanes x{}, y{}, z{};
    const Lanes per_h = lanes_of(1 / h_dp);
    const Lanes own = lanes_of(field.pressures[i]);
    const std::uint32_t* at = near.data();
    NeighbourLanes(PackedGather{field.packed.data()}, i)
        .for_each(near.data(), near.size(),
                  [&](const LaneOffsets& o)
                  {
                      const Lanes f = kernel.slope(square_root(o.squared) * per_h) * o.fourth *
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
    return is_cubic ? sum_up(field, i, near, h_dp, CubicLanes{})
                    : sum_up(field, i, near, h_dp, WendlandLanes{});
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

template <typename Kernel>
FPPG_LANES DensitySums sum_up_densities(const PressureField& field, std::uint32_t i,
                                        std::span<const std::uint32_t> near, float h_dp,
                                        const Kernel& kernel)
{
    Lanes w{}, w_e{};
    std::array<Lanes, 3> w_r{}, s_r{}, s_e_r{};
    std::array<Lanes, 6> s_r_r{};
    const Lanes per_h = lanes_of(1 / h_dp);
    const std::uint32_t* at = near.data();
    NeighbourLanes(PackedGather{field.packed.data()}, i)
        .for_each(near.data(), near.size(),
                  [&](const LaneOffsets& o)
                  {
                      const Lanes q = square_root(o.squared) * per_h;
                      const Lanes of_w = kernel.shape(q) * o.fourth;
                      const Lanes of_s = kernel.slope(q) * o.fourth;
                      const Lanes e = gathered(field.pressures.data(), at);
                      at += lane_count;
                      const std::array<Lanes, 3> r{o.x, o.y, o.z};
                      w += of_w;
                      w_e += of_w * e;
                      std::size_t pair = 0;
                      for (std::size_t a = 0; a < 3; ++a)
                      {
                          const Lanes along = of_s * r[a];
                          w_r[a] += of_w * r[a];
                          s_r[a] += along;
                          s_e_r[a] += along * e;
                          for (std::size_t b = a; b < 3; ++b) s_r_r[pair++] += along * r[b];
                      }
                  });
    DensitySums out{sum_of(w), sum_of(w_e), {}, {}, {}, {}};
    for (std::size_t a = 0; a < 3; ++a)
    {
        out.w_r[a] = sum_of(w_r[a]);
        out.s_r[a] = sum_of(s_r[a]);
        out.s_e_r[a] = sum_of(s_e_r[a]);
    }
    for (std::size_t k = 0; k < s_r_r.size(); ++k) out.s_r_r[k] = sum_of(s_r_r[k]);
    return out;
}

FPPG_LANES DensitySums densities_either(const PressureField& field, std::uint32_t i,
                                        std::span<const std::uint32_t> near, float h_dp,
                                        bool is_cubic)
{
    return is_cubic ? sum_up_densities(field, i, near, h_dp, CubicLanes{})
                    : sum_up_densities(field, i, near, h_dp, WendlandLanes{});
}

DensitySums densities_plain(const PressureField& field, std::uint32_t i,
                            std::span<const std::uint32_t> near, float h_dp, bool is_cubic)
{
    return densities_either(field, i, near, h_dp, is_cubic);
}

FPPG_AVX2 DensitySums densities_avx2(const PressureField& field, std::uint32_t i,
                                     std::span<const std::uint32_t> near, float h_dp, bool is_cubic)
{
    return densities_either(field, i, near, h_dp, is_cubic);
}

} // namespace

PressureSums pressure_sums(const PressureField& field, std::uint32_t i,
                           std::span<const std::uint32_t> near, float h_dp, bool is_cubic)
{
    return is_avx2_there() ? sum_avx2(field, i, near, h_dp, is_cubic)
                           : sum_plain(field, i, near, h_dp, is_cubic);
}

DensitySums density_sums(const PressureField& field, std::uint32_t i,
                         std::span<const std::uint32_t> near, float h_dp, bool is_cubic)
{
    return is_avx2_there() ? densities_avx2(field, i, near, h_dp, is_cubic)
                           : densities_plain(field, i, near, h_dp, is_cubic);
}

} // namespace fppg
