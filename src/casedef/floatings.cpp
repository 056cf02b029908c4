#include "casedef/floatings.h"

#include "casedef/floating_extra.h"
#include "casedef/properties.h"

#include <fmt/format.h>

#include <set>
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
        require_each_once(e);
        FloatingDef f;
        f.line = e.line;
        f.mkbound = read_.number_list(e, "mkbound");
        f.properties = property_names(read_.text_or(e, "property", ""));
        for (const Element& c : e.children)
            if (is_extra(c))
                if (auto extra = floating_extra(c, read_, def_.warnings))
                    f.extra.push_back(std::move(*extra));
        read_mass(e, f);
        if (const Element* center = e.find_child("center")) f.center = read_.vec3(*center);
        read_inertia(e, f);
        return f;
    }

    /// Whether floating_extra() reads it.
    static bool is_extra(const Element& c)
    {
        static const std::set<std::string_view> own{"massbody", "masspart", "center", "inertia",
                                                    "inertiafull"};
        return c.kind == Element::Kind::Tag && !c.name.starts_with('_') && !own.contains(c.name);
    }

    void require_each_once(const Element& e) const
    {
        std::set<std::string> seen;
        for (const Element& c : e.children)
            if (c.kind == Element::Kind::Tag && !c.name.starts_with('_') &&
                !seen.insert(c.name).second)
                read_.fail(c, "there are two of it in <floating>, expected one");
    }

    void read_mass(const Element& e, FloatingDef& f)
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
        const double rhop0 = def_.constants.rhop0;
        if (mass != 0)
            f.mass_body = mass;
        else
            f.rhop_body = (rhop != 0 ? rhop / 1000 : weight) * rhop0;
        if (rhop != 0 && rhop0 != 1000)
            def_.warnings.push_back(fmt::format(
                "{}:{}: <floating>: rhopbody=\"{:g}\" gives {:g} kg/m^3, as GenCase makes it "
                "rhopbody / 1000 * rhop0; relativeweight=\"{:g}\" gives {:g}",
                def_.file, e.line, rhop, *f.rhop_body, rhop / rhop0, rhop));
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

    const AttributeReader& read_;
    CaseDef& def_;
};

} // namespace

void read_floatings(const Element& list, const AttributeReader& read, CaseDef& def)
{
    FloatingReader(read, def).run(list);
}

} // namespace fppg
