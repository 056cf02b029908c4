#pragma once

#include <string>
#include <vector>

namespace fppg
{

/// `fppg estimate DEFINITION [--json] [options of a run]`: counts, memory and time of a case,
/// beforehand; nothing is written. Returns the exit code, throws Error.
int run_estimate(const std::vector<std::string>& arguments);

} // namespace fppg
