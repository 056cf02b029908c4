#pragma once

#include "fppg/scene.h"

#include "lattice/fitted_draw.h"

#include <cstdint>
#include <set>
#include <vector>

namespace fppg
{

/// Puts particles on the true surfaces of all shapes and combinations of a scene whose mk is
/// body-fitted. Points, lines, wires and other mks stay on the lattice, and in 2D what lies in the
/// plane of the particles.
///
/// wet       steps whose sheets get no layers by FitSettings::sheet_depths_dp
/// progress  may be empty; called with the number of steps done and of all
/// returns   one entry per step of the scene
/// throws    IoError, GeometryError with the place of the draw
std::vector<FittedStep> fit_walls(const Scene& scene, const std::set<std::uint32_t>& wet,
                                  int threads, const LatticeProgress& progress);

} // namespace fppg
