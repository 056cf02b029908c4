#pragma once

#include "fppg/surface_mesh.h"

namespace fppg
{

/// Normals and areas. A facet whose height is within the rounding of its corners takes the normal
/// of its neighbour across its longest side, through several such facets where they lie in a row.
///
/// threads  number of threads; the result does not depend on it
void measure_facets(SurfaceMesh& mesh, int threads);

/// How much a surface turns for its area, radians a metre: 2 / R of a ball. Turns of more than a
/// right angle count for less.
double turn_per_metre(const SurfaceMesh& mesh);

} // namespace fppg
