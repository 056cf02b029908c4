#pragma once

#include "fppg/surface_mesh.h"

namespace fppg
{

/// Keeps one of all facets with the same corners, and none of two with opposite faces that are a
/// wall between two bodies. Counts both, and keeps the edge map.
///
/// threads  number of threads; the result does not depend on it
void drop_copies(SurfaceMesh& mesh, int threads, MeshReport& report);

} // namespace fppg
