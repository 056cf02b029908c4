#pragma once

#include "fppg/particles.h"

namespace fppg
{

/// Where the particle at place `k` of a run stands before `<initials>`.
inline Vec3 place_in_run(const CaseParticles& particles, const ParticleBlock& block,
                         const ParticleRun& run, std::uint32_t k)
{
    if (run.is_off_lattice) return particles.off_lattice.positions[run.off_lattice_begin() + k];
    const std::int64_t z = static_cast<std::int64_t>(run.z) +
                           (block.run_descending ? -1 : 1) * static_cast<std::int64_t>(k);
    return particles.grid.place(run.x, run.y, static_cast<double>(z));
}

/// The density of particle k of a run.
///
/// id  of the particle
/// rhop0  of particles that are no fluid, and of fluid without depths
inline float density_in_run(const CaseParticles& particles, const ParticleBlock& block,
                            const ParticleRun& run, std::uint32_t k, std::uint64_t id, float rhop0)
{
    if (run.is_off_lattice) return particles.off_lattice.rhop[run.off_lattice_begin() + k];
    if (block.type != ParticleType::Fluid) return rhop0;
    if (!particles.rhop.empty()) return particles.rhop[id - (particles.np - particles.n_fluid)];
    if (particles.rhop_of_depth.empty()) return rhop0;
    return particles.rhop_of_depth[run.depth + (block.run_descending ? k : run.count - 1 - k)];
}

} // namespace fppg
