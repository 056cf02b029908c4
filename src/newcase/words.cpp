#include "newcase/words.h"

#include "core/finite_number.h"
#include "core/nearest_word.h"
#include "core/text.h"
#include "fppg/error.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string_view>

namespace fppg
{

std::size_t part_named(const CasePlan& plan, const std::string& name, const std::string& option)
{
    for (std::size_t i = 0; i < plan.parts.size(); ++i)
        if (lower_case(plan.parts[i].name) == lower_case(name)) return i;
    std::vector<std::string_view> names;
    for (const NewPart& part : plan.parts) names.emplace_back(part.name);
    throw UsageError(fmt::format("{}: there is no part \"{}\"{}; the parts are {}", option, name,
                                 did_you_mean(name, names), fmt::join(names, ", ")));
}

std::string short_number(double value, int digits)
{
    const double rounded = round_nearest(value, digits);
    return fmt::format("{:.10g}", rounded == 0 ? 0 : rounded);
}

std::string place_text(const Vec3& p)
{
    // What is rounding beside the others is 0.
    const auto text = [least = 1e-9 * norm(p)](double v)
    { return short_number(std::abs(v) < least ? 0 : v); };
    return fmt::format("({}, {}, {}) m", text(p.x), text(p.y), text(p.z));
}

double round_nearest(double value, int digits)
{
    if (!(std::abs(value) > 0) || !std::isfinite(value)) return value;
    return *finite_number(fmt::format("{:.{}e}", value, digits - 1));
}

double round_up(double value, int digits)
{
    const double near = round_nearest(value, digits);
    if (!(value > 0) || near >= value) return near;
    const double step = std::pow(10, std::floor(std::log10(value)) - digits + 1);
    return round_nearest(near + step, digits);
}

Quantity split_quantity(const std::string& text, const std::string& option,
                        const std::string& expected)
{
    std::size_t end = text.find_first_not_of("+-.0123456789eE");
    // An e that begins a unit is none of the number.
    while (end != 0 && end != std::string::npos && (text[end - 1] == 'e' || text[end - 1] == 'E'))
        --end;
    const std::optional<double> number = finite_signed_number(text.substr(0, end));
    if (!number)
        throw UsageError(fmt::format("{}: \"{}\" is no number with a unit, expected {}", option,
                                     text, expected));
    return {*number, end == std::string::npos ? std::string() : text.substr(end)};
}

std::vector<std::string> names_of_list(const std::string& text)
{
    std::vector<std::string> out;
    for (const std::string_view name : split(text, ',')) out.emplace_back(trimmed(name));
    return out;
}

Vec3 vector_of(const std::string& text, const std::string& option)
{
    const std::vector<std::string_view> parts = split(text, ',');
    Vec3 out;
    bool is_right = parts.size() == 3;
    for (int axis = 0; axis < 3 && is_right; ++axis)
    {
        const std::optional<double> number =
            finite_signed_number(trimmed(parts[static_cast<std::size_t>(axis)]));
        is_right = number.has_value();
        if (number) out[axis] = *number;
    }
    if (!is_right)
        throw UsageError(fmt::format("{}: \"{}\" is invalid, expected three numbers such as 0,1,0",
                                     option, text));
    return out;
}

bool has_word(const std::string& name, std::initializer_list<const char*> words)
{
    const std::string small = lower_case(name);
    return std::any_of(words.begin(), words.end(),
                       [&](const char* word) { return small.find(word) != std::string::npos; });
}

std::string axis_text(const AxisLine& axis)
{
    for (int a = 0; a < 3; ++a)
        if (axis.direction[a] == 1)
            return fmt::format("{} through {}", "xyz"[a], place_text(axis.point));
    return fmt::format("({}, {}, {}) through {}", short_number(axis.direction.x),
                       short_number(axis.direction.y), short_number(axis.direction.z),
                       place_text(axis.point));
}

} // namespace fppg
