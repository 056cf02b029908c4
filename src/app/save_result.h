#pragma once

#include "app/run_state.h"

#include <string>

namespace fppg
{

/// "fppg v0.1.0 (compatible with GenCase v5.4)"
std::string full_name();

/// Writes the files of a case, or of one zone, and copies beside them those that it uses. They get
/// their names when the run commits its files. What is no longer needed is given back.
///
/// throws  IoError
void save_result(CaseRunState& run, MadeCase& made);

/// Writes the files that show the zones of a case with `<vres>`.
void save_zones(CaseRunState& run, const VresDef& vres);

} // namespace fppg
