#pragma once

#include "fppg/case_def.h"

#include "lattice/spans.h"

namespace fppg
{

/// The nodes of a solitary wave: those of the snapped box, its limits included, that lie strictly
/// below the surface at their x, in every draw mode (rule R6, found by experiment with GenCase
/// v5.4.354).
SlabRegion wave_region(const WaveOp& wave, const LatticeGrid& grid);

} // namespace fppg
