#pragma once

#include "fppg/case_def.h"

#include "lattice/fitted_draw.h"

#include <vector>

namespace fppg
{

/// Puts the layers of a wall behind its surface: adds their bodies and particles to a draw, and
/// takes the nodes between them out.
///
/// out  its body is complete, zone and volume are those of the surface without particles on it
void add_layers(const FitSettings& settings, const LatticeGrid& grid, int threads, FittedDraw& out);

/// Settles the measures of a draw by the particles in its layers.
void measure_layers(const LatticeGrid& grid, FittedDraw& out);

} // namespace fppg
