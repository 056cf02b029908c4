#pragma once

#include "fppg/surface_mesh.h"

namespace fppg
{

/// Takes thin facets out of a mesh that was cut from a grid and whose vertices were then put onto
/// creases: vertices nearer than 0.2 cells become one, and where a facet is lower than 0.1 cells
/// its longest side is turned to the other diagonal. Features and charts would take folded slivers
/// for sheets of their own.
///
/// mesh    connected before and after
/// cell    metres
void remove_slivers(SurfaceMesh& mesh, double cell, int threads, MeshReport& report);

/// connect_mesh() once more, after vertices have moved; report.facets_read stays.
void reconnect(SurfaceMesh& mesh, int threads, MeshReport& report);

} // namespace fppg
