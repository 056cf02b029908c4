#pragma once

#include "fppg/scene.h"

#include "lattice/fitted_draw.h"

#include <vector>

namespace fppg
{

/// Leaves out surfaces that stand among the layers of another one of the same mk, with a warning:
/// shells by which the case thickens a wall, as `<layers vdp>` does. Each would get layers of its
/// own, and between them fluid finds room (public WavesFrCylinder: half as much wall again, and
/// water between its shells). Where a part of such a surface stands elsewhere it stays, and is
/// warned of.
///
/// steps  one entry per step of the scene
void leave_out_stacked_shells(const Scene& scene, std::vector<FittedStep>& steps);

} // namespace fppg
