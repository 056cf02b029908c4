#pragma once

#include "fppg/case_def.h"

namespace fppg
{

/// Gives every fitted wall without a boundary condition of its own that of the case's parameter
/// Boundary (2: mDBC), and warns where the two disagree.
void settle_boundaries(CaseDef& def);

} // namespace fppg
