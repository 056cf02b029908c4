#pragma once

#include "fppg/case_def.h"
#include "fppg/fitted_walls.h"
#include "fppg/particles.h"

#include <vector>

namespace fppg
{

/// What each particle stands for (CaseParticles::volumes). Those of bodies that ask for it
/// (FitSettings::has_exact_volumes) have the part of their body that is nearest to them, counted by
/// points dp/5 apart, in 2D dp/9; the volumes of a body add up to its own, or to that of its part
/// in the domain. All others have dp^3 (2D: dp^2) or their share of it.
///
/// returns  nothing where no body asks for it
/// throws   GeometryError for a body that is not closed; without its place
std::vector<double> exact_volumes(const CaseDef& def, const FittedWalls& walls,
                                  const CaseParticles& particles, int threads);

} // namespace fppg
