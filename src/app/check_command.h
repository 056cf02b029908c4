#pragma once

#include <string>
#include <vector>

namespace fppg
{

/// `fppg check`: judges a written case as the solver would. arguments  behind the subcommand.
///
/// returns  the exit code
/// throws   as check_case(); CaseError for findings with --strict
int run_check(const std::vector<std::string>& arguments);

} // namespace fppg
