#pragma once

#include "fppg/surface_mesh.h"

namespace fppg
{

/// Counts what is wrong with edges after all mending, and warns of it.
void judge_edges(const SurfaceMesh& mesh, MeshReport& report);

} // namespace fppg
