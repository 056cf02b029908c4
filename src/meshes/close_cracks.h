#pragma once

#include "fppg/surface_mesh.h"

namespace fppg
{

/// Joins the ends of open edges that stand nearer to one another than the rounding of float32
/// leaves certain (of the mesh's largest coordinate), where this leaves fewer edges open: programs
/// write one corner as 0 and as -1e-17. Keeps the edge map.
///
/// dp  metres; no corner moves further than 0.15 dp. 0: unknown
void join_rounded_corners(double dp, SurfaceMesh& mesh, int threads, MeshReport& report);

/// Joins the corners of a mesh whose facets do not meet: where a quarter of all edges are open, and
/// moving corners together by a small distance leaves a tenth of that open at most. The smallest of
/// three distances that does is taken, if it is below a tenth of the mean side and leaves nine
/// tenths of the facets. Keeps the edge map.
///
/// dp  metres; no corner moves further than 0.15 dp. 0: unknown
void close_cracks(double dp, SurfaceMesh& mesh, int threads, MeshReport& report);

/// Joins ends of open edges with other ends, or splits the open edges that they lie inside, up to
/// 0.15 dp away, but never more than a tenth of the mean length of open edges. In steps from narrow
/// to wide, each taken over if it leaves fewer edges open and no more than before with more than
/// two facets. Keeps the edge map.
void close_open_ends(double dp, SurfaceMesh& mesh, int threads, MeshReport& report);

} // namespace fppg
