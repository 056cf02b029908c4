#pragma once

#include "fppg/surface_mesh.h"

#include <cstddef>
#include <vector>

namespace fppg
{

/// Marks the facets of closed shells that face outwards and lie inside other closed shells, so that
/// both of their sides are inside: as when a part stands in another one, or a file has an inner
/// surface with the sense of the outer one. Every vertex of such a shell is inside the others.
///
/// mesh      facets turned outwards, shells numbered
/// shells    their number
/// is_inner  receives one entry per facet, 1 for those marked
/// returns   how many are
std::size_t find_inner_shells(const SurfaceMesh& mesh, std::size_t shells, int threads,
                              std::vector<char>& is_inner);

} // namespace fppg
