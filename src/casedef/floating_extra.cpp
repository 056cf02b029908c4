#include "casedef/floating_extra.h"

#include "core/text.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <limits>

namespace fppg
{
namespace
{

constexpr std::array<const char*, 3> axes{"x", "y", "z"};

Element named(const std::string& name)
{
    Element out;
    out.name = name;
    return out;
}

/// 0 or 1 for each axis; nothing where all are free.
std::optional<Element> degrees_of_freedom(const Element& given, const AttributeReader& read)
{
    Element out = named(given.name);
    bool restricts = false;
    for (const char* axis : axes)
    {
        constexpr int largest = std::numeric_limits<int>::max();
        const bool is_free = read.integer(given, axis, -largest, largest, true) != 0;
        restricts = restricts || !is_free;
        out.set_attribute(axis, is_free ? "1" : "0");
    }
    return restricts ? std::optional(std::move(out)) : std::nullopt;
}

std::optional<Element> start_velocity(const Element& given, const AttributeReader& read)
{
    Element out = named(given.name);
    const Vec3 v = read.vec3(given);
    for (int axis = 0; axis < 3; ++axis)
        out.set_attribute(axes[static_cast<std::size_t>(axis)], fmt::format("{}", v[axis]));
    return v == Vec3{} ? std::nullopt : std::optional(std::move(out));
}

bool is_none(std::string_view text)
{
    return lower_case(text) == "none";
}

Element table_row(const Element& given, const AttributeReader& read, bool may_leave_out)
{
    Element out = named(given.name);
    out.set_attribute("time", fmt::format("{}", read.number(given, "time")));
    for (const char* axis : axes)
        out.set_attribute(axis, may_leave_out && is_none(read.text_or(given, axis, "none"))
                                    ? "none"
                                    : fmt::format("{}", read.number(given, axis)));
    return out;
}

/// Axes on which no row has a number.
void remove_free_axes(std::vector<Element>& rows)
{
    for (const std::string axis : axes)
        if (std::all_of(rows.begin(), rows.end(),
                        [&](const Element& row) { return *row.find_attribute(axis) == "none"; }))
            for (Element& row : rows)
                std::erase_if(row.attributes,
                              [&](const Element::Attribute& a) { return a.name == axis; });
}

Element table_with_rows(const Element& given, const AttributeReader& read,
                        std::vector<std::string>& warnings)
{
    Element out = named(given.name);
    const std::string file = read.text_or(given, "file", "");
    const bool is_velocity = given.name.ends_with("vel");
    const char* row = is_velocity ? "vel" : "force";
    if (!file.empty()) out.set_attribute("file", file);
    for (const Element& c : given.children)
    {
        if (c.kind != Element::Kind::Tag || c.name.starts_with('_')) continue;
        if (file.empty() && c.name == row)
            out.children.push_back(table_row(c, read, is_velocity));
        else
            warnings.push_back(fmt::format(
                "{}:{}: <{}> in <{}> has no effect, expected {}", read.file(), c.line, c.name,
                given.name, file.empty() ? fmt::format("<{}>", row) : "none beside a file"));
    }
    remove_free_axes(out.children);
    return out;
}

} // namespace

std::optional<Element> floating_extra(const Element& given, const AttributeReader& read,
                                      std::vector<std::string>& warnings)
{
    const std::string& name = given.name;
    if (name == "translationDOF" || name == "rotationDOF") return degrees_of_freedom(given, read);
    if (name == "linearvelini" || name == "angularvelini") return start_velocity(given, read);
    if (name == "linearvel" || name == "angularvel" || name == "linearforce" ||
        name == "angularforce")
        return table_with_rows(given, read, warnings);
    read.fail_unknown_element(given, "floating",
                              {"massbody", "masspart", "center", "inertia", "inertiafull",
                               "translationDOF", "rotationDOF", "linearvelini", "angularvelini",
                               "linearvel", "angularvel", "linearforce", "angularforce"});
}

} // namespace fppg
