#pragma once

#include "fppg/closest_wall_point.h"
#include "fppg/vec.h"

namespace fppg
{

/// A ball that touches a wall at one place and nothing nearer.
struct WallBall
{
    Vec3 center;
    double radius = 0;
    bool is_opposite = false; ///< it touches a second wall, on the side opposite to the first
    Vec3 other;               ///< where it touches that wall
};

/// The largest ball that touches walls at `foot` and lies on the side of `up`.
///
/// up    of unit length, away from the wall
/// most  metres; the ball is no larger
WallBall largest_ball(const Vec3& foot, const Vec3& up, double most,
                      const ClosestWallPoint& closest);

} // namespace fppg
