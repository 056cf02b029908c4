#include "meshes/wall_ball.h"

#include <cmath>

namespace fppg
{

WallBall largest_ball(const Vec3& foot, const Vec3& up, double most,
                      const ClosestWallPoint& closest)
{
    constexpr int most_steps = 10;
    constexpr double opposite = -0.5; ///< cosine between the directions to both walls
    WallBall ball{foot + most * up, most, false, {}};
    // The ball through `foot` and the point found inside the last one is the next; each is smaller.
    for (int step = 0; step < most_steps; ++step)
    {
        const Vec3 other = closest(ball.center, ball.radius);
        const double distance = norm(other - ball.center);
        if (!(distance < ball.radius * (1 - 1e-6))) break;
        const Vec3 way = other - foot;
        const double along = dot(way, up);
        if (!(along > 0)) break;
        ball.other = other;
        ball.radius = dot(way, way) / (2 * along);
        ball.center = foot + ball.radius * up;
        ball.is_opposite = -dot(up, other - ball.center) < opposite * norm(other - ball.center);
    }
    return ball;
}

} // namespace fppg
