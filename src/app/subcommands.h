#pragma once

#include <string>
#include <vector>

namespace fppg
{

/// Whether the first argument names a subcommand; all else is in GenCase's form.
bool is_subcommand(const std::vector<std::string>& arguments);

/// Runs the subcommand that the first argument names, and prints what it has to say.
///
/// returns  the exit code
/// throws   UsageError for arguments that are not known or cannot be read, and what the subcommand
///          throws
int run_subcommand(const std::vector<std::string>& arguments);

} // namespace fppg
