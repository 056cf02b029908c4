#pragma once

#include "fppg/lattice.h"

#include <cstdint>
#include <set>

namespace fppg
{

/// Sheets whose layers stand in fluid, as it is on both sides of them, and thickened shells that
/// have it on both sides; with FittedBody::layered_step.
///
/// Solver v5.4, mDBC: the shell of a car, dry inside, is at 0.0027 m/s after 0.09 s when it is
/// thickened, at 0.041 with one layer; a tyre that water fills at 0.0043 and 0.0005.
///
/// field  with walls and fluid as drawn
/// first  absolute mk of the first boundary
/// returns  their steps of the scene
std::set<std::uint32_t> wet_sheets(const RunField& field, std::uint16_t first, int threads);

} // namespace fppg
