// The sums of half a space of fluid against those that numpy finds, with the matrix inverted there
// by numpy.linalg.inv.

#include "check/ghost_fit.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

namespace
{

using namespace fppg;

constexpr double dp = 0.05;

/// Fluid on nodes at multiples of dp, 10 of them to each side and above z = 0.
struct HalfSpace
{
    explicit HalfSpace(bool is_2d)
    {
        setup.is_2d = is_2d;
        setup.dp = dp;
        setup.h = std::sqrt(is_2d ? 2.0 : 3.0) * dp;
        setup.volume = is_2d ? dp * dp : dp * dp * dp;
        const int ny = is_2d ? 0 : 10;
        for (int i = -10; i <= 10; ++i)
            for (int j = -ny; j <= ny; ++j)
                for (int k = 1; k <= 10; ++k) places.push_back({i * dp, j * dp, k * dp});
    }

    GhostFit fit(const Vec3& ghost) const
    {
        std::vector<std::uint32_t> all(places.size());
        std::iota(all.begin(), all.end(), 0U);
        const ParticleColumns columns(places, all, dp, 1);
        const FillNodes none;
        Box3 box;
        for (const Vec3& p : places) box.add(p);
        return fit_at_ghost({columns, none, {{}}, box}, ghost, setup);
    }

    std::vector<Vec3> places;
    CheckSetup setup;
};

} // namespace

TEST(GhostFit, IsThatOfTheSolverIn3D)
{
    const HalfSpace fluid(false);
    GhostFit fit = fluid.fit({0.01, 0.02, 0.5 * dp});
    EXPECT_NEAR(fit.kernel_sum, 0.499660233732509, 1e-12);
    EXPECT_NEAR(fit.determinant, -0.01912576149049339, 1e-12);
    EXPECT_NEAR(fit.condition, 3.0340634700553704, 1e-9);
    fit = fluid.fit({0.01, 0.02, 0.01 * dp});
    EXPECT_NEAR(fit.kernel_sum, 0.28760436980343745, 1e-12);
    EXPECT_NEAR(fit.condition, 9.813125893920725, 1e-9);
    // The determinant is 3e-5, which the solver does not invert.
    fit = fluid.fit({0.01, 0.02, -0.5 * dp});
    EXPECT_NEAR(fit.kernel_sum, 0.12469660494976899, 1e-12);
    EXPECT_TRUE(std::isinf(fit.condition));
    EXPECT_EQ(fluid.fit({0.01, 0.02, -3 * dp}).kernel_sum, 0);
}

TEST(GhostFit, IsThatOfTheSolverIn2D)
{
    const HalfSpace fluid(true);
    const GhostFit fit = fluid.fit({0.01, 0, 0.5 * dp});
    EXPECT_NEAR(fit.kernel_sum, 0.4990687575952854, 1e-12);
    EXPECT_NEAR(fit.determinant, 0.031960495787055315, 1e-12);
    EXPECT_NEAR(fit.condition, 5.585497986075486, 1e-9);
}

TEST(GhostFit, SumsToOneInTheMiddle)
{
    for (const bool is_2d : {false, true})
        EXPECT_NEAR(HalfSpace(is_2d).fit({0.01, 0, 5.3 * dp}).kernel_sum, 1, 0.01);
}
