#pragma once

#include "app/run_state.h"

#include <string>
#include <vector>

namespace fppg
{

/// Fluid beside fitted walls whose number of particles is more than 25 % off that on the lattice,
/// as GenCase draws the case: where radii are rounded, shells thicken a wall into its cavity, or a
/// hollow of the lattice is a solid. Not told: of `<inout>`, of zones of `<vres>`, beside
/// point files, and of what is drawn with walls that are body-fitted only.
///
/// returns  a sentence a mkfluid
std::vector<std::string> check_lattice_fluid(const CaseRunState& run, const MadeCase& made);

} // namespace fppg
