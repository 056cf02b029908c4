#pragma once

#include <string>

namespace fppg
{

/// Reading a pipe waits for whoever writes it, reading a device like /dev/zero never ends.
///
/// throws  IoError that names the file and says what it is where it is neither a regular file nor a
///         folder; a file that is not there is left to whoever opens it
void expect_regular_file(const std::string& path);

} // namespace fppg
