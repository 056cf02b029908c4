#pragma once

#include "fppg/compare.h"

#include <string>

namespace fppg
{

/// "fixed" to "fluid"; "-" for none.
const char* particle_type_name(int type);

const char* change_name(ChangeKind kind);

/// "id 5 at (0, 0.1, 0) ..." of a particle or a pair.
std::string describe_change(const ChangedParticle& p);

} // namespace fppg
