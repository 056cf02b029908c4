#pragma once

#include "check/fill_nodes.h"
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
    const FillNodes& fill;
    std::vector<Vec3> ways; ///< periodic_ways()
    Box3 box;               ///< of all boundary particles

    /// Calls stop(way from p, squared distance, is beyond an open side) for all fluid within
    /// `radius` until it returns true; fluid of the case is beyond none.
    template <typename Stop>
    bool find_near(const Vec3& p, double radius, const Stop& stop) const
    {
        for (const Vec3& way : ways)
        {
            const Vec3 q = p + way;
            if (is_far(q, radius)) continue;
            if (fluid.find_near(q, radius,
                                [&](std::uint32_t, const Vec3& to, double squared)
                                { return stop(to, squared, false); }) ||
                fill.find_near(q, radius,
                               [&](const Vec3& to, double squared)
                               { return stop(to, squared, !is_in_box(q + to)); }))
                return true;
        }
        return false;
    }

private:
    bool is_in_box(const Vec3& p) const
    {
        for (int axis = 0; axis < 3; ++axis)
            if (!is_open_ended(axis) && (p[axis] < box.min[axis] - 1e-6 * fill.dp ||
                                         p[axis] > box.max[axis] + 1e-6 * fill.dp))
                return false;
        return true;
    }
    bool is_far(const Vec3& q, double radius) const
    {
        for (int axis = 0; axis < 3; ++axis)
            if (q[axis] < box.min[axis] - beyond(axis) - radius ||
                q[axis] > box.max[axis] + beyond(axis) + radius)
                return true;
        return false;
    }
    /// How far the fill goes beyond open sides, metres.
    double beyond(int axis) const
    {
        return static_cast<double>(fill.beyond[static_cast<std::size_t>(axis)]) * fill.dp;
    }
    /// Over a periodic limit there is no outside.
    bool is_open_ended(int axis) const { return fill.beyond[static_cast<std::size_t>(axis)] == 0; }
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
