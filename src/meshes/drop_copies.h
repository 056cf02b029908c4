#pragma once

#include <cstddef>
#include <vector>

#include "fppg/surface_mesh.h"

#include "meshes/mesh_facets.h"

namespace fppg
{

/// How many facets there are, those with the same corners counted once.
std::size_t count_different(const std::vector<Facet>& facets, int threads);

/// Keeps one of all facets with the same corners, and none of two with opposite faces that are a
/// wall between two bodies. Counts both, and keeps the edge map.
///
/// threads  number of threads; the result does not depend on it
void drop_copies(SurfaceMesh& mesh, int threads, MeshReport& report);

} // namespace fppg
