#pragma once

#include <string>
#include <vector>

namespace fppg
{

/// `fppg compare A B`: says what differs between two results of one case.
///
/// returns  0 equal, 1 different
/// throws   Error with exit code 2 where the arguments are wrong or a result cannot be read
int run_compare(const std::vector<std::string>& arguments);

} // namespace fppg
