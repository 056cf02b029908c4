#pragma once

#include "fppg/lattice.h"
#include "fppg/mesh.h"

namespace fppg
{

/// Walls go on so far beyond both ends of a period until they are relaxed, dp.
inline constexpr double beyond_period_dp = 3;

/// Between the first and the last nodes of the lattice, with room for rounding, along a periodic
/// axis from half a step before the first to half a step behind the last; in 2D in the plane.
///
/// beyond_dp  along a periodic axis so much farther on both sides
inline bool is_in_domain(const Vec3& p, const LatticeGrid& grid, double beyond_dp = 0)
{
    constexpr double tolerance = 1e-4; // dp; coordinates of STL files are float
    constexpr double on_seam = 1e-6;
    for (int axis = 0; axis < 3; ++axis)
    {
        const auto a = static_cast<std::size_t>(axis);
        const double index = (p[axis] - grid.origin[axis]) / grid.step(axis);
        const double last = grid.n[a] - 1;
        // What is at the end of a period is at its begin too.
        const double low = grid.is_periodic[a] ? -0.5 - beyond_dp - on_seam : -tolerance;
        const double high =
            last + (grid.is_periodic[a] ? 0.5 + beyond_dp - 2 * on_seam : tolerance);
        if (!(index >= low && index <= high)) return false;
    }
    return true;
}

/// throws  GeometryError where a mesh reaches farther from the lattice than 2^31 dp, along y not in
/// 2D
void expect_near(const Box3& bounds, const LatticeGrid& grid);

} // namespace fppg
