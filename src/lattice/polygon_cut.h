#pragma once

#include "lattice/snap.h"

#include <array>
#include <cstddef>
#include <vector>

namespace fppg
{

/// Cuts a polygon into triangles as GenCase v5.4.354 does (432 random prisms, 500 concave stars,
/// ties included; 64 random pentagons off the lattice): among the ears, that is the corners where
/// the polygon is convex and whose triangle with their neighbours holds no other corner, the one
/// with the least perimeter goes first, the first of equal ones. The corners count as they are
/// drawn, not as they are snapped.
///
/// polygon  indices into `vertices`, three or more
/// returns  triangles (before, corner, after); the last three corners in list order
std::vector<std::array<std::size_t, 3>> cut_polygon(const std::vector<Vec3>& vertices,
                                                    const std::vector<std::size_t>& polygon);

/// Whether all snapped corners lie in one plane, exactly.
bool is_flat(const std::vector<Node>& nodes, const std::vector<std::size_t>& polygon);

} // namespace fppg
