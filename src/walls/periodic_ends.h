#pragma once

#include "fppg/mesh.h"
#include "fppg/scene.h"

#include <optional>
#include <string>

namespace fppg
{

/// The lattice of a periodic case with body-fitted walls, from the first to the last node that
/// anything is drawn on along its periodic axes: the solver's period is the extent of the particles
/// and dp, however far `<definition>` reaches (JSph.cpp v5.4). Empty where that is the lattice of
/// the case already, and for cases with `<vres>` or with points from files.
std::optional<LatticeGrid> lattice_of_period(const Scene& scene, int threads);

/// Lets a shape go on over both ends of a period that it is drawn up to, within 0.75 dp, as the
/// next copy of the case does: by 8 dp. Else its walls would bend around its ends and leave gaps of
/// two steps or more in each layer where copies meet (public mDBC Poiseuille flow: fluid went 3.5
/// dp into the walls). Nothing is done where its ends are not plane and across the axis, or its
/// sides there not along it.
///
/// returns  the axes along which it goes on, such as "x"
std::string continue_over_periods(const LatticeGrid& grid, TriangleSoup& soup);

} // namespace fppg
