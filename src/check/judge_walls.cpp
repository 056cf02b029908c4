// How a boundary particle p with the normal n (to the surface s = p + n) and the ghost node
// g = p + 2n is judged; all lengths in dp, w are other boundary particles:
// - It counts where fluid can come within 2h of p, not counting what is beyond open sides.
// - In a wall, where |n| >= 0.25: no fluid can come within 0.99 of g, and it is behind the surface
// of
//   a w within 0.75; or it lies within 0.45 of a w that has no normal.
// - Through a wall: the segment from s + 0.5 n/|n| to g passes from one side of a w to the other
//   within 0.5 of it, or between two w within 0.71 of both (half the diagonal of their squares), or
//   within 0.45 of a w without normal.
// - Outside: no fluid can come within 2h of g, and it is outside the domain (over periodic limits
// it
//   is put back first).
// - Looks away: no fluid can come within 2h of g, in the domain; or the fluid within 2h of p is
// behind
//   it: the mean of the cosines between n and the ways to it is below -0.2 (before a flat wall 0.5,
//   before a sheet that is wet on both sides 0); or the nearest fluid is nearer by 1 than |n|.
//   Such a w counts as one without a normal in the rules above.
// - Weak kernel and ill-conditioned as in fit_at_ghost(), with the limits of the solver.
// - Both sides, where n leads to fluid: fluid can come to the back too, t behind p in a cylinder of
//   radius 0.75 around -n, and the wall is thinner (|n| + t - 0.5) than 2h - 0.5.

#include "check/judge_walls.h"

#include <algorithm>
#include <vector>

namespace fppg
{

namespace
{

constexpr double least_kernel_sum = 0.1;
constexpr double most_condition = 50;

/// A place put back over periodic limits.
Vec3 back_into_domain(const CheckSetup& setup, Vec3 p)
{
    for (int axis = 0; axis < 3; ++axis)
    {
        if (!setup.is_periodic[static_cast<std::size_t>(axis)]) continue;
        const Vec3& way = setup.periodic[static_cast<std::size_t>(axis)];
        if (p[axis] < setup.domain.min[axis]) p = p + way;
        if (p[axis] >= setup.domain.max[axis]) p = p - way;
    }
    return p;
}

bool is_outside(const CheckSetup& setup, const Vec3& p)
{
    for (int axis = 0; axis < 3; ++axis)
        if (!(setup.is_2d && axis == 1) &&
            !(p[axis] >= setup.domain.min[axis] && p[axis] < setup.domain.max[axis]))
            return true;
    return false;
}

/// Calls stop(normal of w, way from w to p) for boundary particles but `own` within `radius`.
template <typename Stop>
bool find_walls(const WallScene& scene, std::uint32_t own, const Vec3& p, double radius,
                const Stop& stop)
{
    for (const Vec3& way : scene.fluid.ways)
        if (scene.walls.find_near(p + way, radius,
                                  [&](std::uint32_t w, const Vec3& to, double)
                                  {
                                      const Vec3 n = scene.looks_away[w] != 0
                                                         ? Vec3{}
                                                         : normal_of(scene.particles, w);
                                      return w != own && stop(n, -to);
                                  }))
            return true;
    return false;
}

bool is_in_wall(const WallScene& scene, std::uint32_t i, const Vec3& ghost)
{
    const double dp = scene.setup.dp;
    const auto is_bare = [&](const Vec3& n, const Vec3& from)
    { return n == Vec3{} && dot(from, from) < 0.45 * 0.45 * dp * dp; };
    const auto is_behind = [&](const Vec3& n, const Vec3& from)
    { return n != Vec3{} && dot(from - n, n) < -0.05 * dp * norm(n); };
    if (find_walls(scene, i, ghost, 0.45 * dp, is_bare)) return true;
    return !scene.fluid.find_near(ghost, 0.99 * dp,
                                  [](const Vec3&, double, bool) { return true; }) &&
           find_walls(scene, i, ghost, 0.75 * dp, is_behind);
}

/// The squared distance from the origin to the segment from a to b.
double squared_distance_to(const Vec3& a, const Vec3& b)
{
    const Vec3 way = b - a;
    const double t = std::clamp(-dot(a, way) / dot(way, way), 0.0, 1.0);
    const Vec3 nearest = a + way * t;
    return dot(nearest, nearest);
}

bool passes_wall(const WallScene& scene, std::uint32_t i, const Vec3& p, const Vec3& n)
{
    const double dp = scene.setup.dp;
    const double length = norm(n);
    if (length <= 0.55 * dp) return false;
    const Vec3 begin = p + n * (1 + 0.5 * dp / length);
    const Vec3 way = p + n * 2 - begin;
    const Vec3 middle = begin + way * 0.5;
    std::vector<Vec3> beside;
    const auto is_passed = [&](const Vec3& normal, const Vec3& from)
    {
        const Vec3 a = from - way * 0.5;
        const Vec3 b = from + way * 0.5;
        if (normal == Vec3{}) return squared_distance_to(a, b) < 0.45 * 0.45 * dp * dp;
        const double before = dot(a, normal);
        const double after = dot(b, normal);
        if ((before < 0) == (after < 0)) return false;
        const Vec3 at = a + (b - a) * (before / (before - after));
        if (dot(at, at) > 0.71 * 0.71 * dp * dp) return false;
        // Along the side of an edge all w stand on one side of the way.
        const bool is_between = std::any_of(beside.begin(), beside.end(),
                                            [&](const Vec3& other) { return dot(at, other) < 0; });
        beside.push_back(at);
        return is_between || dot(at, at) <= 0.5 * 0.5 * dp * dp;
    };
    return find_walls(scene, i, middle, 0.5 * norm(way) + 0.71 * dp, is_passed);
}

/// The first of the faults of a normal that holds, as bits.
std::uint16_t judge_normal(const WallScene& scene, std::uint32_t i, const Vec3& p, const Vec3& n,
                           const FluidNearWall& around)
{
    const CheckSetup& setup = scene.setup;
    const bool is_short = norm(n) < 0.25 * setup.dp;
    const Vec3 ghost = back_into_domain(setup, p + n * 2);
    if (!is_short && is_in_wall(scene, i, ghost)) return bit_of(Fault::GhostInWall);
    if (passes_wall(scene, i, p, n)) return bit_of(Fault::ThroughWall);
    const GhostFit fit = fit_at_ghost(scene.fluid, ghost, setup);
    if (fit.kernel_sum <= 0)
        return bit_of(is_outside(setup, ghost) ? Fault::GhostOutside : Fault::LooksAway);
    if (around.looks_away || norm(n) > double{around.nearest} + setup.dp)
        return bit_of(Fault::LooksAway);
    if (fit.kernel_sum < least_kernel_sum) return bit_of(Fault::WeakKernel);
    if (!(fit.condition <= most_condition)) return bit_of(Fault::IllConditioned);
    return 0;
}

} // namespace

Vec3 normal_of(const CheckParticles& particles, std::size_t i)
{
    if (i >= particles.normals.size()) return {};
    const std::array<float, 3>& n = particles.normals[i];
    return {n[0], n[1], n[2]};
}

FluidNearWall look_around(const WallScene& scene, std::uint32_t i)
{
    const Vec3& p = scene.particles.positions[i];
    const Vec3 n = normal_of(scene.particles, i);
    const Vec3 direction = n == Vec3{} ? n : n / norm(n);
    const double across = 0.75 * scene.setup.dp;
    double nearest = std::numeric_limits<double>::infinity(), behind = nearest;
    std::uint64_t count = 0;
    double cosines = 0;
    scene.fluid.find_near(p, 2 * scene.setup.h,
                          [&](const Vec3& to, double squared, bool is_beyond)
                          {
                              ++count;
                              const double along = dot(to, direction);
                              if (squared > 0) cosines += along / std::sqrt(squared);
                              if (is_beyond) return false;
                              nearest = std::min(nearest, squared);
                              if (along < 0 && squared - along * along <= across * across)
                                  behind = std::min(behind, -along);
                              return false;
                          });
    return {static_cast<float>(std::sqrt(nearest)), static_cast<float>(behind),
            std::isfinite(nearest), cosines < -0.2 * static_cast<double>(count)};
}

WallJudgement judge_wall(const WallScene& scene, std::uint32_t i, const FluidNearWall& around)
{
    constexpr auto wrong_way =
        static_cast<std::uint16_t>(1U << static_cast<unsigned>(Fault::GhostOutside) |
                                   1U << static_cast<unsigned>(Fault::GhostInWall) |
                                   1U << static_cast<unsigned>(Fault::ThroughWall) |
                                   1U << static_cast<unsigned>(Fault::LooksAway));
    const CheckSetup& setup = scene.setup;
    const Vec3 n = normal_of(scene.particles, i);
    if (n == Vec3{}) return {bit_of(Fault::NoNormal), 0};
    WallJudgement out;
    out.faults = judge_normal(scene, i, scene.particles.positions[i], n, around);
    if ((out.faults & wrong_way) != 0) return out;
    const double thickness = norm(n) + double{around.behind} - 0.5 * setup.dp;
    if (thickness < 2 * setup.h - 0.501 * setup.dp)
    {
        out.faults |= bit_of(Fault::BothSides);
        out.thickness = static_cast<float>(std::max(thickness, 0.0));
    }
    return out;
}

bool stops_in_buffer(const CheckSetup& setup, const Vec3& position, const Vec3& normal)
{
    if (setup.boundary == 2 && normal != Vec3{}) return false;
    const auto is_in = [&](const Box3& box)
    {
        for (int axis = 0; axis < 3; ++axis)
            if (!(setup.is_2d && axis == 1) &&
                !(box.min[axis] <= position[axis] && position[axis] <= box.max[axis]))
                return false;
        return true;
    };
    for (const BufferZone& zone : setup.buffers)
        if (is_in(zone.outer) && !is_in(zone.inner)) return true;
    return false;
}

} // namespace fppg
