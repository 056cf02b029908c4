#pragma once

#include "check/cavity.h"
#include "check/particle_columns.h"
#include "fppg/check.h"

#include <vector>

namespace fppg
{

/// The ways from a place to all its periodic copies, itself first.
std::vector<Vec3> periodic_ways(const CheckSetup& setup);

/// Fluid of the case and where fluid can come, over periodic limits.
struct FluidAround
{
    const ParticleColumns& fluid;
    const Cavity& fill;
    std::vector<Vec3> ways; ///< periodic_ways()
    Box3 box;               ///< of all of it

    /// Calls stop(way from p, squared distance) for all fluid within `radius` until it returns true.
    template <typename Stop>
    bool find_near(const Vec3& p, double radius, const Stop& stop) const
    {
        for (const Vec3& way : ways)
        {
            const Vec3 q = p + way;
            if (is_far(q, radius)) continue;
            if (fluid.find_near(q, radius, [&](std::uint32_t, const Vec3& to, double squared)
                                { return stop(to, squared); }) ||
                fill.find_near(q, radius, stop))
                return true;
        }
        return false;
    }

private:
    bool is_far(const Vec3& q, double radius) const
    {
        for (int axis = 0; axis < 3; ++axis)
            if (q[axis] < box.min[axis] - radius || q[axis] > box.max[axis] + radius) return true;
        return false;
    }
};

/// What the solver sums up at a ghost node.
struct GhostFit
{
    double kernel_sum = 0;  ///< of kernel times volume
    double determinant = 0; ///< of the matrix
    double condition = 0;   ///< dp^2 times the infinity norms of matrix and inverse
};

/// Sums over fluid within 2h with the Wendland kernel, every particle of the volume setup.volume.
/// A determinant below 0.001 has no condition number: infinity.
///
/// source  DualSPHysics v5.4, JSphCpu_mdbc.cpp: matrix of 4 x 4 numbers (2D: 3 x 3)
GhostFit fit_at_ghost(const FluidAround& fluid, const Vec3& ghost, const CheckSetup& setup);

} // namespace fppg
