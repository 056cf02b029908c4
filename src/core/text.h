#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace fppg
{

/// The small letter of A to Z; all else stays.
inline char lower_case(char c)
{
    return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
}

inline std::string lower_case(std::string_view text)
{
    std::string out(text);
    for (char& c : out) c = lower_case(c);
    return out;
}

/// The text without blanks at its begin and end.
inline std::string_view trimmed(std::string_view text, std::string_view blanks = " \t\n\v\f\r")
{
    const std::size_t begin = text.find_first_not_of(blanks);
    if (begin == std::string_view::npos) return {};
    return text.substr(begin, text.find_last_not_of(blanks) - begin + 1);
}

/// The parts between separators, one more than there are separators.
inline std::vector<std::string_view> split(std::string_view text, char separator)
{
    std::vector<std::string_view> parts;
    for (std::size_t begin = 0; begin <= text.size();)
    {
        const std::size_t end = text.find(separator, begin);
        parts.push_back(text.substr(begin, end - begin));
        begin = end == std::string_view::npos ? text.size() + 1 : end + 1;
    }
    return parts;
}

/// "1 edge", "2 edges"
inline std::string counted(std::size_t n, std::string_view one, std::string_view many)
{
    std::string out = std::to_string(n) + ' ';
    return out += n == 1 ? one : many;
}

} // namespace fppg
