#pragma once

#include "lattice/snap.h"

#include <array>
#include <cstddef>
#include <vector>

namespace fppg
{

/// Cuts a polygon into triangles as GenCase v5.4.354 does (432 random prisms, 500 concave stars,
/// ties included): among the ears, that is the corners where the polygon is convex and whose
/// triangle with their neighbours holds no other corner, the one with the least perimeter goes
/// first, the first of equal ones. What it does with five and more corners that are not in one
/// plane is known for most of them only: there the first corner of the list is never cut off.
///
/// polygon  indices into `nodes`, three or more
/// returns  triangles (before, corner, after); the last three corners in list order
std::vector<std::array<std::size_t, 3>> cut_polygon(const std::vector<Node>& nodes,
                                                    const std::vector<std::size_t>& polygon,
                                                    const LatticeGrid& grid);

/// Whether all corners lie in one plane, exactly.
bool is_flat(const std::vector<Node>& nodes, const std::vector<std::size_t>& polygon);

} // namespace fppg
