#pragma once

#include <string>
#include <string_view>

namespace fppg::fuzz
{

/// Makes a folder of its own for this process, which is removed when the process ends, goes into
/// it, and puts the files there that cases may name.
void enter_working_folder();

/// Writes a file into the working folder.
void write_input(const std::string& name, std::string_view bytes);

/// Removes what a target wrote.
void tidy_working_folder();

} // namespace fppg::fuzz
