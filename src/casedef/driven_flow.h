#pragma once

#include "fppg/case_def.h"

namespace fppg
{

/// Finds which part of gravity drives fluid through a channel: that along a periodic axis, and that
/// along an axis with zones of `<inout>` towards both of its ends, up to half of gravity. Nothing
/// holds fluid against it, so fitted cases take depths without it. GenCase's depths have it in
/// them: their pressure falls along the channel and jumps at the end of a period. Solver v5.4,
/// public CasePoiseuilleLR after 0.6 s: densities from 1001.2 to 1002.1 kg/m3, the mean speed over
/// the pipe's length varies by 1.6 % (standard deviation); with rhop0 everywhere 999.9 to 1000.0,
/// and 0.06 %.
///
/// def  with body-fitted walls def.constants.driving is set, with a warning
void find_driving_gravity(CaseDef& def);

} // namespace fppg
