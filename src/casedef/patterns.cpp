#include "casedef/patterns.h"

#include "core/text.h"

#include <fmt/format.h>

#include <algorithm>

namespace fppg
{
namespace
{

constexpr int max_extent = 1'000'000;

std::array<std::uint32_t, 3> counts(const Element& e, int min, const AttributeReader& read)
{
    std::array<std::uint32_t, 3> out{};
    for (std::size_t axis = 0; axis < 3; ++axis)
        out[axis] = static_cast<std::uint32_t>(
            read.integer(e, std::string(1, "xyz"[axis]), min, max_extent, false));
    return out;
}

std::vector<char> cells_of(const Element& e, std::uint64_t n, const AttributeReader& read)
{
    const std::string& text = read.text(e, "pattern");
    std::vector<char> cells;
    const auto is_cell = [](char c) { return c == 'X' || c == 'x' || c == '-'; };
    if (std::all_of(text.begin(), text.end(), is_cell))
    {
        for (const char c : text) cells.push_back(c == '-' ? 0 : 1);
        if (cells.size() != n)
            read.fail(e, fmt::format("pattern=\"{}\" has {} cells, its size asks for {}", text,
                                     cells.size(), n));
        return cells;
    }
    for (const char c : lower_case(text))
    {
        const std::size_t digit = std::string_view("0123456789abcdef").find(c);
        if (digit == std::string_view::npos)
            read.fail(e, fmt::format("pattern=\"{}\" is invalid, expected X and - or a hexadecimal "
                                     "number",
                                     text));
        for (int bit = 3; bit >= 0; --bit) cells.push_back(static_cast<char>(digit >> bit & 1));
    }
    if (cells.size() != (n + 3) / 4 * 4)
        read.fail(e, fmt::format("pattern=\"{}\" has {} hexadecimal digits, its size asks for {}",
                                 text, text.size(), (n + 3) / 4));
    cells.resize(n);
    return cells;
}

DrawPattern read_pattern(const Element& e, const AttributeReader& read)
{
    DrawPattern pattern;
    pattern.size = counts(read.child(e, "size"), 1, read);
    if (const Element* c = e.find_child("scale")) pattern.scale = counts(*c, 1, read);
    if (const Element* c = e.find_child("border")) pattern.border = counts(*c, 0, read);
    if (const Element* c = e.find_child("gap")) pattern.gap = counts(*c, 0, read);
    for (std::size_t axis = 0; axis < 3; ++axis)
    {
        const std::uint64_t extent =
            std::uint64_t{pattern.size[axis]} * pattern.scale[axis] + pattern.border[axis];
        if (extent > max_extent)
            read.fail(e, fmt::format("the pattern has {} nodes along {}, more than {}", extent,
                                     "xyz"[axis], max_extent));
        if (pattern.gap[axis] >= extent)
            read.fail(*e.find_child("gap"),
                      fmt::format("{}=\"{}\" is invalid, expected less than the {} nodes of the "
                                  "pattern",
                                  "xyz"[axis], pattern.gap[axis], extent));
    }
    const std::uint64_t n = std::uint64_t{pattern.size[0]} * pattern.size[1] * pattern.size[2];
    pattern.cells = cells_of(e, n, read);
    return pattern;
}

} // namespace

PatternTable read_patterns(const Element& patterns, const AttributeReader& read)
{
    PatternTable out;
    for (const Element& e : patterns.children)
    {
        if (e.kind != Element::Kind::Tag || e.name.starts_with('_')) continue;
        if (e.name != "pattern") read.fail_unknown_element(e, "patterns", {"pattern"});
        const std::string& name = read.text(e, "name");
        if (!out.emplace(lower_case(name), std::make_shared<DrawPattern>(read_pattern(e, read)))
                 .second)
            read.fail(e, fmt::format("there is another pattern named '{}', with or without "
                                     "capitals",
                                     name));
    }
    return out;
}

} // namespace fppg
