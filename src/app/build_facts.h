#pragma once

#include <string>

namespace fppg
{

/// Lines for `fppg -ver`: the commit, the compiler and the libraries, each with the version that is
/// loaded and, where that is another, the one that it was built with.
std::string build_facts();

} // namespace fppg
