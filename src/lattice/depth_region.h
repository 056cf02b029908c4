#pragma once

#include "fppg/case_def.h"
#include "fppg/mesh.h"

#include "nodes/spans.h"

namespace fppg
{

/// The nodes that `advanced="true"` takes of a mesh (rule X3, found with GenCase v5.4.354; the
/// goldens stl_lshape_adv and stl_lshape_adv_rev, an L with nodes on its faces, are equal):
/// - corners are rounded to float after the transform
/// - the depth of a node is its distance to the nearest facet that it lies behind, or in the plane
///   of
/// - along each row in x, from low to high, nodes count from where the row enters the mesh to where
///   it leaves it; they also count from the start where the row leaves the mesh first, and with
///   `reverse` always (rows of up to four faces in all orders, 36 draws). A place on a row is
///   rounded to float before it is compared with a node
/// - rows run within the box of the mesh, grown by depth_max where that is given: from the node at
///   or below its lower corner to that at or below its upper one (38 draws of a ball, a torus, a
///   cube and an L, some with nodes on their faces, with and without `reverse`: all equal)
/// - nodes that count and whose depth is within [depth_min, depth_max] are taken; all that count
///   with autofill="true" where no depth is given. With a depth autofill changes nothing (the same
///   draws with and without; it is no flood here)
///
/// A row through an edge of a facet meets it or not by rounding, in GenCase's order of operations
/// (7664 rows through edges of random facets, all equal; on further lattices 1.4 million nodes):
/// - the plane of a facet is its normal and its offset, each divided by the normal's length
/// - a row is the segment from half a dp before the node at or below the mesh's lowest x to half a
///   dp behind its highest; the place is the segment's start plus its length times a share
/// - it is on the facet where it is behind or in three planes, through each edge and its first
///   corner raised by the normal (the last edge: its second corner)
/// - y and z of a row count from the first node of the box, or from the one before the lattice
///
/// cost  O(nodes inside + facets * nodes within reach of a facet)
SlabRegion depth_region(const TriangleSoup& soup, const MeshFileOp& op, const LatticeGrid& grid,
                        int threads);

} // namespace fppg
