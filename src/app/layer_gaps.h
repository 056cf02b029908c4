#pragma once

#include "fppg/case_def.h"
#include "fppg/fitted_walls.h"
#include "fppg/particles.h"

#include <string>
#include <vector>

namespace fppg
{

/// Gaps of 0.1 to 1.8 dp at the start between moving walls and fixed ones that stand in layers for
/// modified boundaries, beside fluid: fluid goes through them in the solver, as the layers are a dp
/// farther apart than the surfaces (v5.4, a gate 1 dp over the floor before water 30 dp deep: 2 %
/// of it in 0.24 s; 0.7 dp: 1.2 %). On the lattice such walls have no node between them.
///
/// closed   gaps that a row of particles closes (relax/gap_rows.h)
/// returns  a sentence a pair of mks, with the place where they are nearest
std::vector<std::string> check_layer_gaps(const CaseDef& def, const CaseParticles& particles,
                                          const std::vector<GapParticle>& closed);

} // namespace fppg
