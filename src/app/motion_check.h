#pragma once

#include "fppg/case_def.h"
#include "fppg/particles.h"

#include <string>
#include <vector>

namespace fppg
{

/// Moving parts that leave solver_domain(). The particles of every moving block whose box leaves it
/// are followed through the movements of `<motion>` up to TimeMax (10 s without it) in
/// 2000 steps, of more than 20,000 particles in fewer. Movements that files give are not followed,
/// nor is a case with old keys of `<parameters>` for the domain, or with variable resolution.
/// Nothing leaves along a periodic axis.
///
/// returns  a sentence a moving block that leaves, with file, line, time and place
std::vector<std::string> check_motion(const CaseDef& def, const CaseParticles& particles);

} // namespace fppg
