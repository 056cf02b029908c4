#include "fuzz/mutate_case.h"

#include <tinyxml2.h>

#include <array>
#include <charconv>
#include <cmath>
#include <random>
#include <string_view>
#include <vector>

#include <fmt/format.h>

namespace fppg::fuzz
{
namespace
{

using tinyxml2::XMLAttribute;
using tinyxml2::XMLDocument;
using tinyxml2::XMLElement;

using Random = std::mt19937;

constexpr auto values = std::to_array<const char*>({"0",
                                                    "-0",
                                                    "1",
                                                    "-1",
                                                    "nan",
                                                    "inf",
                                                    "-inf",
                                                    "1e308",
                                                    "-1e308",
                                                    "1e-308",
                                                    "1e30",
                                                    "1e9",
                                                    "65535",
                                                    "65536",
                                                    "2147483648",
                                                    "4294967296",
                                                    "18446744073709551616",
                                                    "",
                                                    " ",
                                                    "1e",
                                                    "0x10",
                                                    "true",
                                                    "false",
                                                    "#0/0",
                                                    "#1/0",
                                                    "#Dp",
                                                    "#-Dp/2",
                                                    "#Dp*1e9",
                                                    "#sqrt(-1)",
                                                    "#NoSuchVariable",
                                                    "$Dp [Dp]"});

constexpr auto scales =
    std::to_array<double>({0, -1, 0.5, 2, 0.1, 10, 1e-3, 1e3, 1e-9, 1e9, 1e-30, 1e30});

constexpr auto texts = std::to_array<const char*>({"solid",
                                                   "all",
                                                   "top",
                                                   "bottom | left",
                                                   "right | front | back",
                                                   "bottom ^ top",
                                                   "full",
                                                   "face",
                                                   "wire",
                                                   "auto",
                                                   "void",
                                                   "bound",
                                                   "fluid",
                                                   "0, 1, 2",
                                                   "1-300",
                                                   "*",
                                                   "|",
                                                   "-1",
                                                   "3*vdp",
                                                   "nosuchword"});

constexpr auto files = std::to_array<const char*>({"cube.stl", "open.stl", "flat.stl", "two.stl",
                                                   "square.vtk", "parts.vtm", "ground.xyz",
                                                   "heights.csv", "points.csv", "nosuch.stl"});

std::size_t pick(Random& random, std::size_t count)
{
    return std::uniform_int_distribution<std::size_t>(0, count - 1)(random);
}

void collect(XMLElement* element, std::vector<XMLElement*>& out)
{
    for (; element != nullptr; element = element->NextSiblingElement())
    {
        out.push_back(element);
        collect(element->FirstChildElement(), out);
    }
}

/// All elements but the root.
std::vector<XMLElement*> elements_of(XMLDocument& document)
{
    std::vector<XMLElement*> out;
    if (document.RootElement() != nullptr)
        collect(document.RootElement()->FirstChildElement(), out);
    return out;
}

std::vector<const XMLAttribute*> attributes_of(const XMLElement& element)
{
    std::vector<const XMLAttribute*> out;
    for (const XMLAttribute* a = element.FirstAttribute(); a != nullptr; a = a->Next())
        out.push_back(a);
    return out;
}

bool is_within(const tinyxml2::XMLNode* node, const tinyxml2::XMLNode* folder)
{
    for (; node != nullptr; node = node->Parent())
        if (node == folder) return true;
    return false;
}

/// Puts a copy of an element behind another one, or into it.
void put_copy(XMLElement& element, XMLElement& place, XMLDocument& document, Random& random)
{
    tinyxml2::XMLNode* copy = element.DeepClone(&document);
    if (pick(random, 3) == 0 || place.Parent() == nullptr)
        place.InsertEndChild(copy);
    else
        place.Parent()->InsertAfterChild(&place, copy);
}

std::string changed_number(const std::string& text, Random& random)
{
    double value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size())
        return values[pick(random, values.size())];
    switch (pick(random, 5))
    {
        case 0:
            return fmt::format("{}", value * scales[pick(random, scales.size())]);
        case 1:
            return fmt::format("{}", value + (pick(random, 2) == 0 ? 0.05 : -0.05));
        case 2:
            return fmt::format("{}",
                               value * (1 + 1e-7 * (static_cast<double>(pick(random, 21)) - 10)));
        case 3:
            return fmt::format("{}",
                               value * std::pow(10, static_cast<double>(pick(random, 25)) - 10));
        default:
            return values[pick(random, values.size())];
    }
}

void change_attribute(XMLElement& element, const std::vector<XMLElement*>& all, Random& random)
{
    const std::vector<const XMLAttribute*> attributes = attributes_of(element);
    if (attributes.empty())
    {
        if (element.GetText() != nullptr) element.SetText(texts[pick(random, texts.size())]);
        return;
    }
    const XMLAttribute& attribute = *attributes[pick(random, attributes.size())];
    const std::string name = attribute.Name();
    const bool is_file = name == "file" || name == "filevtm";
    const std::size_t what = pick(random, 10);
    if (is_file && what < 8)
        element.SetAttribute(name.c_str(), files[pick(random, files.size())]);
    else if (what == 0)
        element.DeleteAttribute(name.c_str());
    else if (what == 1)
        element.SetAttribute(name.c_str(), texts[pick(random, texts.size())]);
    else if (what == 2)
    {
        const auto others = attributes_of(*all[pick(random, all.size())]);
        if (!others.empty())
        {
            const std::string value = others[pick(random, others.size())]->Value();
            element.SetAttribute(name.c_str(), value.c_str());
        }
    }
    else
        element.SetAttribute(name.c_str(), changed_number(attribute.Value(), random).c_str());
}

void swap_places(XMLElement& a, XMLElement& b, XMLDocument& document)
{
    if (is_within(&a, &b) || is_within(&b, &a)) return;
    tinyxml2::XMLNode* copy_of_a = a.DeepClone(&document);
    tinyxml2::XMLNode* copy_of_b = b.DeepClone(&document);
    a.Parent()->InsertAfterChild(&a, copy_of_b);
    b.Parent()->InsertAfterChild(&b, copy_of_a);
    document.DeleteNode(&a);
    document.DeleteNode(&b);
}

void change_once(XMLDocument& document, Random& random)
{
    const std::vector<XMLElement*> all = elements_of(document);
    if (all.empty()) return;
    XMLElement& element = *all[pick(random, all.size())];
    XMLElement& other = *all[pick(random, all.size())];
    // A domain that grows makes cases that are too large to run.
    const std::string_view name = element.Name();
    const bool is_domain = name == "definition" || name == "pointmin" || name == "pointmax";
    switch (pick(random, 10))
    {
        case 0:
            document.DeleteNode(&element);
            break;
        case 1:
            put_copy(element, element, document, random);
            break;
        case 2:
            if (!is_within(&other, &element)) put_copy(element, other, document, random);
            break;
        case 3:
            swap_places(element, other, document);
            break;
        default:
            if (!is_domain || pick(random, 5) == 0) change_attribute(element, all, random);
    }
}

std::string text_of(const XMLDocument& document)
{
    tinyxml2::XMLPrinter printer(nullptr, true);
    document.Print(&printer);
    return printer.CStr();
}

} // namespace

std::string mutate_case(const std::string& text, std::uint32_t seed)
{
    XMLDocument document;
    if (document.Parse(text.c_str(), text.size()) != tinyxml2::XML_SUCCESS) return {};
    Random random(seed);
    for (std::size_t left = 1 + pick(random, 4); left > 0; --left) change_once(document, random);
    return text_of(document);
}

std::string cross_cases(const std::string& text, const std::string& other, std::uint32_t seed)
{
    XMLDocument document;
    XMLDocument second;
    if (document.Parse(text.c_str(), text.size()) != tinyxml2::XML_SUCCESS) return {};
    if (second.Parse(other.c_str(), other.size()) != tinyxml2::XML_SUCCESS) return {};
    Random random(seed);
    const std::vector<XMLElement*> own = elements_of(document);
    const std::vector<XMLElement*> foreign = elements_of(second);
    if (own.empty() || foreign.empty()) return {};
    XMLElement& element = *foreign[pick(random, foreign.size())];
    // Where an element of this name stands, so that it is read.
    for (XMLElement* place : own)
        if (std::string_view(place->Name()) == element.Name() && pick(random, 2) == 0)
        {
            put_copy(element, *place, document, random);
            return text_of(document);
        }
    put_copy(element, *own[pick(random, own.size())], document, random);
    return text_of(document);
}

} // namespace fppg::fuzz
