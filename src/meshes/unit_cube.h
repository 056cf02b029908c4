#pragma once

#include "fppg/vec.h"

#include <algorithm>

namespace fppg
{

/// Moves and scales a mesh into [-1, 1], where float is finest: (p - centre) / scale.
struct UnitCube
{
    Vec3 centre;
    double scale = 1; ///< half the largest extent; 1 for a mesh that is a point
};

/// box  of the mesh, not empty
inline UnitCube unit_cube_of(const Box3& box)
{
    const Vec3 half = 0.5 * (box.max - box.min);
    const double scale = std::max({half.x, half.y, half.z});
    return {box.min + half, scale > 0 ? scale : 1};
}

} // namespace fppg
