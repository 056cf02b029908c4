#pragma once

#include "casedef/program.h"

#include <cstddef>
#include <string_view>
#include <vector>

namespace fppg
{

/// A command of the lists in `<commands>`.
struct CommandRow
{
    std::string_view name;
    /// Elements that it may have, separated by blanks, with '+' those that may be repeated; "*":
    /// any.
    std::string_view children;
    void (*run)(Program& p, const Element& e);
    bool is_own = false; ///< GenCase does not have it
};

/// The row of a command; null: there is none of this name. `drawfileply` and the like are found
/// by the table of mesh formats.
const CommandRow* find_command(std::string_view name);

/// All names of commands.
std::vector<std::string_view> command_names();

/// How many such child elements a command may have: none, 1, or SIZE_MAX for any number. Commands
/// that read their children one by one refuse all others, as GenCase does; the rest pass over them.
/// Remarks (`_point`) and the children of other languages (`fppg:`) are for the caller to know.
std::size_t allowed_children(const CommandRow& row, std::string_view child);

} // namespace fppg
