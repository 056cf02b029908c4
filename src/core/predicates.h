#pragma once

#include <cmath>

#include "fppg/vec.h"

namespace fppg
{

/// Exact signs of determinants of coordinates, whatever the rounding: two facets that share an edge
/// always agree on which side of it a point lies. Coordinates must be zero or between 1e-90 and
/// 1e90 in size, so that no product leaves the range of double.
/// Source: J. R. Shewchuk, Adaptive Precision Floating-Point Arithmetic and Fast Robust Geometric
/// Predicates, 1997 (error bounds of the first stage; expansions for the exact stage).

/// The exact stage of orient2d().
int orient2d_exact(double ax, double ay, double bx, double by, double px, double py);
/// The exact stage of orient3d().
int orient3d_exact(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d);

inline int sign_of(double value)
{
    return (value > 0) - (value < 0);
}

/// +1 if p lies to the left of the line from a to b, -1 to the right, 0 on it.
inline int orient2d(double ax, double ay, double bx, double by, double px, double py)
{
    constexpr double bound = 3.3306690738754716e-16; // (3 + 16 u) u, u = 2^-53
    const double left = (ax - px) * (by - py);
    const double right = (ay - py) * (bx - px);
    const double det = left - right;
    if (std::abs(det) > bound * (std::abs(left) + std::abs(right))) return sign_of(det);
    return orient2d_exact(ax, ay, bx, by, px, py);
}

/// The sign of (a - d) . ((b - d) x (c - d)): +1 if d lies on the side of the triangle from which
/// its corners run clockwise, -1 on the other side, 0 in its plane.
int orient3d(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d);

} // namespace fppg
