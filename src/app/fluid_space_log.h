#pragma once

#include "fppg/relax_walls.h"

#include "app/run_state.h"

namespace fppg
{

/// Says what volume walls keep from fluid, and which pockets are left empty.
void log_fluid_space(const RelaxReport& report, const MadeCase& made, CaseRunState& run);

/// Gives fluid particles the mass for which `<fluidband mass="exact">` asks: that of the litres of
/// fills, else of the space between walls. The solver v5.4 has one mass for all fluid particles.
///
/// throws  CaseError where the case has what cannot go with it
void settle_fluid_mass(const RelaxReport& report, MadeCase& made, RunLog& log);

} // namespace fppg
