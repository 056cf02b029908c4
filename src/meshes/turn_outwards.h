#pragma once

#include <cstddef>
#include <vector>

#include "fppg/surface_mesh.h"

namespace fppg
{

/// Turns outermost shells whose volume is negative, and what they hold.
///
/// count      number of shells, as orient_shells() numbers them
/// threads    number of threads; the result does not depend on it
/// is_turned  one entry per facet; changes for those that are turned
void turn_outwards(SurfaceMesh& mesh, std::size_t count, int threads, std::vector<char>& is_turned);

} // namespace fppg
