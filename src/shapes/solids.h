#pragma once

#include "shapes/plane_shapes.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <vector>

namespace fppg
{

/// The inside of a polyhedron, found by experiment with GenCase v5.4.354 (rules S1 to S4): nodes
/// strictly inside all planes of its parts, in double and without tolerance; none when it is wound
/// inwards.
/// - a prism of more than three corners is cut into prisms of three: from the bottom polygon the
///   corner whose triangle has the least perimeter is cut off again and again. A part is not
///   limited by its own corners but by the box of all. Each part draws the quads between it and its
///   neighbours too (rule P5), cut by a diagonal of its own, and keeps the nodes strictly between
///   its own bottom and top (140 level, tilted and concave prisms and 160 beaches of three to eight
///   corners, part by part by setmknextauto in GenCase v5.0, none different; v5.4 agrees on a
///   recorded case)
/// - a pyramid whose base is flat as drawn is one part between the plane through the first three
///   corners of its base and those of its sides, all snapped, inside the box of its corners (180
///   pyramids of three to five corners under random turns and scales, 9900 nodes of GenCase v5.0,
///   none different)
/// - a base that is not flat is cut by least perimeter, seen from outside, and the pyramid into
///   tetrahedra with the triangles between them (recorded cases pyramid_face, _full, _solid)
SlabRegion solid_region(const PolyhedronOp& polyhedron, const LatticeGrid& grid, double weight_dp,
                        double limits_dp);

/// The same inside, part by part in GenCase's order of drawing: a convex part, then the faces that
/// it turns to its neighbours, that at the last side of its triangle of the bottom first. Faces
/// between the parts of a pyramid go with the part behind them, those of the last one by
/// themselves.
std::vector<SlabRegion> solid_parts(const PolyhedronOp& polyhedron, const LatticeGrid& grid,
                                    double weight_dp, double limits_dp);

} // namespace fppg
