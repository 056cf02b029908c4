#pragma once

#include <optional>

namespace fppg
{

/// The kernel of a case.
struct LatticeKernel
{
    double h_dp = 0;       ///< smoothing length in dp
    bool is_cubic = false; ///< the cubic spline; else that of Wendland
    bool is_2d = false;
};

/// Layers of square nets, in 2D rows, every second one half a step on; a particle has dp^3 (dp^2).
/// A ratio of 1/2 is the body-centred cubic lattice (2D: a square one on its corner), the root of
/// 1/2 the face-centred cubic one; in 2D that of 3/4 is the hexagonal one.
struct LayeredLattice
{
    double ratio = 0; ///< of the distance between layers to the step in them
};

/// How stable a lattice is under pressure: the least eigenvalue of its dynamical matrix over the
/// wave vectors, each over that of springs of 1 between neighbours. Below 0 the waves of that
/// eigenvalue grow; above 0 a displaced particle swings about its place.
///
/// In the solver, particles at an even pressure P push one another with forces of 2 P V^2 grad W,
/// those of a pair potential 2 P V^2 W. What changes the density is held by the equation of state,
/// which is stiffer by far; what is left is shear, and this potential decides whether the lattice
/// resists it. In units of P dp^d: waves grow by exp(t sqrt(-x P / rho) / dp), x the eigenvalue.
///
/// lattice  nothing: the square or cubic one
/// source   dynamical matrix: Born and Huang, Dynamical Theory of Crystal Lattices. It agrees with
///          what the solver showed (tools/solver-trials, "What they showed of stable lattices"):
///          in 2D at h = 1.7 dp square lattices fall to pieces and hexagonal ones stay, at 2 dp
///          square ones stay and hexagonal ones do not
double lattice_stability(const LatticeKernel& kernel, const std::optional<LayeredLattice>& lattice);

/// The layered lattice that is the most stable, also where it is strained a little. Nothing where
/// the square or cubic lattice is more stable.
std::optional<LayeredLattice> most_stable_lattice(const LatticeKernel& kernel);

} // namespace fppg
