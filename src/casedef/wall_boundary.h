#pragma once

#include "fppg/case_def.h"

namespace fppg
{

/// Gives every fitted wall without a boundary condition of its own that of the case's parameter
/// Boundary (2: mDBC), warns where the two disagree or one layer stands for mDBC, and hints at
/// parameters that hold fluid in the solver.
void settle_boundaries(CaseDef& def);

} // namespace fppg
