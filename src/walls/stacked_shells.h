#pragma once

#include "fppg/scene.h"

#include "lattice/fitted_draw.h"

#include <vector>

namespace fppg
{

/// Warns of surfaces that stand among the layers of another one of the same mk: a wall that the
/// case thickens shell by shell, where each shell would get layers of its own.
///
/// steps  one entry per step of the scene; the warnings are added there
void warn_of_stacked_shells(const Scene& scene, std::vector<FittedStep>& steps);

} // namespace fppg
