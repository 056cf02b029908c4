#pragma once

#include "fppg/surface_mesh.h"

#include <limits>

namespace fppg
{

/// Facets of this height have particles whose places go by their own plane, dp.
inline constexpr double high_for_particles = 0.25;

/// The same of facets whose corners are as exact as doubles are, dp: of round shapes, CAD files
/// and surfaces that the program makes.
inline constexpr double high_where_exact = 0.01;

/// Normals and areas. A facet whose height is within the rounding of its corners takes the normal
/// of its neighbour across its longest side, through several such facets where they lie in a row.
///
/// threads    number of threads; the result does not depend on it
/// own_above  m; facets that are higher keep the normal of their own plane, however far from the
///            origin they are: particles are laid across them
void measure_facets(SurfaceMesh& mesh, int threads,
                    double own_above = std::numeric_limits<double>::infinity());

/// How much a surface turns for its area, radians a metre: 2 / R of a ball. Turns of more than a
/// right angle count for less.
double turn_per_metre(const SurfaceMesh& mesh);

} // namespace fppg
