#pragma once

#include "fppg/case_def.h"
#include "fppg/particles.h"

#include <string>
#include <vector>

namespace fppg
{

/// Moves limits of `<simulationdomain>` that are given in metres and lie within the particles of
/// fitted walls to a dp beyond these: layers stand behind the surface that the limits were chosen
/// for, and the solver refuses particles beyond (v5.4, JSph::ResizeMapLimits: the limits must hold
/// all particles and 0.05 h around them).
///
/// def       its execution is changed
/// returns   one line for each limit that was moved; none without fitted walls, or with `<vres>`
std::vector<std::string> widen_simulation_domain(const CaseParticles& particles, CaseDef& def);

} // namespace fppg
