#pragma once

#include "fppg/case_def.h"
#include "fppg/particles.h"

namespace fppg
{

/// `<lattice bound="2" fluid="2">`: every particle of that type becomes two, at its place - dp/4
/// and
/// + dp/4 along each axis (in 2D along x and z), one after the other in the ids, both with its
/// density. Every value but 1 does so (found by experiment with GenCase v5.4.354). Their masses are
/// the caller's.
///
/// particles  with densities, before `<initials>`; blocks, ids, counts, particles off the lattice
///            and densities are those of the pairs afterwards, limits are left to the caller
/// returns    whether anything was doubled
/// throws     CaseError when there are more particles than ids
bool double_particles(const CaseDef& def, CaseParticles& particles);

} // namespace fppg
