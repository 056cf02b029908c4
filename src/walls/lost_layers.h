#pragma once

#include "fppg/lattice.h"

#include "lattice/fitted_draw.h"

#include <string>

namespace fppg
{

/// Warns of walls in the domain some of whose layers lie beyond it, where they have no particles:
/// fluid can get through what is left. Of sheets of dynamic boundaries, whose first row is in the
/// domain, where that is more than a fiftieth of their particles.
///
/// place  of the draw, for the message
void warn_of_lost_layers(const std::string& place, const LatticeGrid& grid, FittedStep& step);

} // namespace fppg
