#include "offset/wall_depth.h"
#include "walls/layered_drawing.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

namespace fppg
{
namespace
{

using test::Drawing;
using test::layered;
using test::normals_of;
using test::relaxed;

constexpr double dp = Drawing::dp;

/// Every particle of a layer is at its depth behind the exact surface, and within reach of fluid
/// every normal ends on that.
///
/// depth_of  metres behind the exact surface
template <typename DepthOf>
void expect_exact_layers(const Drawing& drawing, const DepthOf& depth_of, std::size_t layers)
{
    const RunField field = relaxed(drawing);
    std::map<int, int> count;
    for (const Vec3& p : field.walls.particles.positions)
    {
        const double layer = depth_of(p) / dp - 0.5;
        EXPECT_NEAR(layer, std::round(layer), 1e-6);
        ++count[static_cast<int>(std::lround(layer))];
    }
    EXPECT_EQ(count.size(), layers);
    const test::WallNormals all = normals_of(drawing, field);
    std::size_t near = 0;
    for (std::size_t i = 0; i < all.positions.size(); ++i)
    {
        const double depth = depth_of(all.positions[i]);
        if (depth > static_cast<double>(layers) * dp) continue;
        ++near;
        EXPECT_NEAR(norm(all.normals[i]), depth, 1e-6 * dp);
        EXPECT_NEAR(depth_of(all.positions[i] + all.normals[i]), 0, 1e-6 * dp);
    }
    EXPECT_GE(near, field.walls.particles.size());
}

TEST(RoundLayers, OfABallAreExactSpheres)
{
    Drawing drawing = layered();
    const Vec3 center{0.02, -0.03, 0.01};
    drawing.draw(SphereOp{center, 1.13, {}});
    expect_exact_layers(
        drawing, [&](const Vec3& p) { return 1.13 - norm(p - center); }, 3);
}

/// A ball has no edge, and its facets none that is more than rounding, wherever it is.
TEST(RoundLayers, OfASmallBallFarFromTheOriginHaveNoCorners)
{
    const Vec3 far{5e5 * dp, 4e6 * dp, 0};
    Drawing drawing = layered();
    drawing.def.fit.all->boundary = WallBoundary::Dbc;
    drawing.def.fit.all->depths_dp = {0, 1};
    drawing.def.grid.origin = drawing.def.grid.origin + far;
    drawing.draw(SphereOp{far + Vec3{0.02, -0.03, 0.01}, 0.316, {}});
    const WallParticles particles = drawing.run().walls.particles;
    const double of_surface = 4 * std::numbers::pi * 3.16 * 3.16;
    std::size_t on_surface = 0;
    for (std::size_t i = 0; i < particles.size(); ++i)
    {
        EXPECT_EQ(particles.kinds[i], FitKind::Surface);
        const double depth = 0.316 - norm(particles.positions[i] - far - Vec3{0.02, -0.03, 0.01});
        on_surface += depth < 0.5 * dp ? 1 : 0;
    }
    EXPECT_NEAR(static_cast<double>(on_surface), of_surface, 0.2 * of_surface);
}

/// An oblique rod with its covers: along the rims the layers have circles of particles.
TEST(RoundLayers, OfARodMeetUnderItsRims)
{
    Drawing drawing = layered();
    const Vec3 p0{-0.9, -0.4, -0.3};
    const Vec3 p1{0.8, 0.5, 0.6};
    const double radius = 0.83;
    drawing.draw(CylinderOp{p0, p1, radius, {true, true, true}, {}});
    const double length = norm(p1 - p0);
    const Vec3 axis = (p1 - p0) / length;
    const auto to_tube = [&](const Vec3& p)
    { return radius - norm(p - p0 - axis * dot(p - p0, axis)); };
    const auto to_cover = [&](const Vec3& p)
    { return std::min(dot(p - p0, axis), length - dot(p - p0, axis)); };
    expect_exact_layers(
        drawing, [&](const Vec3& p) { return std::min(to_tube(p), to_cover(p)); }, 3);
    const RunField field = relaxed(drawing);
    for (const int layer : {0, 1, 2})
    {
        const double depth = (layer + 0.5) * dp;
        int on_rims = 0;
        for (const Vec3& p : field.walls.particles.positions)
            on_rims += std::hypot(to_tube(p) - depth, to_cover(p) - depth) < 1e-4 * dp ? 1 : 0;
        EXPECT_NEAR(on_rims / (4 * std::numbers::pi * (radius - depth) / dp), 1, 0.08);
    }
}

TEST(RoundLayers, OfATubeStandOnTheSideAskedForToItsEnds)
{
    for (const LayerSide side : {LayerSide::Behind, LayerSide::Front})
    {
        Drawing drawing = layered();
        drawing.def.fit.all->side = side;
        const double radius = 0.93;
        drawing.draw(CylinderOp{{-1, 0, 0}, {1.02, 0, 0}, radius, {false, false, true}, {}, true});
        const double sense = side == LayerSide::Behind ? 1 : -1;
        expect_exact_layers(
            drawing, [&](const Vec3& p) { return sense * (radius - std::hypot(p.y, p.z)); }, 3);
        const RunField field = relaxed(drawing);
        // Half a step beyond the rims belongs to the particles on them.
        for (const FittedBody& body : field.walls.bodies)
            if (body.is_layer())
            {
                EXPECT_NEAR(body.measures.wall_particles * dp * dp / body.measures.area, 1, 0.04);
            }
        for (const Vec3& p : field.walls.particles.positions)
            EXPECT_TRUE(p.x > -1 - 0.01 * dp && p.x < 1.02 + 0.01 * dp);
    }
}

/// Depths are to the nearest place, which an ellipsoid has no formula for: each normal ends on the
/// surface and is perpendicular to it.
TEST(RoundLayers, OfAnEllipsoidAreAsDeepAsTheNearestPlace)
{
    for (const bool is_2d : {false, true})
    {
        Drawing drawing = layered(is_2d);
        const Vec3 focus0{-0.5, 0, -0.1};
        const Vec3 focus1{0.5, 0, 0.1};
        const double sum = 2.4;
        drawing.draw(EllipsoidOp{focus0, focus1, sum});
        const RunField field = relaxed(drawing);
        const test::WallNormals all = normals_of(drawing, field);
        std::size_t in_layers = 0;
        for (std::size_t i = 0; i < all.positions.size(); ++i)
        {
            const double layer = norm(all.normals[i]) / dp - 0.5;
            if (all.normals[i] == Vec3{} || std::fabs(layer - std::round(layer)) > 1e-5) continue;
            ++in_layers;
            const Vec3 foot = all.positions[i] + all.normals[i];
            EXPECT_NEAR(norm(foot - focus0) + norm(foot - focus1), sum, 1e-6 * dp);
            const Vec3 out =
                (foot - focus0) / norm(foot - focus0) + (foot - focus1) / norm(foot - focus1);
            EXPECT_LT(norm(cross(out / norm(out), all.normals[i])), 1e-5 * norm(all.normals[i]));
        }
        EXPECT_GE(in_layers, field.walls.particles.size());
        EXPECT_GT(in_layers, is_2d ? 100 : 3000);
    }
}

/// A sphere beside its middle is a smaller circle in the plane, a rod along it a rectangle.
TEST(RoundLayers, AreExactInThePlaneOf2DCases)
{
    Drawing ball = layered(true);
    ball.draw(SphereOp{{0.02, 0.4, 0.01}, 1.13, {}});
    const double radius = std::sqrt(1.13 * 1.13 - 0.4 * 0.4);
    expect_exact_layers(
        ball, [&](const Vec3& p) { return radius - std::hypot(p.x - 0.02, p.z - 0.01); }, 2);
    Drawing rod = layered(true);
    const Vec3 p0{-0.9, 0.2, -0.3};
    const Vec3 p1{0.8, 0.2, 0.6};
    rod.draw(CylinderOp{p0, p1, 0.83, {true, true, true}, {}});
    const double half = std::sqrt(0.83 * 0.83 - 0.2 * 0.2);
    const double length = norm(p1 - p0);
    const Vec3 axis = (p1 - p0) / length;
    expect_exact_layers(
        rod,
        [&](const Vec3& p)
        {
            const double at = dot(p - p0, axis);
            const Vec3 flat{p.x - p0.x - axis.x * at, 0, p.z - p0.z - axis.z * at};
            return std::min({half - norm(flat), at, length - at});
        },
        2);
}

} // namespace
} // namespace fppg
