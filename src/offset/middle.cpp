#include "offset/middle.h"

#include <algorithm>

namespace fppg
{
namespace
{

/// Sides whose normals turn by more than 120 degrees face away from each other.
constexpr double facing_away = -0.5;
/// Of the radius, and of the largest one, by which rounding is told from a step.
constexpr double rounding = 1e-7;
constexpr double least_height = 1e-9;

} // namespace

std::optional<InnerBall> touching_ball(const WallDepth& wall, const Vec3& foot, const Vec3& normal,
                                       double most)
{
    const Vec3 down = -wall.sign() * normal;
    InnerBall ball{foot + most * down, most};
    Vec3 other = foot;
    bool is_thin = false;
    for (int step = 0; step < 30; ++step)
    {
        const DepthPlace place = wall.at(ball.centre);
        const double distance = norm(place.nearest - ball.centre);
        if (!(distance < ball.radius * (1 - rounding))) break;
        const Vec3 way = place.nearest - foot;
        const double height = dot(way, down);
        if (!(height > least_height * most)) return std::nullopt;
        other = place.nearest;
        is_thin = true;
        ball.radius = std::min(ball.radius, dot(way, way) / (2 * height));
        ball.centre = foot + ball.radius * down;
    }
    if (!is_thin) return std::nullopt;
    const Vec3 up = ball.centre - other;
    const double size = norm(up);
    if (!(size > 0)) return std::nullopt;
    ball.is_across = dot(up, down) < facing_away * size;
    return ball;
}

std::optional<InnerBall> inner_ball(const WallDepth& wall, const Vec3& foot, const Vec3& normal,
                                    double most)
{
    const auto ball = touching_ball(wall, foot, normal, most);
    return ball && ball->is_across ? ball : std::nullopt;
}

std::optional<InnerBall> ball_through(const WallDepth& wall, const DepthPlace& place, const Vec3& p,
                                      double most)
{
    const Vec3 down = p - place.nearest;
    const bool has_line = place.depth > least_height * most && norm(down) > least_height * most;
    return touching_ball(
        wall, place.nearest,
        has_line ? (-wall.sign() / norm(down)) * down : wall.mesh().normals[place.facet], most);
}

Vec3 on_middle(const WallDepth& wall, const Vec3& p, double most)
{
    const auto ball = ball_through(wall, wall.at(p), p, most);
    return ball && ball->is_across && norm(ball->centre - p) < most ? ball->centre : p;
}

} // namespace fppg
