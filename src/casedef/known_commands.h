#pragma once

#include <string_view>

namespace fppg
{

enum class CommandSupport
{
    Unknown, ///< no command of GenCase v5.4: refused
    Planned, ///< known, not built: "not supported yet"
    Built,
};

/// What this program does with a command of a list. The table behind it is the one place that names
/// what is not supported yet.
CommandSupport command_support(std::string_view name);

} // namespace fppg
