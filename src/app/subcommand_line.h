#pragma once

#include <string>
#include <vector>

#include <CLI/CLI.hpp>

namespace fppg
{

/// Reads the arguments of a subcommand, which the app names ("fppg render"). False if help was
/// asked for: it is printed, and nothing is left to do.
///
/// throws  UsageError that names the argument and how to get help
bool read_subcommand_line(CLI::App& app, const std::vector<std::string>& arguments);

} // namespace fppg
