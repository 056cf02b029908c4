#pragma once

#include "fppg/case_def.h"
#include "fppg/motion_gaps.h"
#include "leak/case_solids.h"

namespace fppg
{

/// Nearer surfaces touch: parts that stand on one another have no passage between them; dp.
inline constexpr double touching_dp = 0.02;

/// Looks for narrow passages in front of the boundaries of a case, as measure_motion_gaps() says,
/// and adds what it finds to `out`.
void find_passages(const CaseDef& def, const CaseSolids& solids, int threads, MotionGaps& out);

} // namespace fppg
