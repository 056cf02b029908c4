#pragma once

#include "fppg/vec.h"

#include <array>
#include <cmath>

namespace fppg
{

/// Place n of a sequence that fills the unit square evenly, however many of it are taken: the
/// additive sequence of the plastic number, from `first` on both axes.
inline std::array<double, 2> even_in_square(double n, double first = 0)
{
    return {std::fmod(first + 0.7548776662466927 * n, 1.0),
            std::fmod(first + 0.5698402909980532 * n, 1.0)};
}

/// The same of a triangle.
inline Vec3 even_on_facet(const std::array<Vec3, 3>& corners, double n, double first = 0)
{
    auto [u, v] = even_in_square(n, first);
    if (u + v > 1)
    {
        u = 1 - u;
        v = 1 - v;
    }
    return corners[0] + u * (corners[1] - corners[0]) + v * (corners[2] - corners[0]);
}

} // namespace fppg
