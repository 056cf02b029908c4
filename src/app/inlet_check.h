#pragma once

#include "fppg/case_def.h"
#include "fppg/particles.h"

#include <string>
#include <vector>

namespace fppg
{

/// Warnings of zones of `<inout>` at which the solver v5.4 stops: points in no plane across their
/// way, or where a point, or one of the rows that the solver sets behind it, is nearer than 0.7 dp
/// to a boundary particle, or beyond all particles (JSphInOutPoints::CheckPointsInPlane,
/// CheckPoints, JSphInOut::InitCheckProximity).
///
/// particles  with their places of the start
std::vector<std::string> check_inlets(const CaseDef& def, const CaseParticles& particles);

} // namespace fppg
