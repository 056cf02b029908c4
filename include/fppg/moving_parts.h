#pragma once

#include "fppg/element.h"

#include <set>

namespace fppg
{

/// mkbound of all objreal of a `<motion>` with a `<begin>` of their own or of an object around
/// them; others stay fixed.
std::set<int> moving_mkbound(const Element& motion);

} // namespace fppg
