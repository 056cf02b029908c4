#include "files/case_motion.h"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <map>
#include <set>

namespace fppg
{

namespace
{

using RefOfMkbound = std::map<int, int>;

bool is_object(const Element& element)
{
    return element.name == "obj" || element.name == "objreal";
}

int number_of(const Element& element, std::string_view attribute, int otherwise)
{
    const std::string* text = element.find_attribute(attribute);
    return text ? std::atoi(text->c_str()) : otherwise;
}

/// The movements that start, by `<begin>` or after another one.
std::set<int> reached_movements(const Element& object)
{
    std::map<int, int> next_of;
    std::vector<int> open;
    for (const Element& child : object.children)
    {
        if (child.kind == Element::Kind::Comment || is_object(child)) continue;
        if (child.name == "begin")
            open.push_back(number_of(child, "mov", 0));
        else
            next_of[number_of(child, "id", 0)] = number_of(child, "next", 0);
    }
    std::set<int> reached;
    while (!open.empty())
    {
        const int id = open.back();
        open.pop_back();
        const auto found = next_of.find(id);
        if (found == next_of.end() || !reached.insert(id).second) continue;
        open.push_back(found->second);
    }
    return reached;
}

/// Places of the children of a movement; velocities stand before accelerations only in mvrectace.
int place_of(const std::string& movement, const std::string& child)
{
    static const std::map<std::string, int, std::less<>> places{
        {"file", 0},   {"freq", 0},       {"vel", 0},       {"ampl", 1},   {"ace", 1},
        {"phase", 2},  {"velini", 2},     {"ref", 3},       {"axisp1", 4}, {"axisp2", 5},
        {"center", 6}, {"movecenter", 7}, {"intrinsic", 8}, {"axes", 9}};
    if (movement == "mvrectace" && child == "velini") return 0;
    const auto found = places.find(child);
    return found == places.end() ? 10 : found->second;
}

std::string units_of(const Element& movement, const Element& value, const std::string& angles)
{
    const bool is_angle = value.find_attribute("ang") != nullptr;
    const std::string length = is_angle ? angles : "m";
    if (value.name == "vel" || value.name == "velini") return length + "/s";
    if (value.name == "ace") return length + "/s^2";
    if (value.name == "freq") return "1/s";
    if (value.name == "ampl") return movement.name == "mvrectsinu" ? "metres (m)" : angles;
    if (value.name == "phase") return angles;
    return "";
}

bool has_angles(const std::string& movement)
{
    return movement.starts_with("mvrot") || movement.starts_with("mvcir") ||
           movement == "mvrectsinu" || movement == "mvpathfile";
}

void without_comment(Element& element)
{
    std::erase_if(element.attributes, [](const Element::Attribute& a)
                  { return a.name == "comment" || a.name == "units_comment"; });
}

/// The attributes that every movement has come first.
void order_attributes(Element& movement)
{
    static const std::array<std::string, 4> first{"id", "duration", "next", "anglesunits"};
    const auto place = [](const Element::Attribute& a)
    { return std::find(first.begin(), first.end(), a.name) - first.begin(); };
    std::stable_sort(movement.attributes.begin(), movement.attributes.end(),
                     [&](const Element::Attribute& a, const Element::Attribute& b)
                     { return place(a) < place(b); });
}

Element case_movement(const Element& movement)
{
    Element out = movement;
    without_comment(out);
    if (out.name == "mvpredef" || out.name == "mvfile") out.name = "mvrectfile";
    if (!has_angles(out.name))
        std::erase_if(out.attributes,
                      [](const Element::Attribute& a) { return a.name == "anglesunits"; });
    else if (!out.find_attribute("anglesunits"))
        out.set_attribute("anglesunits", "degrees");
    order_attributes(out);
    const std::string* angles = out.find_attribute("anglesunits");
    std::erase_if(out.children, [](const Element& c) { return c.kind == Element::Kind::Comment; });
    for (Element& child : out.children)
    {
        without_comment(child);
        const std::string units = units_of(out, child, angles ? *angles : "degrees");
        if (!units.empty()) child.set_attribute("units_comment", units);
    }
    std::stable_sort(out.children.begin(), out.children.end(),
                     [&](const Element& a, const Element& b)
                     { return place_of(out.name, a.name) < place_of(out.name, b.name); });
    return out;
}

/// Appends the object to `out` if it moves particles, itself or by an object inside.
void add_object(const Element& object, const RefOfMkbound& refs, std::vector<Element>& out)
{
    const auto ref =
        object.name == "objreal" ? refs.find(number_of(object, "ref", -1)) : refs.end();
    Element copy;
    copy.name = ref == refs.end() ? "obj" : "objreal";
    if (ref != refs.end()) copy.set_attribute("ref", std::to_string(ref->second));
    bool moves_particles = ref != refs.end();
    const std::set<int> reached = reached_movements(object);
    for (const Element& child : object.children)
    {
        if (child.kind == Element::Kind::Comment) continue;
        if (is_object(child))
        {
            const std::size_t before = copy.children.size();
            add_object(child, refs, copy.children);
            moves_particles = moves_particles || copy.children.size() > before;
        }
        else if (child.name == "begin")
        {
            copy.children.push_back(child);
            without_comment(copy.children.back());
        }
        else if (reached.contains(number_of(child, "id", 0)))
            copy.children.push_back(case_movement(child));
    }
    if (moves_particles) out.push_back(std::move(copy));
}

} // namespace

Element case_motion(const Element& motion, const std::vector<ParticleBlock>& blocks)
{
    RefOfMkbound refs;
    for (const ParticleBlock& block : blocks)
        if (block.type == ParticleType::Moving) refs[block.mk_type] = block.ref_motion;
    Element out;
    out.name = "motion";
    for (const Element& child : motion.children)
        if (child.kind == Element::Kind::Tag && is_object(child))
            add_object(child, refs, out.children);
    return out;
}

} // namespace fppg
