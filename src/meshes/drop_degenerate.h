#pragma once

#include "fppg/surface_mesh.h"

namespace fppg
{

/// Drops facets with two equal corners or a height of rounding only, and counts them. The edge map
/// is to be built anew.
void drop_degenerate(SurfaceMesh& mesh, MeshReport& report);

/// Drops facets that are no higher than the rounding of their corners and have a side that is open
/// or belongs to more than two facets: slivers that stand on an edge. What they leave are
/// T-junctions. Slivers that fit between their neighbours stay. Counts them, and keeps
/// the edge map.
///
/// dp  metres; facets higher than 0.15 dp stay. 0: unknown
void drop_loose_slivers(double dp, SurfaceMesh& mesh, int threads, MeshReport& report);

} // namespace fppg
