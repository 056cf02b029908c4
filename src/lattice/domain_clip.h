#pragma once

#include "fppg/case_def.h"
#include "fppg/mesh.h"

namespace fppg
{

/// The domain of a case (`<pointmin>` to `<pointmax>`), so many metres farther out on all sides.
Box3 clip_box(const CaseDef& def, double resize);

/// Whether all corners, points and lines of a mesh lie in a box: GenCase v5.4.354 then draws the
/// mesh as without `<clipdomain>`, else none of its points and lines, not even those inside.
bool is_within(const MeshFile& mesh, const Transform& place, const Box3& box);

/// What is left of the triangles, quads and polygons of a mesh inside a box, corners placed by
/// `place`: what reaches over a side is cut there, and nothing closes the cut. The lower sides cut
/// first (x, y, z), then the upper ones; a corner outside gives way to the point on the edge to the
/// corner before it, then to the one on the edge to the corner after it. Points are found in
/// double, kept as float32 in the coordinates of the file, and placed then.
///
/// keeps_quads  true, as for all files but STL: four corners are a quad, more are cut by ears of
///              least perimeter, in the coordinates of the file (cut_into_ears). false: the fan
///              about the first corner
///
/// Corners, their order and the triangles are those of GenCase v5.4.354 to the last bit of float32
/// for 230 random triangles of STL and 50 flat quads of PLY (found with `shapeout`); quads that are
/// not flat are cut otherwise there in 6 of 30 cases of more than four corners. Nodes, halves of dp
/// included: none different in 200 triangles with corners on the sides.
FigureOp clip_to_box(const MeshFile& mesh, const Transform& place, const Box3& box,
                     bool keeps_quads);

} // namespace fppg
