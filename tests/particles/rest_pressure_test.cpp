#include "particles/rest_pressure.h"

#include "relax/kernel.h"

#include <gtest/gtest.h>

#include <cmath>
#include <tuple>

namespace fppg
{
namespace
{

constexpr double dp = 0.02;
constexpr double g = 9.81;
constexpr double deep = 20 * dp; ///< the water
constexpr double rhop0 = 1000;

CaseDef water(double coef_h, bool is_2d)
{
    CaseDef def;
    def.grid.dp = dp;
    def.grid.is_2d = is_2d;
    def.h = coef_h * std::sqrt(is_2d ? 2.0 : 3.0) * dp;
    def.constants.rhop0 = rhop0;
    def.constants.gamma = 7;
    def.constants.gravity = {0, 0, -g};
    return def;
}

/// Of a speed of sound of 20 sqrt(g H).
const double b = 400 * g * deep * rhop0 / 7;

/// The solver's acceleration of a particle of the lattice at a depth, upwards over g; the water
/// goes on to all sides.
template <typename Pressure>
double residual(const CaseDef& def, double depth, const Pressure& pressure)
{
    const bool is_2d = def.grid.is_2d;
    const double h = def.h;
    const int reach = static_cast<int>(2 * h / dp);
    const double mass = rhop0 * std::pow(dp, is_2d ? 2 : 3);
    const auto density = [](double p) { return rhop0 * std::pow(1 + p / b, 1.0 / 7); };
    const double alpha = is_2d ? wendland_alpha_2d(h) : wendland_alpha_3d(h);
    const double own = pressure(depth);
    double up = 0;
    for (int x = -reach; x <= reach; ++x)
        for (int y = is_2d ? 0 : -reach; y <= (is_2d ? 0 : reach); ++y)
            for (int z = -reach; z <= reach; ++z)
            {
                const double q = std::sqrt(x * x + y * y + z * z) * dp / h;
                if (q == 0) continue;
                const double other = pressure(depth - z * dp);
                const double slope = alpha * wendland_slope(q) / (h * h) * (-z * dp);
                up -= mass * (own + other) / (density(own) * density(other)) * slope;
            }
    return up / g - 1;
}

class AtRest : public testing::TestWithParam<std::tuple<double, bool>>
{
};

TEST_P(AtRest, ALatticeStaysWhereHydrostaticPressureLetsItFall)
{
    const auto [coef_h, is_2d] = GetParam();
    const CaseDef def = water(coef_h, is_2d);
    const RestPressure rest(def, b);
    for (const double depth : {6.5 * dp, 10.5 * dp, 14.5 * dp})
    {
        const double at_rest = residual(def, depth, [&](double d) { return rest.at(d); });
        const double hydrostatic = residual(def, depth, [](double d) { return rhop0 * g * d; });
        EXPECT_LT(std::abs(at_rest), 2e-4) << depth;
        EXPECT_GT(std::abs(hydrostatic), 10 * std::abs(at_rest)) << depth;
    }
}

INSTANTIATE_TEST_SUITE_P(Kernels, AtRest,
                         testing::Combine(testing::Values(1.0, 1.2), testing::Bool()));

TEST(RestPressure, IsHydrostaticNearTheLevelAndZeroAboveIt)
{
    const CaseDef def = water(1.2, false);
    const RestPressure rest(def, b);
    EXPECT_EQ(rest.at(-dp), 0);
    EXPECT_NEAR(rest.at(0.01 * dp) / (rhop0 * g * 0.01 * dp), 1, 0.001);
    for (const double depth : {0.1 * dp, dp, deep})
        EXPECT_NEAR(rest.depth_of(rest.at(depth)), depth, 1e-9);
}

/// The first sum is written out; in the limit of a large h it is 1.
TEST(LatticeSlopeSum, IsThatOfTheKernel)
{
    EXPECT_NEAR(lattice_slope_sum(false, std::sqrt(3.0), false), 0.997457, 1e-6);
    EXPECT_NEAR(lattice_slope_sum(true, std::sqrt(2.0), true), 1.016122, 1e-6);
    for (const bool is_cubic : {false, true})
        for (const bool is_2d : {false, true})
            EXPECT_NEAR(lattice_slope_sum(is_cubic, 6, is_2d), 1, 2e-4);
}

} // namespace
} // namespace fppg
