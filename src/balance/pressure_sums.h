#pragma once

#include "relax/neighbour_list.h"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace fppg
{

/// Of the particles that are summed up, one entry each in all arrays.
struct PressureField
{
    PointArrays points;              ///< dp from some origin
    std::vector<PackedPoint> packed; ///< these, and mass over density, dp^3 (2D: dp^2)
    std::vector<float> pressures;    ///< Pa; for density_sums() the density over rhop0, kg/m^3

    void resize(std::size_t n)
    {
        points.resize(n);
        packed.resize(n);
        pressures.resize(n);
    }
};

/// The sum of V_j (p_i + p_j) s r over the neighbours j of particle i, r its offset from j in dp, s
/// the shape (dW/dq) / q of the kernel at q = |r| / h.
struct PressureSums
{
    float x = 0, y = 0, z = 0;
};

/// Adds up pairs by eights, with AVX2 where it is there; the same sums in the same order without.
///
/// h_dp  smoothing length in dp
/// near  the neighbours of i, as NeighbourList gives them
PressureSums pressure_sums(const PressureField& field, std::uint32_t i,
                           std::span<const std::uint32_t> near, float h_dp, bool is_cubic);

/// What mDBC sums up over the neighbours j of a point: V_j times the shape w of the kernel and the
/// shape s of its slope, with the offset r from j in dp and the density e of j over rhop0.
struct DensitySums
{
    float w = 0, w_e = 0;
    std::array<float, 3> w_r{}, s_r{}, s_e_r{};
    std::array<float, 6> s_r_r{}; ///< xx, xy, xz, yy, yz, zz
};

/// As pressure_sums().
DensitySums density_sums(const PressureField& field, std::uint32_t i,
                         std::span<const std::uint32_t> near, float h_dp, bool is_cubic);

} // namespace fppg
