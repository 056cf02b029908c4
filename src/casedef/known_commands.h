#pragma once

#include <string_view>

namespace fppg
{

/// Whether GenCase v5.4, and so this program, has such a command of a list.
bool is_known_command(std::string_view name);

/// Whether a command may have such a child element. Commands that read their children one by one
/// refuse all others, as GenCase does; the rest, and files and bathymetries, pass over them.
/// Remarks (`_point`) and the children of other languages (`fppg:`) are for the caller to know.
bool may_have_child(std::string_view command, std::string_view child);

} // namespace fppg
