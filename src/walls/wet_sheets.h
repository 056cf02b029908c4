#pragma once

#include "fppg/lattice.h"

#include <cstdint>
#include <set>

namespace fppg
{

/// Sheets whose layers stand in fluid: it is on both sides of them. Of sheets with
/// FittedBody::layered_step.
///
/// field  with walls and fluid as drawn
/// first  absolute mk of the first boundary
/// returns  their steps of the scene
std::set<std::uint32_t> wet_sheets(const RunField& field, std::uint16_t first, int threads);

} // namespace fppg
