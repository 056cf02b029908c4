#include "fppg/rgb.h"

#include <fmt/format.h>

#include <charconv>

namespace fppg
{

std::string hex_of(const Rgb& colour)
{
    return fmt::format("#{:02x}{:02x}{:02x}", colour[0], colour[1], colour[2]);
}

std::optional<Rgb> rgb_of_hex(std::string_view text)
{
    if (text.size() != 7 || text[0] != '#') return std::nullopt;
    Rgb out{};
    for (std::size_t c = 0; c < 3; ++c)
    {
        const char* begin = text.data() + 1 + 2 * c;
        const auto [end, error] = std::from_chars(begin, begin + 2, out[c], 16);
        if (error != std::errc() || end != begin + 2) return std::nullopt;
    }
    return out;
}

} // namespace fppg
