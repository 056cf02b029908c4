#pragma once

#include "fppg/surface_mesh.h"

namespace fppg
{

/// Completes a mesh of which vertices and facets are given: edges, neighbours, shells, normals and
/// areas, and a report on it. Nothing is welded or dropped; facets that clash with the most of
/// their shell are turned.
///
/// mesh     facets with three different corners each; all else is replaced
/// threads  number of threads; the result does not depend on it
/// cost     O(n log n)
void connect_mesh(SurfaceMesh& mesh, int threads, MeshReport& report);

} // namespace fppg
