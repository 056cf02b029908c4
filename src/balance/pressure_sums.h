#pragma once

#include "fppg/vec.h"

#include "core/raw_array.h"
#include "relax/group_list.h"

#include <array>
#include <cstdint>
#include <vector>

namespace fppg
{

/// Of the particles that are summed up, one entry each in all arrays.
struct PressureField
{
    PointArrays points;           ///< dp from some origin
    RawArray<PackedPoint> packed; ///< these, and mass over density, dp^3 (2D: dp^2)
    RawArray<float> pressures;    ///< Pa; for density_sums() the density over rhop0, kg/m^3

    /// New values of `packed` and `pressures` are not written.
    void resize(std::size_t n)
    {
        points.resize(n);
        packed.resize(n);
        pressures.resize(n);
    }
};

/// Of each point of a group: the sum of V_j (p_i + p_j) s r over its neighbours j, r its offset
/// from j in dp, s the shape (dW/dq) / q of the kernel at q = |r| / h; and the sum of its pushes.
struct PressureSums
{
    std::array<float, points_per_group> x{}, y{}, z{};
    std::array<float, points_per_group> push_x{}, push_y{}, push_z{};

    Vec3 of(std::size_t lane) const { return {x[lane], y[lane], z[lane]}; }
    Vec3 push_of(std::size_t lane) const { return {push_x[lane], push_y[lane], push_z[lane]}; }
};

/// How pairs are summed up.
struct PairShape
{
    float h_dp = 0; ///< smoothing length in dp
    bool is_cubic = false;
    /// Neighbours nearer than this, dp, push with what is missing; 0: none does.
    float least_pair = 0;
};

/// Sums over the list of a group, with AVX2 where it is there; the same sums in the same order
/// without. What is beyond 2h counts for nothing.
PressureSums pressure_sums(const PressureField& field, const PointGroup& group,
                           const PairShape& shape);

/// What mDBC sums up over the neighbours j of a point: V_j times the shape w of the kernel and the
/// shape s of its slope, with the offset r from j in dp and the density e of j over rhop0.
struct DensitySums
{
    float w = 0, w_e = 0;
    std::array<float, 3> w_r{}, s_r{}, s_e_r{};
    std::array<float, 6> s_r_r{}; ///< xx, xy, xz, yy, yz, zz
};

/// As pressure_sums(), of each point of a group.
std::array<DensitySums, points_per_group> density_sums(const PressureField& field,
                                                       const PointGroup& group,
                                                       const PairShape& shape);

} // namespace fppg
