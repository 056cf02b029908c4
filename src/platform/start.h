#pragma once

#include <string>
#include <vector>

namespace fppg
{

/// Opens what the caller of the program closed: a file that the program opens must not become its
/// standard output. On Windows, text on a console is UTF-8 from here on.
void prepare_streams();

/// The arguments of the program without its name, in UTF-8.
std::vector<std::string> program_arguments(int argc, char** argv);

/// Sets a variable of the environment where the user did not.
void set_default_variable(const char* name, const char* value);

} // namespace fppg
