#pragma once

#include "fppg/particles.h"

namespace fppg
{

/// Where the particle at place `k` of a run stands before `<initials>`.
inline Vec3 place_in_run(const CaseParticles& particles, const ParticleBlock& block,
                         const ParticleRun& run, std::uint32_t k)
{
    if (run.is_off_lattice) return particles.off_lattice.positions[run.off_lattice_begin() + k];
    const LatticeGrid& grid = particles.grid;
    const std::int64_t z = static_cast<std::int64_t>(run.z) +
                           (block.run_descending ? -1 : 1) * static_cast<std::int64_t>(k);
    return {grid.origin.x + run.x * grid.dp, grid.origin.y + run.y * grid.dp,
            grid.origin.z + static_cast<double>(z) * grid.dp};
}

} // namespace fppg
