#pragma once

#include <string>
#include <vector>

namespace fppg
{

/// `fppg report`: a page about results. Returns the exit code.
/// throws  UsageError, IoError, and as measure_result()
int run_report(const std::vector<std::string>& arguments);

} // namespace fppg
