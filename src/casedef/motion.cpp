#include "casedef/motion.h"

#include "fppg/moving_parts.h"

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
};

const std::vector<Movement>& movements()
{
    using Attributes = std::vector<std::string_view>;
    static const Attributes xyz{"x", "y", "z"};
    static const Attributes ang{"ang"};
    static const Attributes v{"v"};
    static const Attributes name{"name"};
    static const Attributes columns{"name", "fields", "fieldtime"};
    static const std::vector<Movement> all{
        {"wait", {}},
        {"mvnull", {}},
        {"mvrect", {{"vel", xyz}}},
        {"mvrectace", {{"ace", xyz}}},
        {"mvrot", {{"vel", ang}, {"axisp1", xyz}, {"axisp2", xyz}}},
        {"mvrotace", {{"ace", ang}, {"axisp1", xyz}, {"axisp2", xyz}}},
        {"mvcir", {{"vel", ang}, {"ref", xyz}, {"axisp1", xyz}, {"axisp2", xyz}}},
        {"mvcirace", {{"ace", ang}, {"ref", xyz}, {"axisp1", xyz}, {"axisp2", xyz}}},
        {"mvrectsinu", {{"freq", xyz}, {"ampl", xyz}}},
        {"mvrotsinu", {{"freq", v}, {"ampl", v}, {"axisp1", xyz}, {"axisp2", xyz}}},
        {"mvcirsinu", {{"freq", v}, {"ampl", v}, {"ref", xyz}, {"axisp1", xyz}, {"axisp2", xyz}}},
        {"mvrectfile", {{"file", columns}}},
        {"mvfile", {{"file", columns}}},
        {"mvpredef", {{"file", columns}}},
        {"mvrotfile", {{"file", name}, {"axisp1", xyz}, {"axisp2", xyz}}},
        {"mvrotadvfile", {{"file", name}, {"center", xyz}}},
        {"mvpathfile", {{"file", name}, {"center", xyz}}}};
    return all;
}

/// mvnull leaves the object to what else moves it: GenCase reads its id alone, and writes no other
/// attribute.
bool is_null(const Element& movement)
{
    return movement.name == "mvnull";
}

void check_movement(Element& e, const Movement& movement, const AttributeReader& read)
{
    for (const auto& [child, attributes] : movement.needs)
    {
        const Element& c = read.child(e, child);
        for (const std::string_view a : attributes)
            if (a == "name")
                read.text(c, a);
            else
                read.number(c, a);
        if (std::find(attributes.begin(), attributes.end(), "fieldtime") != attributes.end() &&
            c.find_attribute("fieldx") == nullptr && c.find_attribute("fieldy") == nullptr &&
            c.find_attribute("fieldz") == nullptr)
            read.fail(c, "needs at least one of the attributes fieldx, fieldy and fieldz");
    }
    if (is_null(e)) return;
    read.number(e, "duration");
    const std::string units = read.text_or(e, "anglesunits", "degrees");
    if (units != "degrees" && units != "radians")
        read.fail(e, fmt::format("attribute anglesunits=\"{}\" is invalid, expected degrees or "
                                 "radians",
                                 units));
    for (const char* name : {"movecenter", "intrinsic"})
        if (Element* flag = e.find_child(name); flag != nullptr && flag->find_attribute("value"))
            flag->set_attribute("value", read.flag_or(*flag, "value", false) ? "true" : "false");
}

constexpr int largest = 1'000'000'000;

/// A whole number, which then stands in the element without a sign or zeros behind a point.
int take_number(Element& e, const char* name, int min, int max, const AttributeReader& read,
                bool may_be_expression = false)
{
    const int value = read.integer(e, name, min, max, may_be_expression);
    e.set_attribute(name, std::to_string(value));
    return value;
}

std::vector<std::string_view> names_in_motion()
{
    std::vector<std::string_view> names{"objreal", "obj", "begin"};
    for (const Movement& m : movements()) names.push_back(m.name);
    return names;
}

/// An object (or `<motion>` itself) and those in it. `references` holds those seen.
void check(Element& e, const AttributeReader& read, std::set<int>& references)
{
    std::set<int> ids;
    for (Element& c : e.children)
    {
        if (c.name == "objreal" || c.name == "obj")
        {
            if (c.name == "objreal")
            {
                const int ref = take_number(c, "ref", 0, 65000, read, true);
                if (!references.insert(ref).second)
                    read.fail(c, fmt::format("ref=\"{}\" has a motion already, expected each "
                                             "mkbound once",
                                             ref));
            }
            check(c, read, references);
        }
        else if (c.name == "begin")
        {
            take_number(c, "mov", 0, largest, read);
            read.number(c, "start");
        }
        else
        {
            const auto found = std::find_if(movements().begin(), movements().end(),
                                            [&](const Movement& m) { return m.name == c.name; });
            if (found == movements().end())
                read.fail_unknown_element(c, "motion", names_in_motion());
            const int id = take_number(c, "id", -largest, largest, read);
            if (id == 0) read.fail(c, "id=\"0\" is invalid, expected 1 or more");
            if (is_null(c))
                std::erase_if(c.attributes,
                              [](const Element::Attribute& a) { return a.name != "id"; });
            if (!ids.insert(id).second)
                read.fail(c, fmt::format("id=\"{}\" is given twice in this object, expected "
                                         "different numbers",
                                         id));
            check_movement(c, *found, read);
        }
    }
    for (Element& c : e.children)
    {
        const char* name = c.name == "begin" ? "mov" : "next";
        if (c.name == "objreal" || c.name == "obj" || c.find_attribute(name) == nullptr) continue;
        const int id = take_number(c, name, -largest, largest, read);
        if (!ids.contains(id) && (c.name == "begin" || id != 0))
            read.fail(c, fmt::format("{}=\"{}\" names no movement of this object", name, id));
    }
}

bool never_turns(const Element& object)
{
    static const std::set<std::string_view> straight{"mvrect",     "mvrectace", "mvrectsinu",
                                                     "mvrectfile", "mvfile",    "mvpredef"};
    return std::all_of(object.children.begin(), object.children.end(),
                       [](const Element& m)
                       { return !m.name.starts_with("mv") || straight.contains(m.name); });
}

/// Adds the mkbound of objects that move, on their own or with those around them.
///
/// is_taken  whether an object counts; others are left out with all in them
template <typename IsTaken>
void collect_moving(const Element& e, bool is_moved, const IsTaken& is_taken, std::set<int>& out)
{
    for (const Element& c : e.children)
    {
        if ((c.name != "objreal" && c.name != "obj") || !is_taken(c)) continue;
        const bool moves = is_moved || c.find_child("begin") != nullptr;
        if (c.name == "objreal" && moves)
            if (const std::string* ref = c.find_attribute("ref")) out.insert(std::stoi(*ref));
        collect_moving(c, moves, is_taken, out);
    }
}

} // namespace

Element evaluated_element(const Element& source, const AttributeReader& read)
{
    Element out;
    out.name = source.name;
    out.line = source.line;
    for (const Element::Attribute& a : source.attributes)
        out.attributes.push_back({a.name, read.evaluated(source, a.name)});
    for (const Element& c : source.children)
        if (c.kind == Element::Kind::Tag && !c.name.starts_with('_'))
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

std::set<int> moving_mkbound(const Element& motion)
{
    std::set<int> out;
    collect_moving(
        motion, false, [](const Element&) { return true; }, out);
    return out;
}

std::set<std::uint16_t> floating_mks(const CaseDef& def)
{
    std::set<std::uint16_t> out;
    for (const FloatingDef& floating : def.floatings)
        for (const int mkbound : floating.mkbound)
            out.insert(static_cast<std::uint16_t>(mkbound + def.mk_bound_first));
    return out;
}

std::set<std::uint16_t> mks_that_move(const CaseDef& def)
{
    std::set<std::uint16_t> out = floating_mks(def);
    for (const int mkbound : moving_mkbound(def.motion))
        out.insert(static_cast<std::uint16_t>(mkbound + def.mk_bound_first));
    return out;
}

std::set<std::uint16_t> mks_that_slide(const CaseDef& def)
{
    std::set<int> found;
    collect_moving(def.motion, false, never_turns, found);
    std::set<std::uint16_t> out;
    for (const int mkbound : found)
        out.insert(static_cast<std::uint16_t>(mkbound + def.mk_bound_first));
    return out;
}

bool floats(const CaseDef& def, std::uint16_t mk)
{
    const int mkbound = mk - def.mk_bound_first;
    return std::any_of(def.floatings.begin(), def.floatings.end(),
                       [&](const FloatingDef& floating)
                       {
                           const std::vector<std::uint16_t>& mks = floating.mkbound;
                           return std::find(mks.begin(), mks.end(), mkbound) != mks.end();
                       });
}

} // namespace fppg
