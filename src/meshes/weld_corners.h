#pragma once

#include "fppg/mesh.h"
#include "fppg/surface_mesh.h"

namespace fppg
{

/// Gives corners with equal coordinates one index, in the order of the file. Zero and minus zero
/// are equal.
///
/// mesh  empty; gets its vertices and facets
void weld_equal(const TriangleSoup& soup, SurfaceMesh& mesh);

/// Moves every vertex onto the nearest earlier one that stands for a place within the distance.
/// Places do not grow from neighbour to neighbour, so a fine mesh cannot run together. The edge map
/// is to be built anew.
///
/// distance  metres, above 0
/// may_move  empty: every vertex; else one entry per vertex: those with 0 stay, and nothing joins
///           them
void weld_near(double distance, const std::vector<char>& may_move, SurfaceMesh& mesh);

} // namespace fppg
