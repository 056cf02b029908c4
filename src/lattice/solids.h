#pragma once

#include "lattice/plane_shapes.h"

namespace fppg
{

/// The inside of a figure, found by experiment with GenCase v5.4.354 (rules S1 to S4): nodes
/// strictly inside all planes of its parts, in double and without tolerance; none when it is wound
/// inwards.
/// - a prism of more than three corners is cut into prisms of three: from the bottom polygon the
/// corner
///   whose triangle has the least perimeter is cut off again and again; the quads between the parts
///   are drawn too (rule P5), of which only nodes strictly between the bottom and the top of a part
///   next to them are kept
/// - a pyramid whose base is flat as drawn is one part between the plane through the first three
///   corners of its base and those of its sides, all snapped, inside the box of its corners (180
///   pyramids of three to five corners under random turns and scales, 9900 nodes of GenCase v5.0,
///   none different)
/// - a base that is not flat is cut by least perimeter, seen from outside, and the pyramid into
///   tetrahedra with the triangles between them (recorded cases pyramid_face, _full, _solid)
SlabRegion solid_region(const FigureOp& figure, const LatticeGrid& grid, double weight_dp,
                        double limits_dp);

/// The nodes inside the parts alone, without the faces between them: what setfrdrawmode draws of a
/// prism on the lattice.
SlabRegion inside_of_parts(const FigureOp& figure, const LatticeGrid& grid);

/// The same inside, part by part in GenCase's order of drawing: a convex part, then the faces that
/// it turns to its neighbours.
std::vector<SlabRegion> solid_parts(const FigureOp& figure, const LatticeGrid& grid,
                                    double weight_dp, double limits_dp);

} // namespace fppg
