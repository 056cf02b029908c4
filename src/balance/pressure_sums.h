#pragma once

#include "relax/neighbour_list.h"

#include <cstdint>
#include <span>
#include <vector>

namespace fppg
{

/// Of the particles whose pressures push, one entry each in all arrays.
struct PressureField
{
    PointArrays points;           ///< dp from some origin
    std::vector<float> volumes;   ///< mass over density, dp^3 (2D: dp^2)
    std::vector<float> pressures; ///< times the volume, Pa dp^3
};

/// Sums over the neighbours j of particle i, r its offset from j in dp, s the shape (dW/dq) / q of
/// the kernel at q = |r| / h.
struct PressureSums
{
    float x = 0, y = 0, z = 0;    ///< of V_j s r
    float px = 0, py = 0, pz = 0; ///< of V_j p_j s r
};

/// Adds up pairs by eights, with AVX2 where it is there; the same sums in the same order without.
///
/// h_dp  smoothing length in dp
/// near  the neighbours of i, as NeighbourList gives them
PressureSums pressure_sums(const PressureField& field, std::uint32_t i,
                           std::span<const std::uint32_t> near, float h_dp, bool is_cubic);

} // namespace fppg
