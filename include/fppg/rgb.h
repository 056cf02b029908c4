#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace fppg
{

/// sRGB.
using Rgb = std::array<std::uint8_t, 3>;

/// "#rrggbb"
std::string hex_of(const Rgb& colour);

/// The colour that "#rrggbb" names; nothing where the text is no such name.
std::optional<Rgb> rgb_of_hex(std::string_view text);

} // namespace fppg
