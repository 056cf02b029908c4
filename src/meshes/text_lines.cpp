#include "meshes/text_lines.h"

#include "fppg/error.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <limits>

namespace fppg
{
namespace
{

bool is_blank(char c)
{
    return c == ' ' || c == '\t' || c == '\v' || c == '\f' || c == '\0';
}

bool is_line_end(char c)
{
    return c == '\n' || c == '\r';
}

/// The number that a whole word is; false if it is none.
bool parse(std::string_view word, bool is_float32, double& value)
{
    if (word.size() > 1 && word[0] == '+' && word[1] != '-') word.remove_prefix(1);
    const char* const end = word.data() + word.size();
    const auto [rest, status] = std::from_chars(word.data(), end, value);
    if (rest == word.data() || rest != end) return false;
    if (status == std::errc::result_out_of_range)
    {
        const bool is_tiny =
            word.find("e-") != std::string_view::npos || word.find("E-") != std::string_view::npos;
        value = is_tiny ? 0.0 : std::numeric_limits<double>::infinity();
        return true;
    }
    if (!is_float32) return true;
    float rounded = 0;
    if (std::from_chars(word.data(), end, rounded).ec == std::errc())
        value = static_cast<double>(rounded);
    else // beyond what float32 can hold
        value = std::fabs(value) > 1 ? std::copysign(std::numeric_limits<double>::infinity(), value)
                                     : 0.0;
    return true;
}

} // namespace

std::string shown(std::string_view word)
{
    constexpr std::size_t longest = 40;
    std::string text(word.substr(0, longest));
    if (word.size() > longest) text += "...";
    for (char& c : text)
        if (static_cast<unsigned char>(c) < 0x20 || static_cast<unsigned char>(c) > 0x7e) c = '?';
    return text;
}

std::size_t TextLines::line() const
{
    std::size_t line = 1;
    const std::size_t end = std::min(at_, text_.size());
    for (std::size_t i = 0; i < end; ++i)
        if (text_[i] == '\n' ||
            (text_[i] == '\r' && (i + 1 == text_.size() || text_[i + 1] != '\n')))
            ++line;
    return line;
}

std::string_view TextLines::next_line()
{
    const std::size_t begin = at_;
    while (at_ < text_.size() && !is_line_end(text_[at_])) ++at_;
    const std::string_view found = text_.substr(begin, at_ - begin);
    if (at_ < text_.size() && text_[at_] == '\r') ++at_;
    if (at_ < text_.size() && text_[at_] == '\n') ++at_;
    return found;
}

std::string_view TextLines::next_word_of_line()
{
    while (at_ < text_.size() && is_blank(text_[at_])) ++at_;
    const std::size_t begin = at_;
    while (at_ < text_.size() && !is_blank(text_[at_]) && !is_line_end(text_[at_])) ++at_;
    return text_.substr(begin, at_ - begin);
}

std::string_view TextLines::next_word()
{
    while (at_ < text_.size() && (is_blank(text_[at_]) || is_line_end(text_[at_]))) ++at_;
    return next_word_of_line();
}

std::string_view TextLines::peek_word()
{
    const std::size_t before = at_;
    const std::string_view word = next_word();
    at_ = before;
    return word;
}

double TextLines::number(bool is_float32, const char* of_what)
{
    const std::string_view word = next_word();
    double value = 0;
    if (!parse(word, is_float32, value)) fail_at(word, fmt::format("a number of {}", of_what));
    return value;
}

double TextLines::number_of_line(bool is_float32, const char* of_what)
{
    const std::string_view word = next_word_of_line();
    double value = 0;
    if (!parse(word, is_float32, value)) fail_at(word, fmt::format("a number of {}", of_what));
    return value;
}

std::int64_t TextLines::integer(const char* of_what)
{
    const std::string_view word = next_word();
    std::int64_t value = 0;
    const auto [rest, status] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (word.empty() || status != std::errc() || rest != word.data() + word.size())
        fail_at(word, fmt::format("a whole number of {}", of_what));
    return value;
}

std::int64_t TextLines::integer_of_line(const char* of_what)
{
    const std::size_t before = at_;
    const std::string_view word = next_word_of_line();
    if (word.empty()) fail_at(word, fmt::format("a whole number of {}", of_what));
    at_ = before;
    return integer(of_what);
}

std::uint64_t TextLines::count(const char* of_what)
{
    const std::size_t before = at_;
    const std::int64_t value = integer(of_what);
    if (value < 0)
    {
        at_ = before;
        fail_at(peek_word(), fmt::format("a count of {}, 0 or more", of_what));
    }
    return static_cast<std::uint64_t>(value);
}

void TextLines::fail(const std::string& text) const
{
    throw GeometryError(fmt::format("{}:{}: {}", *path_, line(), text));
}

void TextLines::fail_at(std::string_view word, const std::string& expectation) const
{
    if (!word.empty()) fail(fmt::format("expected {}, found '{}'", expectation, shown(word)));
    fail(fmt::format("expected {}, found the end of the {}", expectation,
                     at_ >= text_.size() ? "file" : "line"));
}

} // namespace fppg
