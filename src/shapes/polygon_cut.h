#pragma once

#include "fppg/vec.h"

#include <array>
#include <cstddef>
#include <vector>

namespace fppg
{

/// Cuts a polygon into triangles as GenCase v5.4.354 does (432 random prisms, 500 concave stars,
/// ties included; 64 random pentagons off the lattice): among the ears, that is the corners where
/// the polygon is convex and whose triangle with their neighbours holds no other corner, the one
/// with the least perimeter goes first, the first of equal ones. The corners count as they
/// stand in the case, neither moved by a matrix nor snapped (120 prisms, 60 polygons and 30 beaches
/// under scales that also mirror: 36900 nodes of GenCase v5.0, none different; v5.4 agrees on
/// a recorded case).
///
/// polygon  indices into `vertices`, three or more
/// returns  triangles (before, corner, after); the last three corners in list order
std::vector<std::array<std::size_t, 3>> cut_polygon(const std::vector<Vec3>& vertices,
                                                    const std::vector<std::size_t>& polygon);

} // namespace fppg
