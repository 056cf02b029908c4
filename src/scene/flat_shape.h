#pragma once

#include "fppg/fitted_walls.h"
#include "fppg/lattice.h"

#include <vector>

namespace fppg
{

/// Gives shapes that lie in the plane of a 2D case, or beside it by less than dp/2, a section with
/// it, as the lattice gives them nodes: facets with an area become a solid that covers them,
/// facets without one a sheet along their longest side (the sides of a box without a width). Both
/// reach far beyond the plane on either side. All other shapes stay as they are.
///
/// shapes  sheets look away from the middle of their shape
void give_section(std::vector<ShapeMesh>& shapes, const LatticeGrid& grid);

} // namespace fppg
