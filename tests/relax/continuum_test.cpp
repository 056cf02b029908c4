#include "relax/continuum.h"

#include "relax/kernel.h"
#include "relax/wall_planes.h"

#include <gtest/gtest.h>

namespace fppg
{

namespace
{

/// The integral of W over the plane (the line in 2D) at a distance, by the rule of rectangles.
double plane_integral(double distance, double h, bool is_2d)
{
    const int steps = 20000;
    const double width = 2 * h / steps;
    double sum = 0;
    for (int n = 0; n < steps; ++n)
    {
        const double along = (n + 0.5) * width;
        const double w = wendland(std::hypot(along, distance) / h);
        sum += is_2d ? wendland_alpha_2d(h) * w * 2 * width
                     : wendland_alpha_3d(h) * w * 2 * std::numbers::pi * along * width;
    }
    return sum;
}

/// The two faces of a slot of width 1 around x = 0.
Vec3 closest_in_slot(const Vec3& p)
{
    return {p.x < 0 ? -0.5 : 0.5, p.y, p.z};
}

/// The three faces of the corner of a room at the origin.
Vec3 closest_in_corner(const Vec3& p)
{
    const int axis = p.x <= p.y && p.x <= p.z ? 0 : p.y <= p.z ? 1 : 2;
    Vec3 q = p;
    q[axis] = 0;
    return q;
}

} // namespace

TEST(HalfSpace, PushesWithTheIntegralOfTheKernelOverItsBorder)
{
    for (const bool is_2d : {false, true})
        for (const double h : {0.8, 1.0, 1.3})
        {
            const HalfSpace beyond(h, is_2d);
            for (const double distance : {0.1, 0.5, 0.9, 1.2, 1.55})
                EXPECT_NEAR(beyond.force(distance), plane_integral(distance, h, is_2d), 2e-5);
        }
}

TEST(HalfSpace, HoldsHalfTheKernelWhereItBeginsAtTheParticle)
{
    for (const bool is_2d : {false, true}) EXPECT_NEAR(HalfSpace(1.1, is_2d).share(0), 0.5, 1e-5);
}

TEST(HalfSpace, HasAShareWhoseSlopeIsTheForce)
{
    for (const bool is_2d : {false, true})
    {
        const HalfSpace beyond(1, is_2d);
        for (const double distance : {0.3, 0.8, 1.4, 1.9})
            EXPECT_NEAR((beyond.share(distance - 0.05) - beyond.share(distance + 0.05)) / 0.1,
                        beyond.force(distance), 3e-3);
    }
}

TEST(HalfSpace, EndsWithTheSupport)
{
    for (const bool is_2d : {false, true})
    {
        EXPECT_EQ(HalfSpace(1, is_2d).force(2), 0);
        EXPECT_EQ(HalfSpace(1, is_2d).share(2.5), 0);
        EXPECT_NEAR(HalfSpace(1, is_2d).force(1.9999), 0, 1e-6);
    }
}

TEST(FindWallPlanes, FindsAllThreeSidesOfACorner)
{
    const WallPlanes found = find_wall_planes({0.6, 0.9, 1.1}, 1.5, closest_in_corner);
    ASSERT_EQ(found.count, 3);
    EXPECT_DOUBLE_EQ(found.planes[0].distance, 0.6);
    EXPECT_DOUBLE_EQ(found.planes[1].distance, 0.9);
    EXPECT_DOUBLE_EQ(found.planes[2].distance, 1.1);
    EXPECT_EQ(found.planes[0].normal, (Vec3{-1, 0, 0}));
}

TEST(FindWallPlanes, FindsOneSideWhereOthersAreFar)
{
    EXPECT_EQ(find_wall_planes({0.6, 2, 3}, 1.5, closest_in_corner).count, 1);
    EXPECT_EQ(find_wall_planes({1.6, 2, 3}, 1.5, closest_in_corner).count, 0);
}

TEST(FindWallPlanes, FindsBothSidesOfASlot)
{
    const WallPlanes found = find_wall_planes({0.1, 0, 0}, 1.5, closest_in_slot);
    ASSERT_EQ(found.count, 2);
    EXPECT_NEAR(found.planes[0].distance, 0.4, 1e-12);
    EXPECT_NEAR(found.planes[1].distance, 0.6, 1e-12);
}

} // namespace fppg
