#pragma once

#include "fppg/mesh.h"

#include "meshes/mesh_query.h"

namespace fppg
{

/// The distance, in metres, that a share of the area of some facets is within of a surface.
///
/// facets  without an area are no part of it; 0 where none has one
/// share   0 to 1: 0.5 gives the median
double distance_of_share(const TriangleSoup& facets, const MeshQuery& surface, double share);

/// Facets pressed to the plane of a 2D case, in which cases draw them as wide as they like: those
/// across it are left out.
///
/// y  of the plane, metres
TriangleSoup pressed_to_plane(const TriangleSoup& facets, double y);

} // namespace fppg
