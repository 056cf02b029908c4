// Which lattices are stable under pressure, beside sums of the same theory made by numpy and what
// the solver showed.

#include "balance/lattice_stability.h"

#include <gtest/gtest.h>

#include <cmath>

namespace
{

using namespace fppg;

constexpr LayeredLattice hexagonal{0.8660254037844386};
constexpr LayeredLattice face_centred{0.7071067811865476};

LatticeKernel wendland_in_2d(double h_dp)
{
    return {h_dp, false, true};
}

LatticeKernel wendland_in_3d(double h_dp)
{
    return {h_dp, false, false};
}

} // namespace

TEST(LatticeStability, IsThatOfTheSumsOverTheLattice)
{
    EXPECT_NEAR(lattice_stability(wendland_in_2d(1.2 * std::sqrt(2)), {}), -0.0573, 1e-4);
    EXPECT_NEAR(lattice_stability(wendland_in_2d(1.2 * std::sqrt(2)), hexagonal), 0.0224, 1e-4);
    EXPECT_NEAR(lattice_stability(wendland_in_3d(std::sqrt(3)), {}), -0.0517, 1e-4);
    EXPECT_NEAR(lattice_stability(wendland_in_3d(std::sqrt(3)), face_centred), -0.1163, 1e-4);
    EXPECT_NEAR(lattice_stability({1.3 * std::sqrt(2), true, true}, {}), -0.1914, 1e-4);
    EXPECT_NEAR(lattice_stability({1.2 * std::sqrt(3), true, false}, face_centred), -0.1048, 1e-4);
}

// In the solver, a square lattice at h = 2 dp is as still after 2 s as at the start (StillWedge of
// the public mDBC examples), and a hexagonal one of the same case has lost its rows after 0.8 s; at
// h = 1.7 dp it is the other way round.
TEST(LatticeStability, ChoosesTheLatticeThatStaysInTheSolver)
{
    EXPECT_FALSE(most_stable_lattice(wendland_in_2d(2)));
    const auto in_2d = most_stable_lattice(wendland_in_2d(1.2 * std::sqrt(2)));
    ASSERT_TRUE(in_2d);
    EXPECT_NEAR(in_2d->ratio, hexagonal.ratio, 0.12);
    const auto in_3d = most_stable_lattice(wendland_in_3d(std::sqrt(3)));
    ASSERT_TRUE(in_3d);
    EXPECT_NEAR(in_3d->ratio, 0.56, 0.03);
    EXPECT_GT(lattice_stability(wendland_in_3d(std::sqrt(3)), in_3d), 0);
}

// A square lattice on its corner is the same lattice.
TEST(LatticeStability, DoesNotDependOnTheWayALatticeIsTurned)
{
    for (const double h_dp : {1.3, 1.7, 2.0, 2.4})
        EXPECT_NEAR(lattice_stability(wendland_in_2d(h_dp), LayeredLattice{0.5}) < 0,
                    lattice_stability(wendland_in_2d(h_dp), {}) < 0, 0)
            << h_dp;
}
