#include "casedef/attributes.h"

#include "fppg/error.h"

#include "casedef/expression.h"
#include "core/nearest_word.h"
#include "core/text.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>

namespace fppg
{
namespace
{

/// Parts between separators, blanks dropped; an empty text has none.
std::vector<std::string_view> trimmed_parts(std::string_view text, char separator)
{
    if (trimmed(text).empty()) return {};
    std::vector<std::string_view> parts = split(text, separator);
    for (std::string_view& part : parts) part = trimmed(part);
    return parts;
}

std::string list_of(const std::vector<std::string_view>& known)
{
    return known.empty() ? std::string("none") : fmt::format("{}", fmt::join(known, ", "));
}

/// "; it has fiel: did you mean file?" of what is there in the place of a missing name.
std::string meant_by(std::string_view missing, const std::vector<std::string_view>& there)
{
    const std::string_view nearest = nearest_word(missing, there);
    return nearest.empty() ? std::string()
                           : fmt::format("; it has {}, did you mean {}?", nearest, missing);
}

} // namespace

std::optional<long long> whole_number(std::string_view text)
{
    text = trimmed(text);
    if (text.empty()) return 0;
    if (text[0] == '+') text.remove_prefix(1);
    long long value = 0;
    const char* last = text.data() + text.size();
    const auto [end, error] = std::from_chars(text.data(), last, value);
    const std::string_view rest(end, static_cast<std::size_t>(last - end));
    const bool is_whole = rest.empty() || (rest[0] == '.' && rest.find_first_not_of('0', 1) ==
                                                                 std::string_view::npos);
    return error == std::errc() && is_whole ? std::optional(value) : std::nullopt;
}

unsigned sum_of_words(const std::string& list,
                      const std::function<unsigned(const std::string&)>& bits_of)
{
    unsigned bits = 0;
    if (trimmed(list).empty()) return bits;
    for (std::size_t begin = 0; begin <= list.size();)
    {
        const std::size_t end = std::min(list.find_first_of("|^", begin), list.size());
        const unsigned word =
            bits_of(std::string(trimmed(std::string_view(list).substr(begin, end - begin))));
        const bool is_exclusive = begin > 0 && list[begin - 1] == '^';
        bits = is_exclusive ? bits ^ word : bits | word;
        begin = end + 1;
    }
    return bits;
}

void AttributeReader::fail(const Element& e, const std::string& text) const
{
    throw CaseError(file_, e.line, fmt::format("<{}>: {}", e.name, text));
}

void AttributeReader::fail_unknown_element(const Element& e, std::string_view parent,
                                           const std::vector<std::string_view>& known) const
{
    fail(e, fmt::format("is not known in <{}>{}, expected {}", parent, did_you_mean(e.name, known),
                        list_of(known)));
}

void AttributeReader::fail_unknown_attribute(const Element& e, const Element::Attribute& a,
                                             const std::vector<std::string_view>& known) const
{
    fail(e, fmt::format("attribute {}=\"{}\" is not known{}, expected {}", a.name, a.value,
                        did_you_mean(a.name, known), list_of(known)));
}

void AttributeReader::fail_unsupported(const Element& e, const std::string& what) const
{
    fail(e, what.empty() ? "not supported yet" : what + " is not supported yet");
}

const std::string& AttributeReader::raw_text(const Element& e, std::string_view name) const
{
    const std::string* value = e.find_attribute(name);
    if (value != nullptr) return *value;
    std::vector<std::string_view> there;
    for (const Element::Attribute& a : e.attributes) there.push_back(a.name);
    // A coordinate is near every other.
    fail(e, fmt::format("attribute '{}' is missing{}", name,
                        name.size() > 1 ? meant_by(name, there) : ""));
}

std::string AttributeReader::text(const Element& e, std::string_view name) const
{
    const std::string& value = raw_text(e, name);
    return value.starts_with('$') ? interpolated(e, value.substr(1)) : value;
}

std::string AttributeReader::text_or(const Element& e, std::string_view name,
                                     const std::string& otherwise) const
{
    return e.find_attribute(name) == nullptr ? otherwise : text(e, name);
}

std::string AttributeReader::evaluated(const Element& e, std::string_view name) const
{
    const bool is_number = raw_text(e, name).starts_with('#');
    return is_number ? fmt::format("{}", number(e, name)) : text(e, name);
}

double AttributeReader::number(const Element& e, std::string_view name) const
{
    const std::string& value = raw_text(e, name);
    if (trimmed(value).empty()) return 0; // as GenCase v5.4 reads x=""
    try
    {
        const double v = parse_number(value, *variables_);
        if (std::isfinite(v)) return v;
    }
    catch (const ExpressionError& error)
    {
        fail(e, fmt::format("attribute {}=\"{}\": {}", name, value, error.what()));
    }
    fail(e, fmt::format("attribute {}=\"{}\" is not a valid real number, expected a finite number "
                        "or #expression",
                        name, value));
}

double AttributeReader::number_or(const Element& e, std::string_view name, double otherwise) const
{
    return e.find_attribute(name) == nullptr ? otherwise : number(e, name);
}

std::optional<double> AttributeReader::number_if(const Element& e, std::string_view name) const
{
    if (e.find_attribute(name) == nullptr) return std::nullopt;
    return number(e, name);
}

int AttributeReader::integer(const Element& e, std::string_view name, int min, int max,
                             bool may_be_expression) const
{
    const std::string value(trimmed(raw_text(e, name)));
    if (may_be_expression && !value.empty() && value[0] == '#')
    {
        const double v = number(e, name);
        if (!(v >= min && v <= max))
            fail(e, fmt::format("attribute {}=\"{}\" is {:g}, expected {} to {}", name, value, v,
                                min, max));
        return static_cast<int>(v);
    }
    const std::optional<long long> result = whole_number(value);
    if (!result)
        fail(e, fmt::format("attribute {}=\"{}\" is not a valid integer number, expected {} to {}",
                            name, value, min, max));
    if (*result < min || *result > max)
        fail(e, fmt::format("attribute {}=\"{}\" is out of range, expected {} to {}", name, value,
                            min, max));
    return static_cast<int>(*result);
}

bool AttributeReader::plain_flag_or(const Element& e, std::string_view name, bool otherwise) const
{
    const std::string* value = e.find_attribute(name);
    if (value == nullptr) return otherwise;
    const std::string lower = lower_case(trimmed(*value));
    if (lower == "true" || lower == "1") return true;
    if (lower == "false" || lower == "0") return false;
    fail(e, fmt::format("attribute {}=\"{}\" is not a valid boolean, expected true or false", name,
                        *value));
}

bool AttributeReader::flag_or(const Element& e, std::string_view name, bool otherwise) const
{
    const std::string* value = e.find_attribute(name);
    if (value != nullptr && value->starts_with('#')) return number(e, name) != 0;
    return plain_flag_or(e, name, otherwise);
}

Vec3 AttributeReader::vec3(const Element& e) const
{
    return {number(e, "x"), number(e, "y"), number(e, "z")};
}

Vec3 AttributeReader::vec3_or(const Element& e, const Vec3& otherwise) const
{
    return {number_or(e, "x", otherwise.x), number_or(e, "y", otherwise.y),
            number_or(e, "z", otherwise.z)};
}

const Element& AttributeReader::child(const Element& e, std::string_view name) const
{
    const Element* c = e.find_child(name);
    if (c != nullptr) return *c;
    std::vector<std::string_view> there;
    for (const Element& other : e.children)
        if (other.kind == Element::Kind::Tag) there.push_back(other.name);
    fail(e, fmt::format("the element <{}> is missing in it{}", name, meant_by(name, there)));
}

std::vector<Vec3> AttributeReader::points(const Element& e) const
{
    std::vector<Vec3> out;
    for (const Element& c : e.children)
        if (c.kind == Element::Kind::Tag && c.name == "point") out.push_back(vec3(c));
    return out;
}

unsigned AttributeReader::word_bits(const Element& e, const std::string& list, const char* what,
                                    const std::vector<Word>& known) const
{
    return sum_of_words(
        list,
        [&](const std::string& name)
        {
            const auto word = std::find_if(known.begin(), known.end(),
                                           [&](const Word& w) { return w.name == name; });
            if (word != known.end()) return word->bits;
            std::vector<std::string_view> names;
            for (const Word& w : known) names.push_back(w.name);
            fail(e, fmt::format("{} \"{}\" is invalid, expected {}, joined by | or, to take one "
                                "away, by ^",
                                what, name, fmt::join(names, ", ")));
        });
}

std::vector<std::uint16_t> AttributeReader::number_list(const Element& e,
                                                        std::string_view name) const
{
    std::vector<std::uint16_t> out;
    const std::string list = text(e, name);
    if (list.starts_with('#') && list.find_first_of(",-") == std::string::npos)
        return {static_cast<std::uint16_t>(integer(e, name, 0, 65000, true))};
    const auto wrong = [&]
    {
        fail(e,
             fmt::format(
                 "attribute {}=\"{}\" is not a list of whole numbers, expected one like \"1-3,5\"",
                 name, list));
    };
    const auto whole = [&](std::string_view part)
    {
        const std::optional<long long> value = whole_number(part);
        if (part.empty() || !value || *value < 0 || *value > 65000) wrong();
        return static_cast<unsigned>(*value);
    };
    for (const std::string_view part : trimmed_parts(list, ','))
    {
        const std::vector<std::string_view> limits = trimmed_parts(part, '-');
        if (limits.empty() || limits.size() > 2) wrong();
        const unsigned first = whole(limits.front());
        const unsigned last = whole(limits.back());
        if (last < first) wrong();
        for (unsigned v = first; v <= last; ++v) out.push_back(static_cast<std::uint16_t>(v));
    }
    if (out.empty()) wrong();
    return out;
}

std::string AttributeReader::interpolated(const Element& e, const std::string& source) const
{
    try
    {
        return variables_->interpolate(source);
    }
    catch (const ExpressionError& error)
    {
        fail(e, fmt::format("text \"{}\": {}", source, error.what()));
    }
}

bool AttributeReader::is_active(const Element& e) const
{
    const std::string* condition = e.find_attribute("if");
    if (condition == nullptr) return true;
    try
    {
        return evaluate_condition(*condition, *variables_);
    }
    catch (const ExpressionError& error)
    {
        fail(e, fmt::format("attribute if=\"{}\": {}", *condition, error.what()));
    }
}

} // namespace fppg
