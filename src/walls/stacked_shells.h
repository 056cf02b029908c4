#pragma once

#include "fppg/scene.h"

#include "lattice/fitted_draw.h"

#include <cstdint>
#include <set>
#include <vector>

namespace fppg
{

/// Leaves out surfaces that stand among the layers of another one of the same mk, with a warning:
/// shells by which the case thickens a wall, as `<layers vdp>` does. Each would get layers of its
/// own, and between them fluid finds room (public WavesFrCylinder: half as much wall again, and
/// water between its shells). Where a part of such a surface stands elsewhere it stays, and is
/// warned of.
///
/// steps    one entry per step of the scene
/// returns  steps that the case thickened so whose layers are FitSettings::sheet_depths_dp, which
///          nothing asks for: they stay, and want none
std::set<std::uint32_t> leave_out_stacked_shells(const Scene& scene,
                                                 std::vector<FittedStep>& steps);

} // namespace fppg
