#include "casedef/floatings.h"

#include "casedef/initials.h"
#include "casedef/properties.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <climits>
#include <string_view>

namespace fppg
{
namespace
{

class FloatingReader
{
public:
    FloatingReader(const AttributeReader& read, CaseDef& def) : read_(read), def_(def) {}

    void run(const Element& list)
    {
        for (const Element& e : list.children)
        {
            if (e.kind != Element::Kind::Tag || e.name.starts_with('_')) continue;
            if (e.name == "floating")
                def_.floatings.push_back(read_floating(e));
            else
                warn(e, "<floatings>", "floating");
        }
    }

private:
    /// GenCase passes over such an element without a word.
    void warn(const Element& e, const char* where, const char* expected)
    {
        def_.warnings.push_back(
            fmt::format("{}:{}: <{}>: is not known in {} and has no effect, expected {}", def_.file,
                        e.line, e.name, where, expected));
    }

    FloatingDef read_floating(const Element& e)
    {
        static const std::vector<std::string_view> known{
            "massbody",       "masspart",    "center",       "inertia",       "inertiafull",
            "translationDOF", "rotationDOF", "linearvelini", "angularvelini", "linearvel",
            "angularvel",     "linearforce", "angularforce"};
        require_known_children(e, known, read_);
        for (const std::string_view name : known) require_once(e, name);

        FloatingDef f;
        f.line = e.line;
        f.mkbound = read_.number_list(e, "mkbound");
        f.properties = property_names(read_.text_or(e, "property", ""));
        read_mass(e, f);
        if (const Element* center = e.find_child("center")) f.center = read_.vec3(*center);
        read_inertia(e, f);
        for (const char* name : {"translationDOF", "rotationDOF"})
            if (const Element* c = e.find_child(name)) add_freedom(*c, f);
        for (const char* name : {"linearvelini", "angularvelini"})
            if (const Element* c = e.find_child(name)) add_velocity(*c, f);
        for (const char* name : {"linearvel", "angularvel", "linearforce", "angularforce"})
            if (const Element* c = e.find_child(name)) add_course(*c, f);
        return f;
    }

    void require_once(const Element& e, std::string_view name) const
    {
        const auto is_it = [&](const Element& c)
        { return c.kind == Element::Kind::Tag && c.name == name; };
        const auto first = std::find_if(e.children.begin(), e.children.end(), is_it);
        if (first == e.children.end()) return;
        const auto second = std::find_if(first + 1, e.children.end(), is_it);
        if (second != e.children.end())
            read_.fail(*second, "is given twice in <floating>, expected once");
    }

    void read_mass(const Element& e, FloatingDef& f) const
    {
        const Element* body = e.find_child("massbody");
        const double mass = body != nullptr ? read_.number(*body, "value") : 0;
        const double rhop = read_.number_or(e, "rhopbody", 0);
        const double weight = read_.number_or(e, "relativeweight", 0);
        const int values = (mass != 0) + (rhop != 0) + (weight != 0);
        if (values != 1)
            read_.fail(e, fmt::format("{} must be defined, the child <massbody> or the attribute "
                                      "relativeweight or rhopbody",
                                      values == 0 ? "one value that is not 0" : "only one value"));
        if (mass != 0)
            f.mass_body = mass;
        else
            f.rhop_body = rhop != 0 ? rhop : weight * def_.constants.rhop0;
        const Element* part = e.find_child("masspart");
        if (part == nullptr) return;
        f.distribute_mass = read_.text(*part, "value") == "distributed_bodymass";
        if (f.distribute_mass) return;
        f.mass_part = read_.number(*part, "value");
        f.distribute_mass = *f.mass_part == 0;
    }

    void read_inertia(const Element& e, FloatingDef& f)
    {
        const Element* full = e.find_child("inertiafull");
        if (const Element* i = e.find_child("inertia"))
        {
            if (full != nullptr) read_.fail(*full, "is given beside <inertia>, expected one");
            const Vec3 d = read_.vec3(*i);
            f.inertia = {Vec3{d.x, 0, 0}, Vec3{0, d.y, 0}, Vec3{0, 0, d.z}};
        }
        if (full == nullptr) return;
        std::array<Vec3, 3> rows;
        for (const Element& v : full->children)
        {
            if (v.kind != Element::Kind::Tag || v.name.starts_with('_')) continue;
            if (v.name != "values")
            {
                warn(v, "<inertiafull>", "values");
                continue;
            }
            for (int row = 0; row < 3; ++row)
                for (int column = 0; column < 3; ++column)
                    if (const auto value =
                            read_.number_if(v, fmt::format("v{}{}", row + 1, column + 1)))
                        rows[static_cast<std::size_t>(row)][column] = *value;
        }
        f.inertia = rows;
    }

    static Element copy_of(const Element& e)
    {
        Element out;
        out.name = e.name;
        out.line = e.line;
        return out;
    }

    void add_freedom(const Element& e, FloatingDef& f) const
    {
        Element out = copy_of(e);
        bool is_held = false;
        for (const char* axis : {"x", "y", "z"})
        {
            const int free = read_.integer(e, axis, INT_MIN, INT_MAX, true);
            is_held = is_held || free == 0;
            out.set_attribute(axis, free == 0 ? "0" : "1");
        }
        if (is_held) f.extra.push_back(std::move(out));
    }

    void add_velocity(const Element& e, FloatingDef& f) const
    {
        const Vec3 v = read_.vec3(e);
        if (v == Vec3{}) return;
        Element out = copy_of(e);
        for (int axis = 0; axis < 3; ++axis)
            out.set_attribute(std::string(1, "xyz"[axis]), fmt::format("{}", v[axis]));
        f.extra.push_back(std::move(out));
    }

    /// A velocity or force over time, from a file or from children.
    void add_course(const Element& e, FloatingDef& f)
    {
        Element out = copy_of(e);
        const std::string file = read_.text_or(e, "file", "");
        const bool is_force = e.name.ends_with("force");
        const char* child = is_force ? "force" : "vel";
        if (!file.empty()) out.set_attribute("file", file);
        for (const Element& c : e.children)
        {
            if (c.kind != Element::Kind::Tag || c.name.starts_with('_')) continue;
            if (c.name != child)
                warn(c, fmt::format("<{}>", e.name).c_str(), child);
            else if (file.empty())
                out.children.push_back(value_at(c, is_force));
        }
        remove_free_axes(out.children);
        f.extra.push_back(std::move(out));
    }

    Element value_at(const Element& e, bool is_force) const
    {
        Element out = copy_of(e);
        out.set_attribute("time", fmt::format("{}", read_.number(e, "time")));
        for (const char* axis : {"x", "y", "z"})
        {
            std::string word = read_.text_or(e, axis, is_force ? "" : "none");
            for (char& c : word) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
            out.set_attribute(axis, !is_force && word == "none"
                                        ? word
                                        : fmt::format("{}", read_.number(e, axis)));
        }
        return out;
    }

    /// Axes on which no entry has a number.
    static void remove_free_axes(std::vector<Element>& entries)
    {
        for (const char* axis : {"x", "y", "z"})
        {
            const auto is_free = [&](const Element& e)
            { return *e.find_attribute(axis) == "none"; };
            if (!std::all_of(entries.begin(), entries.end(), is_free)) continue;
            for (Element& e : entries)
                std::erase_if(e.attributes,
                              [&](const Element::Attribute& a) { return a.name == axis; });
        }
    }

    const AttributeReader& read_;
    CaseDef& def_;
};

} // namespace

void read_floatings(const Element& list, const AttributeReader& read, CaseDef& def)
{
    FloatingReader(read, def).run(list);
}

} // namespace fppg
