#pragma once

#include "fppg/vec.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace fppg
{

/// How much of a cube lies before a plane: where dot(normal, p - middle) <= distance.
///
/// normal    of unit length
/// distance  of the plane from the middle, in sides of the cube
/// is_2d     a square in x and z instead
/// returns   0 to 1
/// source    the volume cut off a corner is t^3 / (6 n1 n2 n3), t the distance from the corner;
///           inclusion and exclusion over the corners that the plane has passed
inline double share_of_cube_before(const Vec3& normal, double distance, bool is_2d)
{
    // So small a part along an axis changes the share by less than itself.
    constexpr double least = 1e-4;
    std::array<double, 3> n{};
    std::size_t count = 0;
    for (int axis = 0; axis < 3; ++axis)
        if (!is_2d || axis != 1) n[count++] = std::max(least, std::abs(normal[axis]));
    double reach = 0, product = 1;
    for (std::size_t k = 0; k < count; ++k)
    {
        reach += n[k];
        product *= n[k] * static_cast<double>(k + 1);
    }
    const double t = distance + reach / 2;
    double sum = 0;
    for (unsigned corners = 0; corners < 1U << count; ++corners)
    {
        double rest = t;
        double sign = 1;
        for (std::size_t k = 0; k < count; ++k)
            if ((corners >> k & 1U) != 0)
            {
                rest -= n[k];
                sign = -sign;
            }
        if (rest > 0) sum += sign * (count == 2 ? rest * rest : rest * rest * rest);
    }
    return std::clamp(sum / product, 0.0, 1.0);
}

} // namespace fppg
