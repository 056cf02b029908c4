#pragma once

#include <cstddef>
#include <string_view>

namespace fppg
{

/// Whether GenCase v5.4, and so this program, has such a command of a list.
bool is_known_command(std::string_view name);

/// How many such child elements a command may have: none, 1, or SIZE_MAX for any number. Commands
/// that read their children one by one refuse all others, as GenCase does; the rest pass over them.
/// Remarks (`_point`) and the children of other languages (`fppg:`) are for the caller to know.
std::size_t allowed_children(std::string_view command, std::string_view child);

} // namespace fppg
