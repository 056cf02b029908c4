#include "fppg/relax_walls.h"

#include "helpers/dense_grid.h"
#include "helpers/drawing.h"
#include "shapes/polyhedra.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <stdexcept>
#include <string>
#include <vector>

namespace fppg
{
namespace
{

using test::Drawing;

constexpr double dp = Drawing::dp;
constexpr std::uint16_t fluid_mk = Drawing::fluid_mk;
constexpr std::uint16_t wall_mk = Drawing::wall_mk;
constexpr Vec3 center{0.03, -0.02, 0.01};

struct Relaxed
{
    explicit Relaxed(const Drawing& drawing, int threads = 1, const RelaxObserver& observe = {})
        : before(drawing.run()), after(before)
    {
        relax_walls(drawing.def, after, threads, observe, report);
    }

    const RelaxedPart& part(const std::string& what) const
    {
        const auto found = std::find_if(report.parts.begin(), report.parts.end(),
                                        [&](const RelaxedPart& p) { return p.what == what; });
        if (found == report.parts.end()) throw std::runtime_error("not relaxed: " + what);
        return *found;
    }

    RunField before;
    RunField after;
    RelaxReport report;
};

/// The mk of every node that has a run, with the bit of the zone.
std::map<std::array<std::uint32_t, 3>, std::uint16_t> nodes_of(const RunField& field)
{
    std::map<std::array<std::uint32_t, 3>, std::uint16_t> nodes;
    for (std::uint32_t x = 0; x < field.slabs.size(); ++x)
        for (const Run& r : field.slabs[x])
            for (std::uint32_t z = r.z_begin; z < r.z_end; ++z)
                nodes[{x, r.y, z}] = test::dense_mk(r);
    return nodes;
}

/// All particles of an mk but those of the walls.
std::vector<Vec3> volume_of(const RunField& field, std::uint16_t mk)
{
    std::vector<Vec3> out;
    for (const auto& [n, node_mk] : nodes_of(field))
        if (node_mk == mk)
            out.push_back(field.grid.origin + Vec3{1.0 * n[0], 1.0 * n[1], 1.0 * n[2]} * dp);
    const VolumeParticles& volume = field.walls.volume;
    for (std::size_t i = 0; i < volume.size(); ++i)
        if (volume.mk[i] == mk) out.push_back(volume.positions[i]);
    return out;
}

bool is_whole(const FittedWalls& walls)
{
    const WallParticles& p = walls.particles;
    const std::size_t n = p.size();
    return p.kinds.size() == n && p.bodies.size() == n && p.facets.size() == n &&
           p.mk.size() == n && p.held.size() == n &&
           walls.volume.mk.size() == walls.volume.size() &&
           walls.volume.distances.size() == walls.volume.size();
}

/// Nodes were covered only, one for each particle that left its node.
void expect_marked_nodes(const Relaxed& relaxed)
{
    const auto before = nodes_of(relaxed.before);
    const auto after = nodes_of(relaxed.after);
    ASSERT_EQ(before.size(), after.size());
    std::size_t marked = 0;
    for (const auto& [node, mk] : before)
    {
        if (after.at(node) == mk) continue;
        EXPECT_EQ(after.at(node), mk | test::covered);
        ++marked;
    }
    std::size_t moved = relaxed.after.walls.volume.size();
    for (const RelaxedPart& part : relaxed.report.parts)
        if (part.what != "surface") moved = moved + part.removed - part.inserted;
    EXPECT_EQ(marked, moved);
}

/// depth  distance of a point to the wall, negative on the wrong side
template <typename Depth>
void expect_relaxed_solid(const Relaxed& relaxed, const Depth& depth)
{
    EXPECT_TRUE(is_whole(relaxed.after.walls));
    const std::vector<Vec3> before = volume_of(relaxed.before, wall_mk);
    const std::vector<Vec3> after = volume_of(relaxed.after, wall_mk);
    EXPECT_GT(relaxed.after.walls.volume.size(), 100U);
    for (const Vec3& p : after) EXPECT_GE(depth(p), 0.39 * dp);
    const auto n = static_cast<double>(before.size());
    EXPECT_NEAR(static_cast<double>(after.size()), n, 0.015 * n);
    expect_marked_nodes(relaxed);
}

/// Standard deviation over mean of the Shepard sums at the particles of an mk less than 2.6 dp from
/// the wall and below a height.
template <typename Depth>
double shepard_spread(const RunField& field, std::uint16_t mk, const ClosestWallPoint& closest,
                      const Depth& depth, double highest = 1e9)
{
    const std::vector<Vec3> particles = volume_of(field, mk);
    ShepardOptions options;
    options.dp = dp;
    options.is_2d = field.grid.is_2d;
    const VolumeSurroundings around{{}, field.walls.particles.positions, closest};
    const std::vector<double> all = shepard_sums(particles, around, options, 1);
    double n = 0;
    double sum = 0;
    double squares = 0;
    for (std::size_t i = 0; i < all.size(); ++i)
    {
        if (depth(particles[i]) > 2.6 * dp || particles[i].z > highest) continue;
        ++n;
        sum += all[i];
        squares += all[i] * all[i];
    }
    const double mean = sum / n;
    return std::sqrt(squares / n - mean * mean) / mean;
}

Vec3 rotate(const Vec3& p, double angle)
{
    const Vec3 q{std::cos(angle) * p.x - std::sin(angle) * p.y,
                 std::sin(angle) * p.x + std::cos(angle) * p.y, p.z};
    return {q.x, std::cos(angle) * q.y - std::sin(angle) * q.z,
            std::sin(angle) * q.y + std::cos(angle) * q.z};
}

Vec3 rotate_back(const Vec3& p, double angle)
{
    const Vec3 q{p.x, std::cos(angle) * p.y + std::sin(angle) * p.z,
                 -std::sin(angle) * p.y + std::cos(angle) * p.z};
    return {std::cos(angle) * q.x + std::sin(angle) * q.y,
            -std::sin(angle) * q.x + std::cos(angle) * q.y, q.z};
}

TEST(RelaxWalls, KeepsASolidSphereWithinItsWall)
{
    Drawing drawing;
    drawing.draw(SphereOp{center, 1.1, {}});
    const Relaxed relaxed(drawing);
    const auto depth = [](const Vec3& p) { return 1.1 - norm(p - center); };
    expect_relaxed_solid(relaxed, depth);
    EXPECT_LT(relaxed.part("surface").variation, 0.7 * relaxed.part("surface").variation_before);
    for (const Vec3& p : relaxed.after.walls.particles.positions) EXPECT_NEAR(depth(p), 0, 1e-12);
    for (std::size_t i = 0; i < relaxed.after.walls.volume.size(); ++i)
        EXPECT_NEAR(relaxed.after.walls.volume.distances[i],
                    -depth(relaxed.after.walls.volume.positions[i]), 0.02 * dp);
}

/// How far a point of the box's surface is from all wall particles at most, dp.
double widest_gap(const RunField& field, const Vec3& half, double angle)
{
    double widest = 0;
    for (int axis = 0; axis < 3; ++axis)
        for (const double side : {-1.0, 1.0})
            for (int i = 0; i <= 60; ++i)
                for (int j = 0; j <= 60; ++j)
                {
                    Vec3 at;
                    at[axis] = side * half[axis];
                    at[(axis + 1) % 3] = (i / 30.0 - 1) * half[(axis + 1) % 3];
                    at[(axis + 2) % 3] = (j / 30.0 - 1) * half[(axis + 2) % 3];
                    at = rotate(at, angle);
                    double nearest = 1e9;
                    for (const Vec3& p : field.walls.particles.positions)
                        nearest = std::min(nearest, norm(p - at));
                    widest = std::max(widest, nearest / field.grid.dp);
                }
    return widest;
}

TEST(RelaxWalls, KeepsASlantedBoxWithinItsWall)
{
    Drawing drawing;
    const Vec3 half{0.91, 0.72, 0.63};
    PolyhedronOp box =
        make_box(-1 * half, 2 * half, {true, true, true, true, true, true}, true, {}, dp)[0];
    for (Vec3& v : box.vertices) v = rotate(v, 0.4);
    drawing.draw(box);
    const Relaxed relaxed(drawing);
    // Rows that fitting lays along the edges are as even as can be, but leave wider gaps where
    // those of two edges meet.
    EXPECT_LE(widest_gap(relaxed.after, half, 0.4), 0.75);
    expect_relaxed_solid(relaxed,
                         [&](const Vec3& p)
                         {
                             const Vec3 q = rotate_back(p, 0.4);
                             return std::min({half.x - std::abs(q.x), half.y - std::abs(q.y),
                                              half.z - std::abs(q.z)});
                         });
}

TEST(RelaxWalls, EvensTheInsideOfASolid)
{
    Drawing drawing;
    drawing.draw(SphereOp{center, 1.1, {}});
    const Relaxed relaxed(drawing);
    const auto depth = [](const Vec3& p) { return 1.1 - norm(p - center); };
    const auto closest = [](const Vec3& p)
    { return center + (p - center) * (1.1 / norm(p - center)); };
    const double before = shepard_spread(relaxed.before, wall_mk, closest, depth);
    EXPECT_LT(shepard_spread(relaxed.after, wall_mk, closest, depth), 0.5 * before);
}

/// Fluid in a spherical tank up to 0.35 above its middle.
Drawing round_tank()
{
    Drawing drawing;
    drawing.state.mode = DrawMode::Face;
    drawing.draw(SphereOp{center, 1.23, {}});
    drawing.fill(center, 0.36);
    drawing.fluid_band();
    return drawing;
}

TEST(RelaxWalls, EvensTheFluidInARoundTank)
{
    const Relaxed relaxed(round_tank());
    const auto depth = [](const Vec3& p) { return 1.23 - norm(p - center); };
    const auto closest = [](const Vec3& p)
    { return center + (p - center) * (1.23 / norm(p - center)); };
    const double before = shepard_spread(relaxed.before, fluid_mk, closest, depth, 0);
    EXPECT_LT(shepard_spread(relaxed.after, fluid_mk, closest, depth, 0), 0.5 * before);
    for (const Vec3& p : volume_of(relaxed.after, fluid_mk)) EXPECT_GE(depth(p), 0.39 * dp);
    expect_marked_nodes(relaxed);
    for (const std::uint16_t mk : relaxed.after.walls.volume.mk) EXPECT_EQ(mk, fluid_mk);
}

TEST(RelaxWalls, LeaveTheFreeSurfaceAtRest)
{
    const Relaxed relaxed(round_tank());
    const auto before = nodes_of(relaxed.before);
    const auto after = nodes_of(relaxed.after);
    std::uint32_t top = 0;
    for (const auto& [node, mk] : before)
        if (mk == fluid_mk) top = std::max(top, node[2]);
    std::size_t n = 0;
    for (const auto& [node, mk] : before)
    {
        if (mk != fluid_mk || node[2] != top) continue;
        ++n;
        EXPECT_EQ(after.at(node), fluid_mk);
    }
    EXPECT_GT(n, 300U);
}

TEST(RelaxWalls, PutNothingWhereABodyWasCutAway)
{
    const auto farthest = [](const std::vector<Vec3>& points)
    {
        double x = -2;
        for (const Vec3& p : points) x = std::max(x, p.x);
        return x;
    };
    for (const double band_dp : {3.0, std::numeric_limits<double>::infinity()})
    {
        Drawing drawing;
        drawing.def.fit.all->relax.band_dp = band_dp;
        drawing.draw(SphereOp{center, 1.1, {}});
        drawing.empty();
        drawing.state.clips = {{{5, 0, 0}, {1, 0, 0}}}; // so that it does not hollow the ball
        drawing.box({0, -2, -2}, {2, 4, 4});
        const Relaxed relaxed(drawing);
        const RunField& before = relaxed.before;
        const RunField& after = relaxed.after;
        EXPECT_LE(farthest(after.walls.particles.positions),
                  farthest(before.walls.particles.positions));
        EXPECT_LE(farthest(volume_of(after, wall_mk)), farthest(volume_of(before, wall_mk)));
        EXPECT_GT(after.walls.volume.size(), 100U);
        EXPECT_TRUE(is_whole(after.walls));
        for (const Vec3& p : volume_of(after, wall_mk))
            EXPECT_GE(1.1 - norm(p - center), 0.39 * dp);
    }
}

TEST(RelaxWalls, LeaveAnMkThatIsNotActiveAsItIs)
{
    Drawing drawing;
    FitSettings still;
    still.relax.is_active = false;
    drawing.def.fit.of_mk.insert_or_assign(wall_mk, still);
    drawing.draw(SphereOp{{-0.9, 0.02, 0.01}, 0.8, {}});
    drawing.bound(1);
    drawing.draw(SphereOp{{0.93, 0.02, 0.01}, 0.8, {}});
    const Relaxed relaxed(drawing);
    EXPECT_TRUE(is_whole(relaxed.after.walls));
    const auto of_mk = [](const RunField& field, std::uint16_t mk)
    {
        std::vector<Vec3> out;
        for (std::size_t i = 0; i < field.walls.particles.size(); ++i)
            if (field.walls.particles.mk[i] == mk)
                out.push_back(field.walls.particles.positions[i]);
        return out;
    };
    EXPECT_EQ(of_mk(relaxed.before, wall_mk), of_mk(relaxed.after, wall_mk));
    EXPECT_EQ(volume_of(relaxed.before, wall_mk), volume_of(relaxed.after, wall_mk));
    EXPECT_NE(of_mk(relaxed.before, wall_mk + 1), of_mk(relaxed.after, wall_mk + 1));
    for (const std::uint16_t mk : relaxed.after.walls.volume.mk) EXPECT_EQ(mk, wall_mk + 1);
    EXPECT_TRUE(std::is_sorted(relaxed.after.walls.particles.bodies.begin(),
                               relaxed.after.walls.particles.bodies.end()));
}

TEST(RelaxWalls, KeepAWholeStateWhenToldToStop)
{
    for (const char* where : {"surface", "volume mk 10"})
    {
        Drawing drawing;
        drawing.draw(SphereOp{center, 1.1, {}});
        const Relaxed relaxed(drawing, 1,
                              [&](const RelaxStep& step)
                              { return step.what != where || step.iteration < 3; });
        EXPECT_TRUE(relaxed.report.is_stopped);
        EXPECT_EQ(relaxed.report.parts.back().what, where);
        EXPECT_EQ(relaxed.report.parts.back().iterations, 3);
        EXPECT_TRUE(is_whole(relaxed.after.walls));
        expect_marked_nodes(relaxed);
        for (const Vec3& p : volume_of(relaxed.after, wall_mk))
            EXPECT_GE(1.1 - norm(p - center), 0.39 * dp);
    }
}

TEST(RelaxWalls, EndTheSurfaceByItsTolerance)
{
    Drawing drawing;
    drawing.draw(SphereOp{center, 1.1, {}});
    drawing.def.fit.all->relax.tolerance = 1; // no improvement is enough
    drawing.def.fit.all->relax.band_dp = 0;
    const int soon = Relaxed(drawing).part("surface").iterations;
    drawing.def.fit.all->relax.tolerance = 1e-9;
    EXPECT_LT(soon, Relaxed(drawing).part("surface").iterations);
}

TEST(RelaxWalls, ShowAllWallParticlesInTheirSnapshots)
{
    Drawing drawing;
    for (const std::uint16_t mkbound : {std::uint16_t{0}, std::uint16_t{1}})
    {
        FitSettings settings;
        settings.relax.band_dp = 0;
        settings.relax.iterations = mkbound == 0 ? 12 : 15;
        settings.relax.snapshots = 5;
        drawing.def.fit.of_mk.insert_or_assign(static_cast<std::uint16_t>(wall_mk + mkbound),
                                               settings);
        drawing.bound(mkbound);
        drawing.draw(SphereOp{{-0.9 + 1.83 * mkbound, 0.02, 0.01}, 0.8, {}});
    }
    RunField field = drawing.run();
    const auto n = static_cast<double>(field.walls.particles.size());
    std::vector<int> iterations;
    RelaxReport report;
    relax_walls(drawing.def, field, 1, {}, report,
                [&](int iteration, const WallParticles& now)
                {
                    iterations.push_back(iteration);
                    EXPECT_NEAR(static_cast<double>(now.size()), n, 0.05 * n);
                    EXPECT_EQ(now.mk.size(), now.size());
                    EXPECT_EQ(now.kinds.size(), now.size());
                    EXPECT_EQ(now.mk.front(), wall_mk);
                    EXPECT_EQ(now.mk.back(), wall_mk + 1);
                });
    EXPECT_EQ(iterations, (std::vector{5, 10, 17, 22, 27}));
}

TEST(RelaxWalls, AreTheSameForAnyNumberOfThreads)
{
    Drawing drawing = round_tank();
    drawing.state.mode = DrawMode::Solid;
    drawing.bound(1);
    drawing.draw(SphereOp{{0.1, 0.1, -0.1}, 0.6, {}});
    drawing.empty();
    drawing.box({0.3, -2, -2}, {2, 4, 4});
    const Relaxed one(drawing, 1);
    const Relaxed eight(drawing, 8);
    EXPECT_EQ(one.after.slabs, eight.after.slabs);
    EXPECT_EQ(one.after.walls.particles.positions, eight.after.walls.particles.positions);
    EXPECT_EQ(one.after.walls.particles.held, eight.after.walls.particles.held);
    EXPECT_EQ(one.after.walls.volume.positions, eight.after.walls.volume.positions);
    EXPECT_EQ(one.after.walls.volume.distances, eight.after.walls.volume.distances);
    EXPECT_EQ(one.after.walls.volume.mk, eight.after.walls.volume.mk);
}

TEST(RelaxWalls, MoveVolumesOfAPlaneCaseInTheirPlane)
{
    // The plane meets the sphere off its middle, so that the wall nearest in space is not that
    // nearest in the plane.
    for (const bool is_sphere : {true, false})
    {
        Drawing drawing(true);
        const double radius = is_sphere ? std::sqrt(1.2 * 1.2 - 0.6 * 0.6) : 1.04;
        if (is_sphere)
            drawing.draw(SphereOp{{0.03, 0.6, 0.01}, 1.2, {}});
        else
            drawing.draw(
                CylinderOp{{0.03, -0.5, 0.01}, {0.03, 0.5, 0.01}, radius, {true, true, true}, {}});
        const Relaxed relaxed(drawing);
        const auto depth = [&](const Vec3& p)
        { return radius - std::hypot(p.x - 0.03, p.z - 0.01); };
        const auto closest = [&](const Vec3& p)
        {
            const Vec3 from{p.x - 0.03, 0, p.z - 0.01};
            return Vec3{0.03, 0, 0.01} + from * (radius / norm(from));
        };
        EXPECT_EQ(relaxed.before.walls.particles.positions,
                  relaxed.after.walls.particles.positions);
        EXPECT_GT(relaxed.after.walls.volume.size(), 30U);
        for (const Vec3& p : relaxed.after.walls.volume.positions) EXPECT_EQ(p.y, 0);
        for (const Vec3& p : volume_of(relaxed.after, wall_mk)) EXPECT_GE(depth(p), 0.39 * dp);
        expect_marked_nodes(relaxed);
        const double before = shepard_spread(relaxed.before, wall_mk, closest, depth);
        EXPECT_LT(shepard_spread(relaxed.after, wall_mk, closest, depth), 0.5 * before);
    }
}

TEST(RelaxWalls, MoveTheFluidRoundABodyOfAPlaneCase)
{
    Drawing drawing(true);
    drawing.draw(SphereOp{{0.03, 0.3, 0.01}, 0.7, {}});
    drawing.fill({-1.5, 0, 0}, 1.5);
    drawing.fluid_band();
    drawing.def.fit.all->relax.is_active = false;
    const Relaxed relaxed(drawing);
    const double radius = std::sqrt(0.7 * 0.7 - 0.3 * 0.3);
    const auto depth = [&](const Vec3& p) { return std::hypot(p.x - 0.03, p.z - 0.01) - radius; };
    const auto closest = [&](const Vec3& p)
    {
        const Vec3 from{p.x - 0.03, 0, p.z - 0.01};
        return Vec3{0.03, 0, 0.01} + from * (radius / norm(from));
    };
    EXPECT_GT(relaxed.after.walls.volume.size(), 30U);
    for (const Vec3& p : relaxed.after.walls.volume.positions)
    {
        EXPECT_EQ(p.y, 0);
        EXPECT_LE(depth(p), 3.5 * dp);
    }
    for (const Vec3& p : volume_of(relaxed.after, fluid_mk)) EXPECT_GE(depth(p), 0.39 * dp);
    EXPECT_EQ(volume_of(relaxed.before, wall_mk), volume_of(relaxed.after, wall_mk));
    expect_marked_nodes(relaxed);
    const double before = shepard_spread(relaxed.before, fluid_mk, closest, depth);
    EXPECT_LT(shepard_spread(relaxed.after, fluid_mk, closest, depth), 0.5 * before);
}

} // namespace
} // namespace fppg
