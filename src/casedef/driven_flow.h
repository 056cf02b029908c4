#pragma once

#include "fppg/case_def.h"

namespace fppg
{

/// Nothing holds fluid against gravity along a periodic axis: it is driven, and has no depth.
/// GenCase's densities of a depth along such an axis jump at the end of the period. Solver v5.4,
/// public CasePoiseuilleLR after 0.6 s: densities from 1001.2 to 1002.1 kg/m3, the mean speed over
/// the pipe's length varies by 1.6 % (standard deviation); with rhop0 everywhere 999.9 to 1000.0,
/// and 0.06 %.
///
/// def  with body-fitted walls its rhop_gradient becomes 1, with a warning
void drop_driven_depth(CaseDef& def);

} // namespace fppg
