#pragma once

#include <charconv>
#include <cmath>
#include <optional>
#include <string_view>

namespace fppg
{

/// The number that the whole text is; nothing where it is none, is infinite or begins with a +.
inline std::optional<double> finite_number(std::string_view text)
{
    double value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(value))
        return {};
    return value;
}

/// As finite_number, but may begin with a +.
inline std::optional<double> finite_signed_number(std::string_view text)
{
    if (text.starts_with('+')) text.remove_prefix(1);
    return finite_number(text);
}

} // namespace fppg
