#pragma once

#include "fppg/lattice.h"

namespace fppg
{

/// Between the first and the last nodes of the lattice, with room for rounding; in 2D in the plane.
inline bool is_in_domain(const Vec3& p, const LatticeGrid& grid)
{
    constexpr double tolerance = 1e-6; // dp
    for (int axis = 0; axis < 3; ++axis)
    {
        const double index = (p[axis] - grid.origin[axis]) / grid.dp;
        if (!(index >= -tolerance &&
              index <= grid.n[static_cast<std::size_t>(axis)] - 1 + tolerance))
            return false;
    }
    return true;
}

} // namespace fppg
