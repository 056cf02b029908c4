#pragma once

#include "fppg/case_def.h"
#include "fppg/particles.h"

#include <optional>
#include <string>

namespace fppg
{

/// What a warning says of the fixed and moving particles of a zone of `<vres>` that the solver
/// stops at: those in buffers, with modified boundaries only those without a normal (v5.4,
/// JSphVRes::CheckNormals).
std::optional<std::string> check_buffers(const CaseDef& def, const CaseParticles& particles);

} // namespace fppg
