// Case.xml, as GenCase v5.4.354 writes it (seen on its own output):
//
//   <case app date>     comments and what else stands around the two blocks as read
//     <casedef>         as read; only the layout is normalised
//     <execution>
//       ...             what the definition had (special, comments, unknown blocks)
//       <parameters>    key, value, comment and units_comment of each, without anything between
//                       them: a repeated parameter takes the place of the first one with the values
//                       of the last, deprecated keys are marked in their comment; simulationdomain
//                       comes last, complete and with fixed comments. A second block stays where it
//                       is, before the content of the first
//       <particles>     _summary, then a line a block in id order, floating ones with mass, center,
//                       inertia (short form where the off-diagonal entries are zero) and their
//                       restrictions and velocities, then the properties that are in use
//       <constants>  <vres> (of a zone)  <uservars>  <motion> (case_motion.h)  <vtkout>
//
// Numbers are the shortest text that reads back exactly, where GenCase keeps six to eleven digits:
// the solver compares data2dposy with the number in Case.bi4 and refuses a rounded one.

#include "core/text.h"
#include "files/case_motion.h"
#include "files/vres_xml.h"
#include "files/xml_tags.h"
#include "fppg/files.h"
#include "platform/files.h"

#include <fmt/format.h>
#include <algorithm>
#include <map>
#include <set>

namespace fppg
{

namespace
{

template <typename Integer>
std::string integer(Integer value)
{
    return fmt::format("{}", static_cast<std::uint64_t>(value));
}

Element with_units(Element element, std::string units)
{
    element.set_attribute("units_comment", std::move(units));
    return element;
}

Element value_tag(std::string name, double value)
{
    return tag(std::move(name), {{"value", number(value)}});
}

// ---- execution of the definition ----

/// Keys that v5.4.354 marks, whatever their case; it marks all that begin with DomainFixed or
/// DomainParticles.
bool is_deprecated(const std::string& key)
{
    static const std::set<std::string> keys{"deltasph", "partsoutmax", "incz", "posdouble"};
    const std::string name = lower_case(key);
    return keys.contains(name) || name.starts_with("domainfixed") ||
           name.starts_with("domainparticles");
}

/// Of a parameter what GenCase keeps, in its order.
Element case_parameter(const Element& given)
{
    const auto text = [&](const char* name)
    {
        const std::string* value = given.find_attribute(name);
        return value ? *value : std::string();
    };
    Element out = tag("parameter", {{"key", text("key")}, {"value", text("value")}});
    const std::string mark = is_deprecated(text("key")) ? "**DEPRECATED** " : "";
    std::string comment = text("comment");
    if (!comment.starts_with(mark)) comment = mark + comment;
    if (!comment.empty()) out.set_attribute("comment", comment);
    if (!text("units_comment").empty()) out.set_attribute("units_comment", text("units_comment"));
    return out;
}

Element complete_limit(const Element& domain, const std::string& name)
{
    Element limit = tag(name);
    const Element* given = domain.find_child(name);
    for (const char* axis : {"x", "y", "z"})
    {
        const std::string* value = given ? given->find_attribute(axis) : nullptr;
        limit.set_attribute(axis, value ? *value : "default");
    }
    return limit;
}

Element complete_domain(const Element& given)
{
    Element domain =
        tag("simulationdomain", {{"comment",
                                  "Defines domain of simulation (default=Uses minimum and "
                                  "maximum position of the generated particles)"}});
    domain.children.push_back(complete_limit(given, "posmin"));
    domain.children.back().set_attribute("comment", "e.g.: x=0.5, y=default-1, z=default-10%");
    domain.children.push_back(complete_limit(given, "posmax"));
    return domain;
}

/// Puts the domain of a zone in the place of that of the case.
void set_domain(Element& parameters, const Element& domain)
{
    *parameters.find_child("simulationdomain") = domain;
}

Element case_parameters(const Element& given)
{
    Element out = tag("parameters");
    std::map<std::string, std::size_t> place_of_key;
    for (const Element& child : given.children)
    {
        const std::string* key = child.find_attribute("key");
        if (child.name != "parameter" || !key) continue;
        const auto [place, is_new] = place_of_key.emplace(*key, out.children.size());
        if (is_new) out.children.emplace_back();
        out.children[place->second] = case_parameter(child);
    }
    const Element* domain = given.find_child("simulationdomain");
    out.children.push_back(complete_domain(domain ? *domain : Element{}));
    return out;
}

// ---- particles ----

const char* name_of(ParticleType type)
{
    static constexpr const char* names[] = {"fixed", "moving", "floating", "fluid"};
    return names[static_cast<int>(type)];
}

Element summary(const CaseParticles& particles)
{
    Element out = tag("_summary");
    Element positions = with_units(tag("positions"), "metres (m)");
    positions.children = {vector_tag("posmin", particles.pos_min),
                          vector_tag("posmax", particles.pos_max)};
    out.children.push_back(std::move(positions));
    std::uint64_t begin = 0;
    for (const ParticleType type :
         {ParticleType::Fixed, ParticleType::Moving, ParticleType::Floating, ParticleType::Fluid})
    {
        std::uint64_t count = 0;
        std::vector<int> mks;
        for (const ParticleBlock& block : particles.blocks)
        {
            if (block.type != type) continue;
            count += block.count;
            mks.push_back(block.mk);
        }
        if (count == 0) continue;
        out.children.push_back(
            tag(name_of(type), {{"count", integer(count)},
                                {"id", fmt::format("{}-{}", begin, begin + count - 1)},
                                {"mkcount", integer(mks.size())},
                                {"mkvalues", format_ranges(mks)}}));
        begin += count;
    }
    return out;
}

Element inertia_tag(const std::array<Vec3, 3>& rows)
{
    bool is_diagonal = true;
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j)
            if (i != j && rows[static_cast<std::size_t>(i)][j] != 0) is_diagonal = false;
    if (is_diagonal)
        return with_units(vector_tag("inertia", {rows[0].x, rows[1].y, rows[2].z}), "kg*m^2");
    Element out = with_units(tag("inertia"), "kg*m^2");
    for (int i = 0; i < 3; ++i)
    {
        Element row = tag("values");
        for (int j = 0; j < 3; ++j)
            row.set_attribute(fmt::format("v{}{}", i + 1, j + 1),
                              number(rows[static_cast<std::size_t>(i)][j]));
        out.children.push_back(std::move(row));
    }
    return out;
}

/// The remaining children of a floating block in their fixed order.
void add_floating_extras(const std::vector<Element>& extras, Element& out)
{
    static const std::vector<std::pair<std::string, std::string>> names_and_units{
        {"translationDOF", ""},     {"rotationDOF", ""},    {"linearvelini", "m/s"},
        {"angularvelini", "rad/s"}, {"linearvel", "m/s"},   {"angularvel", "rad/s"},
        {"linearforce", "N/s"},     {"angularforce", "N/s"}};
    for (const auto& [name, units] : names_and_units)
        for (const Element& extra : extras)
        {
            if (extra.name != name) continue;
            out.children.push_back(extra);
            if (!units.empty())
                out.children.back().set_attribute("units_comment", units);
            else
                out.children.back().set_attribute(
                    "comment", fmt::format("Use 0 to restrict Degrees Of Freedom for {} "
                                           "(default=(1,1,1))",
                                           name == "translationDOF" ? "translation" : "rotation"));
        }
}

const FloatingDef* find_floating(const CaseDef& def, std::uint16_t mkbound)
{
    const FloatingDef* found = nullptr;
    for (const FloatingDef& floating : def.floatings)
        if (std::find(floating.mkbound.begin(), floating.mkbound.end(), mkbound) !=
            floating.mkbound.end())
            found = &floating;
    return found;
}

Element block_tag(const CaseDef& def, const CaseParticles& particles, std::size_t index)
{
    const ParticleBlock& block = particles.blocks[index];
    Element out = tag(name_of(block.type));
    out.set_attribute(block.type == ParticleType::Fluid ? "mkfluid" : "mkbound",
                      integer(block.mk_type));
    out.set_attribute("mk", integer(block.mk));
    out.set_attribute("begin", integer(block.begin));
    out.set_attribute("count", integer(block.count));
    if (!block.property.empty()) out.set_attribute("property", block.property);
    if (block.colour) out.set_attribute("fppg:color", hex_of(*block.colour));
    if (block.type == ParticleType::Moving)
        out.set_attribute("refmotion", fmt::format("{}", block.ref_motion));
    if (block.type == ParticleType::Floating)
    {
        for (const FloatingBody& body : particles.floatings)
        {
            if (body.block != index) continue;
            out.children.push_back(with_units(value_tag("massbody", body.mass_body), "kg"));
            out.children.push_back(with_units(value_tag("masspart", body.mass_part), "kg"));
            out.children.push_back(with_units(vector_tag("center", body.center), "metres (m)"));
            out.children.push_back(inertia_tag(body.inertia));
        }
        if (const FloatingDef* floating = find_floating(def, block.mk_type))
            add_floating_extras(floating->extra, out);
    }
    return out;
}

std::set<std::string> split_names(const std::string& joined)
{
    std::set<std::string> names;
    for (std::size_t begin = 0; begin <= joined.size();)
    {
        const std::size_t end = std::min(joined.find('+', begin), joined.size());
        names.insert(joined.substr(begin, end - begin));
        begin = end + 1;
    }
    return names;
}

/// Of a property what GenCase keeps: its attributes, and those of its children.
Element values_of(const Element& property)
{
    Element out = tag(property.name);
    out.attributes = property.attributes;
    for (const Element& given : property.children)
    {
        if (given.kind != Element::Kind::Tag || given.name.starts_with('_')) continue;
        out.children.push_back(tag(given.name));
        out.children.back().attributes = given.attributes;
    }
    return out;
}

/// The properties that blocks have, or an empty name if none has one.
Element properties_in_use(const CaseDef& def, const CaseParticles& particles)
{
    std::map<std::string, std::vector<int>> mks_of; // by joined names
    std::set<std::string> used;
    for (const ParticleBlock& block : particles.blocks)
    {
        if (block.property.empty()) continue;
        mks_of[block.property].push_back(block.mk);
        used.merge(split_names(block.property));
    }
    Element out;
    if (mks_of.empty()) return out;
    std::vector<std::pair<int, std::string>> order;
    for (auto& [names, mks] : mks_of)
        order.emplace_back(*std::min_element(mks.begin(), mks.end()), names);
    std::sort(order.begin(), order.end());

    out.name = "properties";
    Element links = tag("links");
    for (const auto& [first_mk, names] : order)
        links.children.push_back(
            tag("link", {{"mk", format_ranges(mks_of[names])}, {"property", names}}));
    out.children.push_back(std::move(links));
    for (const Element& property : def.properties.children)
    {
        const std::string* name = property.find_attribute("name");
        if (property.kind == Element::Kind::Tag && property.name == "property" && name &&
            used.contains(*name))
            out.children.push_back(values_of(property));
    }
    return out;
}

Element particles_tag(const CaseDef& def, const CaseParticles& particles)
{
    Element out = tag("particles", {{"np", integer(particles.np)},
                                    {"nb", integer(particles.np - particles.n_fluid)},
                                    {"nbf", integer(particles.n_fixed)},
                                    {"mkboundfirst", integer(def.mk_bound_first)},
                                    {"mkfluidfirst", integer(def.mk_fluid_first)}});
    out.children.push_back(summary(particles));
    for (std::size_t i = 0; i < particles.blocks.size(); ++i)
        out.children.push_back(block_tag(def, particles, i));
    Element properties = properties_in_use(def, particles);
    if (!properties.name.empty()) out.children.push_back(std::move(properties));
    return out;
}

// ---- constants, user variables, files ----

Element constants_tag(const CaseConstants& constants)
{
    Element out = tag("constants");
    out.children.push_back(tag("data2d", {{"value", constants.is_2d ? "true" : "false"}}));
    if (constants.is_2d)
        out.children.push_back(with_units(value_tag("data2dposy", constants.y_2d), "metres (m)"));
    out.children.push_back(with_units(vector_tag("gravity", constants.gravity), "m/s^2"));
    out.children.push_back(value_tag("cflnumber", constants.cfl_number));
    out.children.push_back(value_tag("gamma", constants.gamma));
    out.children.push_back(with_units(value_tag("rhop0", constants.rhop0), "kg/m^3"));
    // GenCase gives eps, a plain number, this unit; the same line compares equal.
    if (constants.has_eps)
        out.children.push_back(with_units(value_tag("eps", constants.eps), "m/s^2"));
    out.children.push_back(with_units(value_tag("dp", constants.dp), "metres (m)"));
    out.children.push_back(with_units(value_tag("h", constants.h), "metres (m)"));
    out.children.push_back(with_units(value_tag("b", constants.b), "Pascal (Pa)"));
    out.children.push_back(with_units(value_tag("massbound", constants.mass_bound), "kg"));
    out.children.push_back(with_units(value_tag("massfluid", constants.mass_fluid), "kg"));
    return out;
}

Element user_variables_tag(const std::vector<UserVariable>& variables)
{
    Element out = tag("uservars");
    for (const UserVariable& v : variables)
        out.children.push_back(
            tag(v.is_text ? "varstr" : "varnum",
                {{"name", v.name}, {"value", v.is_text ? v.text : number(v.number)}}));
    return out;
}

Element vtk_out_tag(const CaseDef& def, const std::vector<VtkOutEntry>& entries)
{
    Element out = tag("vtkout", {{"mkboundfirst", integer(def.mk_bound_first)},
                                 {"mkfluidfirst", integer(def.mk_fluid_first)}});
    for (const VtkOutEntry& entry : entries)
    {
        Element line = tag("vtkfile", {{"name", entry.file}, {"mk", entry.mk}});
        if (!entry.mkbound.empty()) line.set_attribute("mkbound", entry.mkbound);
        if (!entry.mkfluid.empty()) line.set_attribute("mkfluid", entry.mkfluid);
        out.children.push_back(std::move(line));
    }
    return out;
}

} // namespace

std::string format_ranges(std::vector<int> numbers)
{
    std::sort(numbers.begin(), numbers.end());
    numbers.erase(std::unique(numbers.begin(), numbers.end()), numbers.end());
    std::string out;
    for (std::size_t i = 0; i < numbers.size();)
    {
        std::size_t last = i;
        while (last + 1 < numbers.size() && numbers[last + 1] == numbers[last] + 1) ++last;
        if (!out.empty()) out += ',';
        out += fmt::format("{}", numbers[i]);
        if (last > i) out += fmt::format("-{}", numbers[last]);
        i = last + 1;
    }
    return out;
}

namespace
{

bool uses_own_prefix(const Element& e)
{
    return std::any_of(e.attributes.begin(), e.attributes.end(),
                       [](const auto& a) { return a.name.starts_with("fppg:"); }) ||
           std::any_of(e.children.begin(), e.children.end(), uses_own_prefix);
}

Element& case_of(Element& document)
{
    return *std::find_if(document.children.begin(), document.children.end(),
                         [](const Element& e) { return e.kind == Element::Kind::Tag; });
}

/// The child of that name, made where there is none.
Element& content_of(Element& root, const char* name)
{
    if (root.find_child(name) == nullptr) root.children.push_back(tag(name));
    return *root.find_child(name);
}

/// What `<execution>` has before the blocks that a program adds.
std::vector<Element> taken_over(const CaseDef& def)
{
    std::vector<Element> out;
    std::optional<Element> parameters;
    Element* second = nullptr;
    out.reserve(def.execution.size() + 1);
    for (const Element& child : def.execution)
    {
        const bool is_block = child.kind == Element::Kind::Tag && child.name == "parameters";
        if (is_block && !parameters)
        {
            parameters = case_parameters(child);
            continue;
        }
        out.push_back(child);
        if (is_block) second = &out.back();
    }
    if (!parameters) return out;
    if (def.vres.is_active())
        if (const auto domain = zone_domain_tag(def)) set_domain(*parameters, *domain);
    if (second != nullptr)
        second->children.insert(second->children.end(), parameters->children.begin(),
                                parameters->children.end());
    else
        out.push_back(std::move(*parameters));
    return out;
}

} // namespace

void write_case_xml(OutputFile& file, const CaseDef& def, const CaseParticles& particles,
                    const CaseConstants& constants, const std::vector<VtkOutEntry>& vtk_out,
                    const FileOrigin& origin)
{
    Element document = def.document;
    if (document.children.empty()) document.children.push_back(tag("case"));
    Element& root = case_of(document);
    root.set_attribute("app", origin.app_name);
    root.set_attribute("date", origin.date);
    // Readers that know of namespaces refuse a prefix that nobody declares.
    const bool has_colours = std::any_of(particles.blocks.begin(), particles.blocks.end(),
                                         [](const ParticleBlock& b) { return b.colour; });
    if (has_colours || uses_own_prefix(def.casedef)) root.set_attribute("xmlns:fppg", "urn:fppg");
    content_of(root, "casedef") = def.casedef;
    Element& execution = content_of(root, "execution");
    execution.children = taken_over(def);
    execution.children.push_back(particles_tag(def, particles));
    execution.children.push_back(constants_tag(constants));
    if (def.vres.is_active()) execution.children.push_back(vres_tag(def));
    if (!def.user_variables.empty())
        execution.children.push_back(user_variables_tag(def.user_variables));
    execution.children.push_back(case_motion(def.motion, particles.blocks));
    execution.children.push_back(vtk_out_tag(def, vtk_out));
    file.append(with_line_ends(print_document(document)));
}

} // namespace fppg
