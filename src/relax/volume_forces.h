#pragma once

#include "relax/continuum.h"
#include "relax/volume_band.h"

#include <cstdint>
#include <span>

namespace fppg
{

/// The forces of equation 15 on volume particles and their Shepard sums: of other particles, held
/// ones and walls, and of the medium beyond the walls. With equal pressure and V = dp^3 the force
/// is minus the sum of the kernel's gradients. To it a push is added where pairs are nearer than
/// 0.8 dp, which the kernel's own force, weak at short distances, would let collapse. Lengths are
/// in dp.
class VolumeForces
{
public:
    struct Result
    {
        float x, y, z;
        double shepard;
    };

    /// behind_wall  dp, where the continuum begins
    VolumeForces(double h, double behind_wall, bool is_2d);

    /// The force on particle i and its Shepard sum; near: its neighbours.
    Result on(const Band& band, std::uint32_t i, std::span<const std::uint32_t> near) const;

    /// What other particles add.
    struct PairSums
    {
        float x, y, z, weight;
    };
    struct PairFactors
    {
        float half_inverse_h, slope, push;
    };

private:
    using SumPairs = PairSums (*)(const PointArrays&, std::uint32_t, std::span<const std::uint32_t>,
                                  const PairFactors&);

    HalfSpace beyond_;
    double alpha_;
    double behind_wall_;
    PairFactors factors_;
    SumPairs sum_pairs_;
};

} // namespace fppg
