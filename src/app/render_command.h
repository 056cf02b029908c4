#pragma once

#include <string>
#include <vector>

namespace fppg
{

/// `fppg render CASE [CASE] -o picture.png`: draws one case, or two side by side.
///
/// returns  the exit code
/// throws   Error
int run_render(const std::vector<std::string>& arguments);

} // namespace fppg
