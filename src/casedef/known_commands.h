#pragma once

#include <string_view>

namespace fppg
{

/// Whether GenCase v5.4, and so this program, has such a command of a list.
bool is_known_command(std::string_view name);

} // namespace fppg
