#pragma once

#include <string>
#include <vector>

namespace fppg
{

/// `fppg upgrade DEFINITION...`: tells what an upgrade to v5.4's forms changes, and writes it where
/// asked to. Returns 0.
///
/// throws  UsageError, CaseError, IoError; IoError too where a file would be lost by writing
int run_upgrade(const std::vector<std::string>& arguments);

} // namespace fppg
