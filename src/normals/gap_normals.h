#pragma once

#include "fppg/lattice.h"
#include "fppg/particles.h"

#include <array>
#include <vector>

namespace fppg
{

/// Particles at the mouth of a closed gap, and those of the first layer beside them, look out of it
/// where the wall before which they stand is wet. Walls that move apart later are wet in the gap
/// too, and as near.
///
/// normals  of boundary particles, by id
void turn_to_mouths(const RunField& field, const CaseParticles& particles,
                    std::vector<std::array<float, 3>>& normals);

} // namespace fppg
