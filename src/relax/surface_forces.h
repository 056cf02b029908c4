#pragma once

#include "relax/neighbour_list.h"

namespace fppg
{

/// Pair forces with lengths in dp: the negative gradient of the sum of w(r / h), and a short push
/// 4 (1 - r / 0.8) below 0.8 dp, without which particles that come too near stay there: the
/// kernel's force vanishes at no distance.
class SurfaceForces
{
public:
    /// h  smoothing length, dp
    explicit SurfaceForces(float h);

    /// For the rows [begin, end) of a list: the force on their particles, and the squared distance
    /// to the nearest neighbour (large where there is none).
    void compute(const NeighbourList& list, std::size_t begin, std::size_t end,
                 const PointArrays& points, PointArrays& forces,
                 std::vector<float>& nearest_squared) const;

    float half_inverse_h() const { return half_inverse_h_; }
    /// Of the kernel's force.
    float factor() const { return factor_; }

private:
    float half_inverse_h_;
    float factor_;
};

/// The largest eigenvalue of the Hessian of the sum of w over a hexagonal layer with one particle a
/// dp^2: a step of force over it is stable.
///
/// h  smoothing length, dp
double stiffest_mode(double h);

} // namespace fppg
