#pragma once

#include "app/run_log.h"
#include "fppg/fitted_walls.h"
#include "fppg/particles.h"
#include "fppg/scene.h"

#include <string>
#include <vector>

namespace fppg
{

/// Writes mass, centre and inertia of all floating bodies into the log: of their particles, as they
/// go into Case.xml like those of GenCase, and beside them the exact ones of the closed shape, at
/// the density of `<floating>` (where the mass is given, mass over exact volume). Where
/// `<fppg><floatings exact="true">` asks for it the exact ones take the place of the others, but
/// for what `<floating>` itself gives.
///
/// returns  warnings: bodies with fitted walls whose mass by their density is more than 2 % off
///          that of their shape, as they are hollow or cut
/// throws   CaseError where exact ones are asked for and no single closed shape draws the body
std::vector<std::string> settle_floatings(const Scene& scene, const FittedWalls& walls,
                                          CaseParticles& particles, RunLog& log);

} // namespace fppg
