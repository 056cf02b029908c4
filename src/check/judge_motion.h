#pragma once

#include "fppg/check.h"

#include "check/particle_columns.h"

#include <string>
#include <vector>

namespace fppg
{

/// What keeps a case with moving parts from being calm, a sentence each: a gap of less than 2 dp
/// between parts that move against each other, in which fluid cannot flow, or, with modified
/// boundaries, through which it goes though it is drawn as closed on the lattice (a gate 1 dp over
/// the floor, 0.3 m of water, solver v5.4: 2 % of the water in 0.24 s); parts faster than a
/// tenth of the speed of sound, beside which densities are off by more than 1 %; a least time step
/// (DtMin) that the solver's own step is below from the start.
///
/// walls  the boundary particles
std::vector<std::string> judge_motion(const CheckParticles& particles, const CheckSetup& setup,
                                      const ParticleColumns& walls);

} // namespace fppg
