#include "casedef/motion.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <string_view>
#include <utility>
#include <vector>

namespace fppg
{
namespace
{

/// What a movement needs, found by leaving it out (GenCase v5.4.354): names of children, each with
/// the attributes that it must have.
struct Movement
{
    std::string_view name;
    std::vector<std::pair<std::string_view, std::vector<std::string_view>>> needs;
    bool has_angles = false;
};

const std::vector<Movement>& movements()
{
    using Names = std::vector<std::string_view>;
    static const Names xyz{"x", "y", "z"};
    static const Names ang{"ang"};
    static const Names v{"v"};
    static const Names name{"name"};
    static const std::vector<Movement> all{
        {"wait", {}, false},
        {"mvrect", {{"vel", xyz}}, false},
        {"mvrectace", {{"ace", xyz}}, false},
        {"mvrot", {{"vel", ang}, {"axisp1", xyz}, {"axisp2", xyz}}, true},
        {"mvrotace", {{"ace", ang}, {"axisp1", xyz}, {"axisp2", xyz}}, true},
        {"mvcir", {{"vel", ang}, {"ref", xyz}, {"axisp1", xyz}, {"axisp2", xyz}}, true},
        {"mvcirace", {{"ace", ang}, {"ref", xyz}, {"axisp1", xyz}, {"axisp2", xyz}}, true},
        {"mvrectsinu", {{"freq", xyz}, {"ampl", xyz}}, true},
        {"mvrotsinu", {{"freq", v}, {"ampl", v}, {"axisp1", xyz}, {"axisp2", xyz}}, true},
        {"mvcirsinu",
         {{"freq", v}, {"ampl", v}, {"ref", xyz}, {"axisp1", xyz}, {"axisp2", xyz}},
         true},
        {"mvrectfile", {{"file", name}}, false},
        {"mvrotfile", {{"file", name}, {"axisp1", xyz}, {"axisp2", xyz}}, true},
        {"mvrotadvfile", {{"file", name}}, true},
        {"mvpathfile", {{"file", name}}, true},
        {"mvpredef", {{"file", name}}, true}};
    return all;
}

void check_movement(const Element& e, const Movement& movement, const AttributeReader& read)
{
    for (const auto& [child, attributes] : movement.needs)
    {
        const Element& c = read.child(e, child);
        for (const std::string_view a : attributes)
            if (a == "name")
                read.text(c, a);
            else
                read.number(c, a);
    }
    read.number(e, "duration");
    if (!movement.has_angles) return;
    const std::string units = read.text_or(e, "anglesunits", "degrees");
    if (units != "degrees" && units != "radians")
        read.fail(e, fmt::format("attribute anglesunits=\"{}\" is invalid, expected degrees or "
                                 "radians",
                                 units));
}

constexpr int largest = 1'000'000'000;

/// An object (or `<motion>` itself) and those in it. `references` holds those seen.
void check(const Element& e, const AttributeReader& read, std::set<int>& references)
{
    std::set<int> ids;
    for (const Element& c : e.children)
    {
        if (c.name == "objreal" || c.name == "obj")
        {
            if (c.name == "objreal")
            {
                const int ref = read.integer(c, "ref", 0, 65000, true);
                if (!references.insert(ref).second)
                    read.fail(c, fmt::format("ref=\"{}\" has a motion already, expected each "
                                             "mkbound once",
                                             ref));
            }
            check(c, read, references);
        }
        else if (c.name == "begin")
        {
            read.integer(c, "mov", 0, largest, false);
            read.number(c, "start");
        }
        else
        {
            const auto found = std::find_if(movements().begin(), movements().end(),
                                            [&](const Movement& m) { return m.name == c.name; });
            if (found == movements().end()) read.fail(c, "is not known in <motion>");
            const int id = read.integer(c, "id", -largest, largest, false);
            if (!ids.insert(id).second)
                read.fail(c, fmt::format("id=\"{}\" is given twice in this object, expected "
                                         "different numbers",
                                         id));
            check_movement(c, *found, read);
        }
    }
    const bool is_moved = std::any_of(e.children.begin(), e.children.end(),
                                      [](const Element& c) { return c.name == "begin"; });
    if (!is_moved) return; // its movements are never looked at
    for (const Element& c : e.children)
    {
        const char* name = c.name == "begin" ? "mov" : "next";
        if (c.name == "objreal" || c.name == "obj" || c.find_attribute(name) == nullptr) continue;
        const int id = read.integer(c, name, -largest, largest, false);
        if (!ids.contains(id) && (c.name == "begin" || id > 0))
            read.fail(c, fmt::format("{}=\"{}\" names no movement of this object", name, id));
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
    std::set<int> references;
    check(out, read, references);
    return out;
}

} // namespace fppg
