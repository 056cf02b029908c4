#pragma once

#include "fppg/case_def.h"

#include "lattice/snap.h"
#include "lattice/spans.h"

namespace fppg
{

/// The nodes of points: each point's nearest node (rule P1).
SlabRegion points_region(const std::vector<Vec3>& points, const LatticeGrid& grid);

/// The nodes of segments: with both ends snapped, the nodes of their index box whose distance to
/// the line is less than `width_dp` * dp (rule P2); both ends on one node give nothing (golden
/// line_random).
SlabRegion lines_region(const std::vector<std::pair<Node, Node>>& segments, const LatticeGrid& grid,
                        double width_dp);

/// Three snapped corners.
struct SnappedTriangle
{
    Node a;
    Node b;
    Node c;
};

/// The nodes of triangles (rule P3): those of the index box of the corners that are nearer to the
/// plane than weight_dp * dp and not farther beyond any edge than limits_dp * dp. Three equal
/// corners give their node; a triangle with no area gives nothing.
SlabRegion triangles_region(std::vector<SnappedTriangle> triangles, const LatticeGrid& grid,
                            double weight_dp, double limits_dp);

/// Cuts the faces of a figure into triangles on the lattice, (0, 1, 2), (0, 2, 3), ... (rule P5).
std::vector<SnappedTriangle> snapped_triangles(const FigureOp& figure, const LatticeGrid& grid,
                                               bool only_visible);

/// The inside of a figure, found by experiment with GenCase v5.4.354 (rules S1 to S4): nodes
/// strictly inside all planes of its parts, in double and without tolerance; none when it is wound
/// inwards.
/// - a prism of more than three corners is cut into prisms of three: from the bottom polygon the
/// corner
///   whose triangle has the least perimeter is cut off again and again; the quads between the parts
///   are drawn too (rule P5), of which only nodes strictly between the bottom and the top of a part
///   next to them are kept
/// - a pyramid with a base that is not flat after snapping is cut into tetrahedra in the same way,
/// with
///   the triangles between them; a flat base is one plane
SlabRegion solid_region(const FigureOp& figure, const LatticeGrid& grid, double weight_dp,
                        double limits_dp);

} // namespace fppg
