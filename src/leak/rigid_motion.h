#pragma once

#include "fppg/vec.h"

#include <vector>

namespace fppg
{

/// A rotation, then a move.
struct RigidMotion
{
    Transform forward;   ///< from the case to the output
    Transform backward;  ///< its inverse
    double farthest = 0; ///< metres, of a point from where the motion takes it
};

/// The rotation and move that take `from` to `to` with the least sum of squared distances.
///
/// from, to  as many points in the same order; one point and points on a line are only known to be
///           moved, and about the line turned by any angle
/// source    Horn, Closed-form solution of absolute orientation using unit quaternions, 1987
RigidMotion fit_rigid_motion(const std::vector<Vec3>& from, const std::vector<Vec3>& to);

} // namespace fppg
