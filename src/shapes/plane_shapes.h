#pragma once

#include "fppg/case_def.h"

#include "nodes/snap.h"
#include "nodes/spans.h"

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
/// corners give their node; corners in one line what rounding makes of these conditions.
SlabRegion triangles_region(std::vector<SnappedTriangle> triangles, const LatticeGrid& grid,
                            double weight_dp, double limits_dp);

/// Cuts the faces of a polyhedron into triangles on the lattice, (0, 1, 2), (0, 2, 3), ... (rule
/// P5).
std::vector<SnappedTriangle> snapped_triangles(const PolyhedronOp& polyhedron,
                                               const LatticeGrid& grid, bool only_visible);

} // namespace fppg
