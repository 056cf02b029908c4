#pragma once

#include "fppg/surface_mesh.h"

namespace fppg
{

/// Completes a mesh of which vertices and facets are given: edges, neighbours, shells, normals and
/// areas, and a report on it. Nothing is welded or dropped; facets that clash with the most of
/// their shell are turned.
///
/// mesh       facets with three different corners each; all else is replaced
/// own_above  as measure_facets() takes it
/// threads    number of threads; the result does not depend on it
/// cost       O(n log n)
void connect_mesh(SurfaceMesh& mesh, double own_above, int threads, MeshReport& report);

/// Of a mesh that is changed further, and whose facets do not clash: edges, neighbours, normals and
/// areas. finish_mesh() makes it whole.
void connect_facets(SurfaceMesh& mesh, double own_above, int threads);

/// All that connect_mesh() does, of a mesh whose edges and neighbours are known.
void finish_mesh(SurfaceMesh& mesh, double own_above, int threads, MeshReport& report);

} // namespace fppg
