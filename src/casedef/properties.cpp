#include "casedef/properties.h"

#include "fppg/error.h"

#include "casedef/xml_document.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <set>

namespace fppg
{
namespace
{

std::string without_blanks(std::string name)
{
    std::erase_if(name, [](char c) { return c == ' ' || (c >= 9 && c <= 13); });
    return name;
}

class PropertiesReader
{
public:
    PropertiesReader(const AttributeReader& read, CaseDef& def) : read_(read), def_(def) {}

    void run(const Element& e)
    {
        def_.properties = e;
        def_.properties.children.clear();
        const Element* links = nullptr;
        for (const Element& c : e.children)
        {
            if (c.kind != Element::Kind::Tag || c.name.starts_with('_')) continue;
            if (c.name == "property")
                add_property(c);
            else if (c.name == "propertyfile")
                add_property_file(c);
            else if (c.name != "links")
                read_.fail(c,
                           "is not known in <properties>, expected links, property or "
                           "propertyfile");
            else if (links == nullptr)
                links = &c;
            else
                warn(c, "is there twice, the second one has no effect, as with GenCase");
        }
        if (links == nullptr) return;
        for (const Element& link : links->children)
            if (link.kind == Element::Kind::Tag && !link.name.starts_with('_')) add_link(link);
    }

    void link_floatings()
    {
        for (std::size_t i = 0; i < def_.floatings.size(); ++i)
        {
            const FloatingDef& f = def_.floatings[i];
            Element place;
            place.name = "floating";
            place.line = f.line;
            for (const std::string& name : f.properties) require_property(place, name);
            for (const std::uint16_t mk : f.mkbound)
            {
                const bool is_replaced =
                    std::any_of(def_.floatings.begin() + static_cast<std::ptrdiff_t>(i) + 1,
                                def_.floatings.end(),
                                [mk](const FloatingDef& later) {
                                    return std::find(later.mkbound.begin(), later.mkbound.end(),
                                                     mk) != later.mkbound.end();
                                });
                if (is_replaced) continue;
                for (const std::string& name : f.properties)
                    def_.property_links.emplace_back(
                        static_cast<std::uint16_t>(mk + def_.mk_bound_first), name);
            }
        }
    }

private:
    void warn(const Element& e, const std::string& text)
    {
        def_.warnings.push_back(
            fmt::format("{}:{}: <{}>: {}.", read_.file(), e.line, e.name, text));
    }

    /// The file is XML; `path` leads from its root to the element whose properties are taken.
    void add_property_file(const Element& e)
    {
        const std::string name = read_.text(e, "file");
        const std::string path = read_.text(e, "path");
        std::string found = name;
        std::error_code ignored;
        if (!std::filesystem::exists(found, ignored))
            found = (std::filesystem::path(def_.file).parent_path() / name).string();
        if (!std::filesystem::exists(found, ignored))
            throw IoError(
                fmt::format("{}:{}: <{} file=\"{}\">: there is no such file, neither in "
                            "the working directory nor beside the definition",
                            def_.file, e.line, e.name, name));
        const Element root = read_xml(found);
        const Element* at = nullptr;
        for (std::size_t begin = 0; begin <= path.size();)
        {
            const std::size_t end = std::min(path.find('.', begin), path.size());
            const std::string step = path.substr(begin, end - begin);
            if (begin == 0)
                at = step == root.name ? &root : nullptr;
            else
                at = at->find_child(step);
            if (at == nullptr)
                read_.fail(e, fmt::format("{} has no element {}, expected the path of one with "
                                          "<property> elements in it",
                                          found, path));
            begin = end + 1;
        }
        for (const Element& c : at->children)
            if (c.kind == Element::Kind::Tag && c.name == "property") add_property(c);
    }

    /// A property given in parts is one; no part may repeat a value.
    void add_property(const Element& e)
    {
        const std::string name = without_blanks(read_.text(e, "name"));
        if (Element* known = find_property(name))
        {
            for (const Element::Attribute& a : e.attributes)
            {
                if (a.name == "name") continue;
                if (known->find_attribute(a.name) != nullptr)
                    read_.fail(e,
                               fmt::format("the property {} has a value {} already", name, a.name));
                known->attributes.push_back(a);
            }
            known->children.insert(known->children.end(), e.children.begin(), e.children.end());
            return;
        }
        def_.properties.children.push_back(e);
        def_.properties.children.back().set_attribute("name", name);
    }

    void add_link(const Element& link)
    {
        if (link.name != "link")
        {
            warn(link, "is not known in <links> and has no effect, expected link");
            return;
        }
        if (link.find_attribute("mkbound") == nullptr && link.find_attribute("mkfluid") == nullptr)
            read_.fail(link, "attribute 'mkbound' or 'mkfluid' is missing");
        const std::vector<std::string> names = property_names(read_.text(link, "property"));
        for (const std::string& name : names) require_property(link, name);
        for (const char* type : {"mkbound", "mkfluid"})
        {
            if (link.find_attribute(type) == nullptr) continue;
            const int first =
                type == std::string_view("mkbound") ? def_.mk_bound_first : def_.mk_fluid_first;
            for (const std::uint16_t mk : read_.number_list(link, type))
                for (const std::string& name : names)
                    def_.property_links.emplace_back(static_cast<std::uint16_t>(mk + first), name);
        }
    }

    Element* find_property(const std::string& name)
    {
        for (Element& p : def_.properties.children)
            if (*p.find_attribute("name") == name) return &p;
        return nullptr;
    }

    void require_property(const Element& e, const std::string& name)
    {
        if (find_property(name) == nullptr)
            read_.fail(e, fmt::format("there is no property named \"{}\"; expected a "
                                      "<property name=\"{}\"> in <properties> or its files",
                                      name, name));
    }

    const AttributeReader& read_;
    CaseDef& def_;
};

} // namespace

std::vector<std::string> property_names(const std::string& sum)
{
    const std::string names = without_blanks(sum);
    std::set<std::string> out;
    for (std::size_t begin = 0; begin <= names.size();)
    {
        const std::size_t end = std::min(names.find('+', begin), names.size());
        if (end > begin) out.insert(names.substr(begin, end - begin));
        begin = end + 1;
    }
    return {out.begin(), out.end()};
}

void read_properties(const Element* e, const AttributeReader& read, CaseDef& def)
{
    PropertiesReader reader(read, def);
    if (e != nullptr) reader.run(*e);
    reader.link_floatings();
}

} // namespace fppg
