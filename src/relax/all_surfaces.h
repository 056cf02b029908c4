#pragma once

#include "fppg/relax_walls.h"

namespace fppg
{

/// The first part of relax_walls(): the particles on all surfaces, those of layers among them. All
/// bodies whose mks are relaxed alike are relaxed together.
void relax_all_surfaces(const CaseDef& def, RunField& field, int threads,
                        const RelaxObserver& observe, RelaxReport& report,
                        const RelaxSnapshot& snapshot);

} // namespace fppg
