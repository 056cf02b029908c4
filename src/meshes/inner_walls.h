#pragma once

#include <cstddef>
#include <vector>

#include "fppg/surface_mesh.h"

namespace fppg
{

/// Drops from `is_twin`, the facets that stand for two with opposite faces, those that are no wall
/// between two bodies: a wall has two more facets at each edge of its rim, and each of its faces
/// goes on in the one that lies behind it.
///
/// is_twin  one entry per facet, 1 for those that stand for two
void keep_inner_walls(const SurfaceMesh& mesh, std::vector<char>& is_twin);

/// Drops walls of one facet that part the inside of a body in two, as left when two bodies share a
/// wall that a file has once: patches bounded by edges where an even number of other facets meet,
/// and that lie inside what these bound, by the vote of three axes. A cavity that touches the
/// surface along an edge stays, for it has two facets there itself. Keeps the edge map.
///
/// returns  the number of facets dropped
std::size_t drop_partitions(SurfaceMesh& mesh, int threads);

} // namespace fppg
