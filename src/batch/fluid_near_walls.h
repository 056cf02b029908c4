#pragma once

#include "fppg/case_def.h"
#include "fppg/lattice.h"
#include "fppg/mesh.h"

#include <cstdint>
#include <vector>

namespace fppg
{

/// Places of up to about 5,000 nodes of fluid, evenly through the lattice.
///
/// first_bound  mks below it are fluid
std::vector<Vec3> sample_fluid(const RunField& field, std::uint16_t first_bound);

/// The share of some places that are nearer to a surface than a distance, 0 to 1.
///
/// within  metres
double share_near(const std::vector<Vec3>& places, const TriangleSoup& surface, double within,
                  int threads);

/// What balancing fluid sums up (balance.h): particles times iterations times neighbours.
///
/// particles  that move
/// holds      whether walls hold it at rest; else that is found out, and it stays
double pairs_to_balance(const CaseDef& def, double particles, bool holds);

} // namespace fppg
