#pragma once

#include "fppg/mesh.h"
#include "fppg/mesh_reading.h"
#include "fppg/vec.h"

namespace fppg
{

/// How a file with `<clipdomain>` is read before it is cut: `polyselec` chooses among what is left
/// of all its shapes by the corners these have then.
MeshReading reading_to_clip(MeshReading reading);

/// The domain of a case (`<pointmin>` to `<pointmax>`), this many metres farther out on all sides.
Box3 clip_box(const Vec3& domain_min, const Vec3& domain_max, double resize);

/// Whether all corners, points and lines of a mesh, chosen or not, lie in a box: GenCase v5.4.354
/// then draws the mesh as without `<clipdomain>`, else none of its points and lines, not even those
/// inside.
bool is_within(const MeshFile& mesh, const Transform& place, const Box3& box);

/// What is left of the triangles, quads and polygons of a mesh inside a box, in the coordinates of
/// the file: what reaches over a side is cut there, and nothing closes the cut.
///
/// Corners are cut where `place` puts them, in double. The lower sides cut first (x, y, z), then
/// the upper ones; a corner outside gives way to the point on the edge to the corner before it,
/// then to the one on the edge to the corner after it, unless this point is within 1e-4 m of the
/// corner kept before it. The points stay where rounding leaves them, beyond the side too, which
/// decides what a box without thickness leaves in a 2D case: of a polygon both of whose points on
/// the plane lie beyond it by 1e-17 m nothing is left, of others one or two triangles with two
/// corners in one place. What is left goes back to the coordinates of the file, as float32; with a
/// scale of 0 all of it goes to the origin.
///
/// reading  as it was before reading_to_clip(). For all formats but STL four corners left are a
///          quad, and more are cut by ears of least perimeter; for STL all are fans about the first
///          corner. Three corners are left out unless triangles are chosen, four unless quads are,
///          more unless both and other polygons are
///
/// Polygons, corners, their order and the triangles are those of GenCase v5.4.354 to the last bit
/// of float32 (found with `shapeout`): 230 random triangles of STL and 50 flat quads of PLY in a
/// box; in 2D cases 4000 triangles at four planes and 1000 more under a drawmove. Quads that are
/// not flat are cut otherwise there in 6 of 30 cases of more than four corners. Nodes, halves of dp
/// included: none different in 200 triangles with corners on the sides.
MeshFile clip_to_box(const MeshFile& mesh, const Transform& place, const Box3& box,
                     const MeshReading& reading);

} // namespace fppg
