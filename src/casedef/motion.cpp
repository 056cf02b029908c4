#include "casedef/motion.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

namespace fppg
{
namespace
{

constexpr auto movements = std::to_array<std::string_view>(
    {"wait", "mvrect", "mvrectace", "mvrot", "mvrotace", "mvcir", "mvcirace", "mvrectsinu",
     "mvrotsinu", "mvcirsinu", "mvrectfile", "mvrotfile", "mvrotadvfile", "mvpathfile",
     "mvpredef"});

void check(const Element& e, const AttributeReader& read)
{
    for (const Element& c : e.children)
    {
        if (c.name == "objreal" || c.name == "obj")
        {
            if (c.name == "objreal") read.integer(c, "ref", 0, 65000, false);
            check(c, read);
        }
        else if (c.name == "begin")
        {
            read.integer(c, "mov", 0, 1'000'000'000, false);
            read.number_or(c, "start", 0);
        }
        else if (std::find(movements.begin(), movements.end(), c.name) == movements.end())
            read.fail(c, "is not known in <motion>");
    }
}

} // namespace

Element evaluated_element(const Element& source, const AttributeReader& read)
{
    Element out;
    out.name = source.name;
    out.line = source.line;
    for (const Element::Attribute& a : source.attributes)
    {
        if (a.name == "if") continue;
        out.attributes.push_back({a.name, a.value.starts_with('#')
                                              ? fmt::format("{}", read.number(source, a.name))
                                              : a.value});
    }
    for (const Element& c : source.children)
        if (c.kind == Element::Kind::Tag && !c.name.starts_with('_') && read.is_active(c))
            out.children.push_back(evaluated_element(c, read));
    return out;
}

Element evaluated_motion(const Element& motion, const AttributeReader& read)
{
    Element out = evaluated_element(motion, read);
    check(out, read);
    return out;
}

} // namespace fppg
