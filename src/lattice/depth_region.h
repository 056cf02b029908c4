#pragma once

#include "fppg/case_def.h"
#include "fppg/mesh.h"

#include "lattice/spans.h"

namespace fppg
{

/// The nodes that `advanced="true"` takes of a mesh (rule X3, found with GenCase v5.4.354 on an L
/// with nodes on its faces: stl_lshape_adv equal; of the 796 nodes of stl_lshape_adv_rev all but
/// the 22 that lie in the plane of a face, at x = 1):
/// - corners are rounded to float after the transform
/// - the depth of a node is its distance to the nearest facet that it lies strictly behind
/// - along each row in x, from low to high, nodes count from where the row enters the mesh to
/// where it leaves it; with `reverse` they count from the start until it first leaves, and again
/// from the next entry on. A row through an edge or a corner of a facet crosses it
/// - rows run within the box of the mesh, grown by depth_max where that is given: from the node at
/// or below its lower corner to that at or below its upper one (38 draws of a ball, a torus, a cube
/// and an L, some with nodes on their faces, with and without `reverse`: all equal)
/// - nodes that count and whose depth is within [depth_min, depth_max] are taken; all that count
/// with autofill="true" where no depth is given. With a depth autofill changes nothing (the same
/// draws with and without; it is no flood here)
///
/// cost  O(nodes inside + facets * nodes within reach of a facet)
SlabRegion depth_region(const TriangleSoup& soup, const MeshFileOp& op, const LatticeGrid& grid,
                        int threads);

} // namespace fppg
