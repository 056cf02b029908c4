#pragma once

#include <cstddef>
#include <vector>

#include "fppg/surface_mesh.h"

namespace fppg
{

/// Numbers the shells and turns facets to agree within each, the fewer to the more.
///
/// shells   gets the number of shells
/// returns  one entry per facet, 1 for those that were turned
std::vector<char> orient_shells(SurfaceMesh& mesh, std::size_t& shells);

} // namespace fppg
