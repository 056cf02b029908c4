#pragma once

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

} // namespace fppg
