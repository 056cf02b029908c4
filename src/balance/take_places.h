#pragma once

#include "fppg/case_def.h"
#include "fppg/particles.h"

#include "balance/fluid_at_rest.h"

namespace fppg
{

/// Gives the particles of a case the places and densities that balancing found. Fluid on nodes that
/// moves becomes particles off the lattice; ids stay.
void take_over(const CaseDef& def, const FluidAtRest& rest, int threads, CaseParticles& particles);

} // namespace fppg
