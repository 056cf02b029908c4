#include "core/predicates.h"

#include <gtest/gtest.h>

namespace fppg
{

TEST(Orient2d, TellsSidesThatRoundingHides)
{
    // The line y = x and points one unit in the last place off it.
    const double above = std::nextafter(0.5, 1.0);
    EXPECT_EQ(orient2d(12, 12, 24, 24, 0.5, above), 1);
    EXPECT_EQ(orient2d(12, 12, 24, 24, above, 0.5), -1);
    EXPECT_EQ(orient2d(12, 12, 24, 24, above, above), 0);
}

TEST(Orient2d, ChangesItsSignWithTheDirectionOfTheEdge)
{
    const double third = 1.0 / 3;
    for (int i = -50; i <= 50; ++i)
    {
        const double x = 0.1 * i;
        const double y = x * third + i * 1e-17;
        EXPECT_EQ(orient2d(-0.3, -0.1, 0.9, 0.3, x, y), -orient2d(0.9, 0.3, -0.3, -0.1, x, y));
        EXPECT_EQ(orient2d(-0.3, -0.1, 0.9, 0.3, x, y), orient2d(0.9, 0.3, x, y, -0.3, -0.1));
    }
}

TEST(Orient2d, IsExactOverAWideRange)
{
    EXPECT_EQ(orient2d(0, 0, 1e30, 1e30, 1e-30, 1e-30), 0);
    EXPECT_EQ(orient2d(0, 0, 1e30, 1e30, 1e-30, 1.1e-30), 1);
}

TEST(Orient3d, IsPositiveWhereTheCornersRunClockwise)
{
    const Vec3 a{0, 0, 0}, b{1, 0, 0}, c{0, 1, 0};
    EXPECT_EQ(orient3d(a, b, c, {0.2, 0.2, -1}), 1);
    EXPECT_EQ(orient3d(a, b, c, {0.2, 0.2, 1}), -1);
    EXPECT_EQ(orient3d(a, b, c, {5, 7, 0}), 0);
}

TEST(Orient3d, TellsSidesThatRoundingHides)
{
    const Vec3 a{12, 12, 12}, b{24, 24, 24}, c{3, 7, 3};
    const double off = std::nextafter(0.5, 1.0);
    // The plane holds all points with x = z.
    EXPECT_EQ(orient3d(a, b, c, {0.5, 0.3, 0.5}), 0);
    const int side = orient3d(a, b, c, {0.5, 0.3, 1});
    EXPECT_NE(side, 0);
    EXPECT_EQ(orient3d(a, b, c, {0.5, 0.3, off}), side);
    EXPECT_EQ(orient3d(a, b, c, {off, 0.3, 0.5}), -side);
}

} // namespace fppg
