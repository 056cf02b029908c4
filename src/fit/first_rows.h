#pragma once

#include "fit/walk.h"

namespace fppg
{

/// Starting points of surface particles along feature lines: on each side of a line, 0.93 dp off
/// it, beside the middle between every two neighbours on the line. In the order of the lines.
std::vector<SurfaceRay> lay_first_rows(const SurfaceMesh& mesh, const WorkMesh& work,
                                       const Features& features,
                                       const std::vector<FeatureParticle>& particles, double dp,
                                       int threads);

} // namespace fppg
