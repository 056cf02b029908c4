#pragma once

#include <string>
#include <vector>

namespace fppg
{

/// `fppg convert CASE -o FILE`. The arguments stand behind "convert"; returns the exit code.
///
/// throws  UsageError, IoError, CaseError
int run_convert(const std::vector<std::string>& arguments);

} // namespace fppg
