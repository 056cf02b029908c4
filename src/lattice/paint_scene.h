#pragma once

#include "fppg/scene.h"

#include "lattice/fitted_draw.h"

#include <vector>

namespace fppg
{

/// Paints the steps of a scene in order, each over what was there.
///
/// fitted  one entry per step: where it is fitted, its draws stand for the shape
RunField paint_scene(const Scene& scene, std::vector<FittedStep>&& fitted, int threads,
                     const LatticeProgress& progress, LatticeReport& report);

} // namespace fppg
