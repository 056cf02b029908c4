#pragma once

#include "check/particle_columns.h"
#include "fppg/check.h"

#include <cstdint>
#include <vector>

namespace fppg
{

/// Judges places of particles whatever the boundary condition: fluid nearer than 0.5 dp to walls
/// and pairs nearer than 0.3 dp, over periodic limits too. Particles that lie in one place with
/// another count as well.
///
/// masks    a mask of faults per particle, to which what is found is added: FluidNearWall to the
///          fluid particle, ClosePair to both
/// returns  the number of close pairs
std::uint64_t judge_places(const CheckParticles& particles, const CheckSetup& setup,
                           const ParticleColumns& walls, const ParticleColumns& fluid,
                           std::vector<std::uint16_t>& masks, int threads);

} // namespace fppg
