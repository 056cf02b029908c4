#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

namespace fppg
{

/// 12345678 as 12,345,678.
inline std::string thousands(std::uint64_t n)
{
    std::string text = std::to_string(n);
    for (auto at = static_cast<std::ptrdiff_t>(text.size()) - 3; at > 0; at -= 3)
        text.insert(static_cast<std::size_t>(at), 1, ',');
    return text;
}

} // namespace fppg
