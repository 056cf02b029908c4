#pragma once

#include "fppg/case_def.h"

#include <string>
#include <vector>

namespace fppg
{

/// The zones of `<execution><special><inout>`, as DualSPHysics v5.4 reads them
/// (JSphInOutPoints.cpp). What is missing or wrong in them is for the solver to refuse; a zone that
/// cannot be placed is left out, and a warning says so.
///
/// def  its execution is evaluated, its first mk of fluid is settled
InOutZones read_inout_zones(const CaseDef& def, std::vector<std::string>& warnings);

} // namespace fppg
