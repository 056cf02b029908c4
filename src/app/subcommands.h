#pragma once

#include <string>
#include <vector>

namespace fppg
{

/// What `fppg NAME ...` does with the arguments after the name. Returns the exit code, throws
/// Error.
using Subcommand = int (*)(const std::vector<std::string>& arguments);

/// The subcommand of this name, or nullptr: the arguments are then in GenCase's form. A definition
/// that is called like a subcommand can be given as `./render`.
Subcommand find_subcommand(const std::string& name);

/// For a first argument that is no subcommand, no option and no definition, but nearly a
/// subcommand.
///
/// throws  UsageError that names it
void refuse_mistyped_subcommand(const std::string& argument);

} // namespace fppg
