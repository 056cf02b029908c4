#pragma once

#include <string>
#include <vector>

namespace fppg
{

/// Writes the built-in case templates, the files that they read and their schema into a folder,
/// which is made where it is missing, and prints what was done.
///
/// overwrite  files that exist with other bytes are replaced; without, they stay and are named
/// throws     IoError if a file cannot be written
void write_templates(const std::string& folder, bool overwrite);

/// `fppg templates FOLDER [--overwrite]`. Returns the exit code, throws Error.
int run_templates(const std::vector<std::string>& arguments);

} // namespace fppg
