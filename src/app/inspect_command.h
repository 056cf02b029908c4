#pragma once

#include <string>
#include <vector>

namespace fppg
{

/// `fppg inspect MESH ...`, arguments after the name. Returns the exit code.
///
/// throws UsageError for arguments that are not known or cannot be read, and what inspect_mesh
/// throws
int run_inspect(const std::vector<std::string>& arguments);

} // namespace fppg
