#pragma once

#include "fppg/vec.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

namespace fppg
{

/// A plane through three points, normal . x + offset, kept in the form in which it is evaluated, so
/// that ties fall as in GenCase.
struct Plane
{
    Vec3 normal;
    double offset = 0;

    double value(const Vec3& p) const { return dot(normal, p) + offset; }
};

inline Plane plane_through(const Vec3& a, const Vec3& b, const Vec3& c)
{
    Plane plane;
    plane.normal = cross(b - a, c - a);
    plane.offset = -dot(plane.normal, a);
    return plane;
}

/// What remains of [lo, hi] where a linear function of the index k, v0 + k * step, may be above
/// `limit`. `noise` is what v0 may be off by rounding: where the function hardly changes along the
/// column, nothing is cut off that the exact test might take.
inline void narrow(double& lo, double& hi, double v0, double step, double limit, double noise)
{
    const double gap = limit - v0 - noise;
    if (step > 0)
        lo = std::max(lo, gap / step);
    else if (step < 0)
        hi = std::min(hi, gap / step);
    else if (gap > 0)
        hi = -std::numeric_limits<double>::infinity();
}

/// Rounding of a plane's values near the lattice, with room to spare.
inline double noise_of(const Plane& plane, double dp)
{
    return 1e-7 * norm(plane.normal) * dp;
}

/// Turns estimated real limits of an index range into integers, safely for infinities.
inline bool to_index_range(double lo, double hi, std::int64_t min, std::int64_t max,
                           std::int64_t& first, std::int64_t& last)
{
    if (!(lo <= hi + 2)) return false;
    lo = std::clamp(lo, static_cast<double>(min) - 4, static_cast<double>(max) + 4);
    hi = std::clamp(hi, static_cast<double>(min) - 4, static_cast<double>(max) + 4);
    first = static_cast<std::int64_t>(std::floor(lo));
    last = static_cast<std::int64_t>(std::ceil(hi));
    return true;
}

} // namespace fppg
