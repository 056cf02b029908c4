#pragma once

#include "fppg/case_def.h"
#include "fppg/mesh.h"

namespace fppg
{

/// What is left of triangles inside a box, as one polygon a triangle: a triangle across a side is
/// cut there, and nothing closes the cut. Polygons of four corners are drawn as quads, those of
/// more are cut by least perimeter (of 30 random cuts of turned meshes 22 gave the nodes of GenCase
/// v5.4.354; what it does in the others is not known).
FigureOp clip_to_box(const TriangleSoup& soup, const Box3& box);

} // namespace fppg
