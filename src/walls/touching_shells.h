#pragma once

#include "fppg/surface_mesh.h"

namespace fppg
{

/// Makes one body of the closed shells of a mesh that touch face to face, however their faces are
/// meshed and wherever on one another they lie: the wall between them drops out. Facets touch that
/// look at each other (to 2.5 degrees), lie within a hundredth of dp of one another, and overlap.
/// Shells that face inwards (cavities) stay as they are.
///
/// mesh, report  as repair_mesh() made them; both are made anew where something touches, and the
///               report then has a warning that says so
/// dp            metres
/// throws        GeometryError as boolean_mesh() and repair_mesh()
void unite_touching_shells(SurfaceMesh& mesh, MeshReport& report, double dp, int threads);

} // namespace fppg
