#pragma once

#include "fppg/case_def.h"

#include "lattice/fitted_draw.h"
#include "walls/part_in_domain.h"

#include <vector>

namespace fppg
{

/// Feature edges and particles as the settings of a wall ask for them.
FeatureOptions feature_options(const FitSettings& settings, const LatticeGrid& grid);

/// Particles on the surface of a body; in 2D where it meets the plane of the particles.
/// body.left_out counts what it lacks.
SurfaceParticles surface_of(FittedBody& body, const FitSettings& settings, const LatticeGrid& grid,
                            int threads);
SurfaceParticles section_of(const FittedBody& body, const FitSettings& settings,
                            const LatticeGrid& grid);

/// Length of the open edges of a surface, metres; in 2D of those that meet the plane of the
/// particles, dp each. Particles stand on them, so half of what these stand for is beyond.
double open_rims(const SurfaceMesh& mesh, const LatticeGrid& grid);

/// Puts particles on the true surface of a shape and finds the nodes inside and around it.
///
/// shape    in the coordinates of the case
/// clips    particles and nodes beyond them are left out; particles are judged by their true place
/// returns  particles inside the domain (between its first and last nodes) only
/// throws   GeometryError without the place of the draw
FittedDraw fit_shape(ShapeMesh shape, const FitSettings& settings, const LatticeGrid& grid,
                     const std::vector<ClipPlane>& clips, BodyExtent extent, int threads);

/// The same for a body whose mesh, report and features are made; is_solid and, where it is round,
/// its shape are set.
FittedDraw fit_body(FittedBody&& body, const FitSettings& settings, const LatticeGrid& grid,
                    const std::vector<ClipPlane>& clips, int threads);

/// Settings of a body that would have its particles inside (FitSettings::may_be_open), but has no
/// inside.
FitSettings of_open_body(const FitSettings& settings);

} // namespace fppg
