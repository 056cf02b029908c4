#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace fppg
{

/// The text with the small letters of A to Z; all else stays.
inline std::string lower_case(std::string_view text)
{
    std::string out(text);
    for (char& c : out)
        if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
    return out;
}

/// "1 edge", "2 edges"
inline std::string counted(std::size_t n, std::string_view one, std::string_view many)
{
    std::string out = std::to_string(n) + ' ';
    return out += n == 1 ? one : many;
}

} // namespace fppg
