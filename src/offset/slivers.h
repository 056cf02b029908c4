#pragma once

#include "fppg/surface_mesh.h"

#include <vector>

namespace fppg
{

/// Takes thin facets out of a mesh that was cut from a grid and whose vertices were then put onto
/// creases: vertices nearer than 0.2 cells become one, and where a facet is lower than 0.1 cells
/// its longest side is turned to the other diagonal. Features and charts would take folded slivers
/// for sheets of their own.
///
/// mesh        connected before and after, by connect_facets()
/// cell        metres
/// on_creases  per vertex: 1 where it is on a crease; these stay
void remove_slivers(SurfaceMesh& mesh, double cell, const std::vector<char>& on_creases,
                    int threads);

} // namespace fppg
