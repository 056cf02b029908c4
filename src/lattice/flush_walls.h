#pragma once

#include "fppg/fitted_walls.h"

#include "meshes/inside_test.h"

#include <vector>

namespace fppg
{

/// Rounding of places on a face, dp.
inline constexpr double on_face_dp = 1e-3;

/// Finds the particles of walls that a closed shape touches from outside, such as a void that ends
/// in the plane in which a solid begins: their body goes on behind the face that they stand on.
///
/// walls    all that was drawn before; sheets, layers and bodies with their particles half a dp
///          inside have none
/// extent   the shape, ready for nearest points
/// dp       metres
/// returns  1 for those, one entry per particle
std::vector<char> flush_particles(const FittedWalls& walls, const InsideTest& extent, double dp,
                                  int threads);

} // namespace fppg
