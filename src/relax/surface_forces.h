#pragma once

#include "relax/neighbour_list.h"

namespace fppg
{

/// Pair forces with lengths in dp: the negative gradient of the sum of w(r / h), two
/// pushes. One of 0.85 (1 - r / 1.05) below 1.05 dp, just less than the spacing of a hexagonal
/// layer of one particle a dp^2, spreads the nearest neighbours evenly; one of 4 (1 - r / 0.8)
/// below 0.8 dp parts particles that come too near, as the kernel's force vanishes at no distance.
class SurfaceForces
{
public:
    /// h  smoothing length, dp
    explicit SurfaceForces(float h);

    /// The rows [begin, end) of a list.
    struct Rows
    {
        const NeighbourList& list;
        std::size_t begin;
        std::size_t end;
    };
    /// The forces on the particles of some rows, and the squared distances to their nearest
    /// neighbours. Both stay as they are where there is no neighbour.
    void compute(const Rows& rows, const PackedPoint* points, PointArrays& forces,
                 std::vector<float>& nearest_squared) const;

    float half_inverse_h() const { return half_inverse_h_; }
    /// What the push adds to stiffest_mode().
    static double stiffness_of_push();
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
