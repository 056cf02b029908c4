#pragma once

#include "fppg/scene.h"

#include <cstdint>
#include <set>
#include <vector>

namespace fppg
{

/// Absolute mks whose sheets keep one row of particles under dynamic boundaries: what moves faster
/// than a thirtieth of the speed of sound at some time, and what floats with a mass that its
/// particles make. What files move, or what stands elsewhere for the solver, as paddles, is taken
/// for slow, as are bodies afloat.
///
/// Solver v5.4: an open vessel jerked to 0.5 to 2 m/s at dp 0.01, 0.007 and 0.005 m, by a thirtieth
/// of its speed of sound: no fluid gets through three rows; by a twentieth, up to 1; by a tenth, up
/// to 11, through one row none. But one row does not hold fluid still: in a tank of a capsule's
/// shape half a g was left beside it, beside three rows 0.0003.
///
/// fluid    boxes_of_fluid()
/// threads  for the meshes of walls that move
std::set<std::uint16_t> mks_of_fast_walls(const Scene& scene, const std::vector<Box3>& fluid,
                                          int threads);

} // namespace fppg
