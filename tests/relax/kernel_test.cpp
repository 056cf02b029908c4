#include "relax/kernel.h"

#include <gtest/gtest.h>

namespace fppg
{

TEST(WendlandKernel, IntegratesToOneInThePlaneAndInSpace)
{
    const double h = 0.7;
    double plane = 0;
    double space = 0;
    const int steps = 20000;
    for (int k = 0; k < steps; ++k)
    {
        const double r = 2 * h * (k + 0.5) / steps;
        const double w = wendland(r / h) * 2 * h / steps;
        plane += wendland_alpha_2d(h) * w * 2 * std::numbers::pi * r;
        space += wendland_alpha_3d(h) * w * 4 * std::numbers::pi * r * r;
    }
    EXPECT_NEAR(plane, 1, 1e-6);
    EXPECT_NEAR(space, 1, 1e-6);
}

TEST(WendlandKernel, SlopeIsTheDerivativeOverQ)
{
    for (const double q : {0.1, 0.5, 1.0, 1.5, 1.9})
    {
        const double derivative = (wendland(q + 1e-6) - wendland(q - 1e-6)) / 2e-6;
        EXPECT_NEAR(wendland_slope(q) * q, derivative, 1e-8);
    }
}

TEST(WendlandKernel, EndsAtTwiceTheSmoothingLength)
{
    EXPECT_GT(wendland(1.99), 0);
    EXPECT_EQ(wendland(2.0), 0);
    EXPECT_EQ(wendland(3.0), 0);
    EXPECT_EQ(wendland_slope(2.5), 0);
}

} // namespace fppg
