#pragma once

#include "fppg/case_def.h"

#include "lattice/fitted_draw.h"

namespace fppg
{

/// Puts all particles of a closed solid inside it (Placement::Inside): layers from half a step
/// behind its surface on, and nodes in what is left, together as many as its volume is dp^3.
///
/// A body whose thickness is nearly the same everywhere (a plate, a shell) gets whole sheets: n of
/// them, each in the middle of its n-th part of the thickness. All others have one layer; where
/// they are too thin for one of each side, one on their middle serves both. The spacing in the
/// layers is dp, but for bodies without room for nodes, where it is what their number asks for.
///
/// out     its body is complete; zone and volume are those of the surface without particles on it
/// throws  GeometryError for a body that is not closed or not solid
void fill_inside(const FitSettings& settings, const LatticeGrid& grid, int threads,
                 FittedDraw& out);

} // namespace fppg
