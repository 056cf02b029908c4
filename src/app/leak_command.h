#pragma once

#include <string>
#include <vector>

namespace fppg
{

/// `fppg leak CASE PART_FILES... [--json FILE] [--plot FILE]`: counts the fluid particles that a
/// run of the solver has where none can be.
///
/// returns  0 if there are none, 1 if there are
/// throws   UsageError, IoError, CaseError, GeometryError
int run_leak(const std::vector<std::string>& arguments);

} // namespace fppg
