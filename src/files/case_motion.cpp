#include "files/case_motion.h"

#include <cstdlib>
#include <map>
#include <optional>
#include <set>
#include <string_view>

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

/// An attribute that GenCase keeps; `otherwise` is what it writes where there is none.
struct KeptAttribute
{
    const char* name;
    const char* otherwise = nullptr;
};

struct KeptChild
{
    const char* name;
    std::vector<KeptAttribute> attributes;
    const char* units = ""; ///< ANGLES stands for those of the movement
};

/// What GenCase keeps of a movement, in its order.
const std::vector<KeptChild>& children_of(const std::string& movement)
{
    using Children = std::vector<KeptChild>;
    using Attributes = std::vector<KeptAttribute>;
    const Attributes xyz{{"x"}, {"y"}, {"z"}};
    const Attributes ang{{"ang"}};
    const Attributes v{{"v"}};
    const KeptChild first{"axisp1", xyz};
    const KeptChild second{"axisp2", xyz};
    const KeptChild ref{"ref", xyz};
    const KeptChild center{"center", xyz};
    const KeptChild turn{"vel", ang, "ANGLES/s"};
    const KeptChild turn_ace{"ace", ang, "ANGLES/s^2"};
    const KeptChild turn_ini{"velini", ang, "ANGLES/s"};
    const KeptChild intrinsic{"intrinsic", {{"value", "false"}}};
    const KeptChild axes{"axes", {{"value", "XYZ"}}};
    const auto sinus = [](const Attributes& values, const char* length)
    {
        return Children{
            {"freq", values, "1/s"}, {"ampl", values, length}, {"phase", values, "ANGLES"}};
    };
    const auto with = [](Children children, const Children& more)
    {
        children.insert(children.end(), more.begin(), more.end());
        return children;
    };
    static const std::map<std::string, Children> all{
        {"mvrect", {{"vel", xyz, "m/s"}}},
        {"mvrectace", {{"velini", xyz, "m/s"}, {"ace", xyz, "m/s^2"}}},
        {"mvrot", {turn, first, second}},
        {"mvrotace", {turn_ace, turn_ini, first, second}},
        {"mvcir", {turn, ref, first, second}},
        {"mvcirace", {turn_ace, turn_ini, ref, first, second}},
        {"mvrectsinu", sinus(xyz, "metres (m)")},
        {"mvrotsinu", with(sinus(v, "ANGLES"), {first, second})},
        {"mvcirsinu", with(sinus(v, "ANGLES"), {ref, first, second})},
        {"mvrectfile",
         {{"file", {{"name"}, {"fields"}, {"fieldtime"}, {"fieldx"}, {"fieldy"}, {"fieldz"}}}}},
        {"mvrotfile", {{"file", {{"name"}}}, first, second}},
        {"mvrotadvfile",
         {{"file",
           {{"name"},
            {"fields", "4"},
            {"fieldtime", "0"},
            {"fieldang1", "1"},
            {"fieldang2", "2"},
            {"fieldang3", "3"}}},
          center,
          intrinsic,
          axes}},
        {"mvpathfile",
         {{"file",
           {{"name"},
            {"fields", "7"},
            {"fieldtime", "0"},
            {"fieldx", "1"},
            {"fieldy", "2"},
            {"fieldz", "3"},
            {"fieldang1", "4"},
            {"fieldang2", "5"},
            {"fieldang3", "6"}}},
          center,
          {"movecenter", {{"value", "true"}}},
          intrinsic,
          axes}}};
    static const Children none;
    const auto found = all.find(movement);
    return found == all.end() ? none : found->second;
}

bool has_angles(const std::string& movement)
{
    return movement.starts_with("mvrot") || movement.starts_with("mvcir") ||
           movement == "mvrectsinu" || movement == "mvpathfile";
}

/// Nothing where the definition has none and there is nothing to write in its place.
std::optional<Element> case_child(const KeptChild& kept, const Element* given,
                                  const std::string& angles)
{
    Element out;
    out.name = kept.name;
    for (const KeptAttribute& a : kept.attributes)
    {
        const std::string* value = given != nullptr ? given->find_attribute(a.name) : nullptr;
        const bool is_field = std::string_view(a.name).starts_with("field");
        const bool is_left_out = value == nullptr || (is_field && value->starts_with('-'));
        if (!is_left_out)
            out.set_attribute(a.name, *value);
        else if (a.otherwise != nullptr)
            out.set_attribute(a.name, a.otherwise);
    }
    if (given == nullptr && out.attributes.empty()) return std::nullopt;
    std::string units = kept.units;
    if (units.starts_with("ANGLES")) units.replace(0, 6, angles);
    if (!units.empty()) out.set_attribute("units_comment", units);
    return out;
}

Element case_movement(const Element& movement)
{
    Element out;
    out.name =
        movement.name == "mvpredef" || movement.name == "mvfile" ? "mvrectfile" : movement.name;
    for (const char* name : {"id", "duration", "next"})
        if (const std::string* value = movement.find_attribute(name);
            value != nullptr && (name != std::string_view("next") || *value != "0"))
            out.set_attribute(name, *value);
    const std::string* given = movement.find_attribute("anglesunits");
    const std::string angles = given != nullptr ? *given : "degrees";
    if (has_angles(out.name)) out.set_attribute("anglesunits", angles);
    for (const KeptChild& kept : children_of(out.name))
        if (auto child = case_child(kept, movement.find_child(kept.name), angles))
            out.children.push_back(std::move(*child));
    return out;
}

/// A `<begin>`; an end below 0 is none.
Element case_begin(const Element& begin)
{
    Element out;
    out.name = begin.name;
    for (const char* name : {"mov", "start", "finish"})
        if (const std::string* value = begin.find_attribute(name);
            value != nullptr && (name != std::string_view("finish") || !value->starts_with('-')))
            out.set_attribute(name, *value);
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
    std::vector<Element> movements;
    std::vector<Element> objects;
    for (const Element& child : object.children)
    {
        if (child.kind == Element::Kind::Comment) continue;
        if (is_object(child))
            add_object(child, refs, objects);
        else if (child.name == "begin")
            copy.children.push_back(case_begin(child));
        else if (reached.contains(number_of(child, "id", 0)))
            movements.push_back(case_movement(child));
    }
    moves_particles = moves_particles || !objects.empty();
    for (std::vector<Element>* part : {&movements, &objects})
        for (Element& e : *part) copy.children.push_back(std::move(e));
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
