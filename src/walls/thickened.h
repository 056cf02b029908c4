#pragma once

#include "fppg/case_def.h"
#include "fppg/surface_mesh.h"

#include "shapes/shape_mesh.h"
#include "walls/step_surfaces.h"

#include <cstdint>
#include <string>
#include <vector>

namespace fppg
{

// Plates and shells for mDBC that have room for one layer, through which fluid goes (solver v5.4, a
// gate of 1 dp before water of 17 dp: 157 of 5,220 particles in 0.14 s; of 2 dp: none). They are
// thickened to 2 dp, evenly to both sides: the nodes of the lattice hold fluid as far off. Those
// that are round fluid have a wet side instead (wet_side.h).

/// Whether plates of a mk are thickened: in as many layers for mDBC as fluid sees, and not
/// floating, as bodies that float weigh what their shape does.
bool may_thicken(const CaseDef& def, std::uint16_t mk);

/// Moves the thin facets of a closed surface outwards where at least half of it is thin; all others
/// stay. Where facets face others, as the flanks of teeth and fins do, 1.25 dp of the gap are left.
///
/// returns  its least thickness before, metres; 0: nothing moved
double thicken(const LatticeGrid& grid, int threads, SurfaceMesh& mesh);

/// The same of a shape that is solid, or whose surface is closed; it is no longer round, nor a CAD
/// model.
double thicken(const LatticeGrid& grid, int threads, ShapeMesh& shape);

/// What a warning says of it.
std::string thickened_from(double thickness, double dp);

/// step_surfaces() as walls are fitted to them.
std::vector<StepSurface> fitted_surfaces(const Scene& scene, const SceneStep& step, int threads);

} // namespace fppg
