#pragma once

#include "fppg/case_def.h"

#include <cstdint>
#include <set>

namespace fppg
{

/// mkbound of all objreal of a `<motion>` with a `<begin>` of their own or of an object around
/// them; others stay fixed.
std::set<int> moving_mkbound(const Element& motion);

/// Absolute mks of what floats.
std::set<std::uint16_t> floating_mks(const CaseDef& def);

/// Absolute mks of what moves or floats.
std::set<std::uint16_t> mks_that_move(const CaseDef& def);

/// Absolute mks of what moves by a `<motion>` that never turns it: gates, pistons. Not what
/// `<mvnull>` leaves to other parts of the definition.
std::set<std::uint16_t> mks_that_slide(const CaseDef& def);

/// Whether an absolute mk is one of floating_mks().
bool floats(const CaseDef& def, std::uint16_t mk);

} // namespace fppg
