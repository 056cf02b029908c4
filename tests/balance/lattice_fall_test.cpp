// What is left of gravity in the midst of a lattice, beside what the theory of weakly compressible
// fluid says.

#include "balance/lattice_fall.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

namespace
{

using namespace fppg;

constexpr double dp = 0.01;

/// Water 20 times as stiff as 1 m of depth, h = 1.73 dp.
FluidAtRest water()
{
    FluidAtRest out;
    out.dp = dp;
    out.h = std::sqrt(3) * dp;
    out.rhop0 = 1000;
    out.gamma = 7;
    out.b = 400 * 9.81 * out.rhop0 / out.gamma;
    out.gravity = {0, 0, -9.81};
    return out;
}

/// Of a cubic lattice whose steps are `step`, from a node.
std::vector<Vec3> cubic_offsets(double step, double reach)
{
    std::vector<Vec3> out{{}};
    const int n = static_cast<int>(reach / step);
    for (int x = -n; x <= n; ++x)
        for (int y = -n; y <= n; ++y)
            for (int z = -n; z <= n; ++z)
            {
                const Vec3 r{x * step, y * step, z * step};
                if (norm(r) > 0 && norm(r) < reach) out.push_back(r);
            }
    return out;
}

/// Downwards, over gravity.
std::vector<double> falls_of(double step, const std::array<double, 2>& depths)
{
    const FluidAtRest rest = water();
    std::vector<double> out;
    for (const Vec3& a :
         lattice_falls(rest, cubic_offsets(step, 2 * rest.h), 1000 * dp * dp * dp, depths))
    {
        EXPECT_NEAR(a.x, 0, 1e-4);
        EXPECT_NEAR(a.y, 0, 1e-4);
        out.push_back(-a.z / 9.81);
    }
    return out;
}

} // namespace

// Volumes are less by p / (rho c^2), by which the sums of a pressure that rises with the depth
// lack three times as much, and the acceleration, over the density, a fourth time.
TEST(LatticeFalls, GrowWithTheDepthAsTheFluidIsCompressed)
{
    const std::vector<double> falls = falls_of(dp, {0.1, 0.6});
    EXPECT_NEAR(falls[1] - falls[0], 4 * 0.5 / 400, 0.0002);
}

TEST(LatticeFalls, FollowTheNumberOfParticles)
{
    const double even = falls_of(dp, {0.1, 0.2})[0];
    EXPECT_LT(std::abs(even), 0.01);
    const double denser = falls_of(0.99 * dp, {0.1, 0.2})[0];
    EXPECT_NEAR(even - denser, 0.03, 0.003); // 3 % more of them in a volume
}
