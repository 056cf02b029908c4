#pragma once

#include "fppg/case_def.h"

#include "nodes/spans.h"

namespace fppg
{

/// The nodes of a solitary wave: those of the snapped box, its limits included, that lie strictly
/// below the surface at their x, in every draw mode (rule R6, found by experiment with GenCase
/// v5.4.354). Crest and bed are moved, turned and scaled as points; depth and height stay. So is
/// the corner, but the far corner twice: its size counts from the corner's node, and the matrix
/// acts on that sum again, so that a move makes the box larger. A box with a negative size
/// afterwards has no nodes (60 boxes under one to three moves, turns and scales in v5.4.354 and 400
/// in v5.0; sizes of whole and a half dp: 40 in v5.0).
SlabRegion wave_region(const WaveOp& wave, const LatticeGrid& grid);

} // namespace fppg
