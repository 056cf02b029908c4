#include "casedef/xml_document.h"

#include "casedef/lenient_xml.h"
#include "core/nearby_files.h"
#include "fppg/error.h"
#include "platform/regular_file.h"

#include <fmt/format.h>
#include <tinyxml2.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <sstream>

namespace fppg
{
namespace
{

constexpr int max_depth = 200;

/// Blanks at both ends dropped, runs of others one blank each.
std::string condensed(const std::string& text)
{
    std::string out;
    for (const char c : text)
    {
        if (!is_xml_blank(c))
            out += c;
        else if (!out.empty() && out.back() != ' ')
            out += ' ';
    }
    if (!out.empty() && out.back() == ' ') out.pop_back();
    return out;
}

/// The bytes of a UTF-8 character at `at`, or 0.
std::size_t utf8_length(const std::string& text, std::size_t at)
{
    const auto lead = static_cast<unsigned char>(text[at]);
    const std::size_t length = lead < 0x80                    ? 1
                               : lead >= 0xC2 && lead < 0xE0  ? 2
                               : lead >= 0xE0 && lead < 0xF0  ? 3
                               : lead >= 0xF0 && lead <= 0xF4 ? 4
                                                              : 0;
    for (std::size_t i = 1; i < length; ++i)
        if (at + i >= text.size() || (static_cast<unsigned char>(text[at + i]) & 0xC0) != 0x80)
            return 0;
    return length;
}

/// Text that is not UTF-8 is taken as Latin-1: what is written is UTF-8, whatever was read.
std::string as_utf8(std::string text)
{
    std::size_t at = 0;
    while (at < text.size())
    {
        const std::size_t length = utf8_length(text, at);
        if (length == 0) break;
        at += length;
    }
    if (at == text.size()) return text;
    std::string out;
    for (const char c : text)
    {
        const auto byte = static_cast<unsigned char>(c);
        if (byte >= 0x80) out += static_cast<char>(0xC0 | byte >> 6);
        out += byte < 0x80 ? c : static_cast<char>(0x80 | (byte & 0x3F));
    }
    return out;
}

Element convert(const tinyxml2::XMLElement& source, const std::string& file, int depth);

void convert_children(const tinyxml2::XMLNode& source, const std::string& file, int depth,
                      Element& out)
{
    for (const auto* node = source.FirstChild(); node != nullptr; node = node->NextSibling())
    {
        if (const auto* tag = node->ToElement())
            out.children.push_back(convert(*tag, file, depth));
        else if (const auto* text = node->ToText())
            (out.children.empty() ? out.text : out.children.back().tail) +=
                text->CData() ? text->Value() : condensed(text->Value());
        else if (const auto* comment = node->ToComment())
        {
            Element c;
            c.kind = Element::Kind::Comment;
            c.text = comment->Value();
            c.line = comment->GetLineNum();
            out.children.push_back(std::move(c));
        }
    }
}

Element convert(const tinyxml2::XMLElement& source, const std::string& file, int depth)
{
    if (depth > max_depth)
        throw CaseError(file, source.GetLineNum(),
                        fmt::format("elements are nested more than {} deep", max_depth));
    Element out;
    out.name = source.Name();
    out.line = source.GetLineNum();
    for (const auto* a = source.FirstAttribute(); a != nullptr; a = a->Next())
        out.attributes.push_back({a->Name(), a->Value()});
    convert_children(source, file, depth + 1, out);
    return out;
}

} // namespace

Element parse_document(std::string text, const std::string& name)
{
    const StrictXml strict = strict_xml(as_utf8(std::move(text)));
    tinyxml2::XMLDocument document;
    tinyxml2::XMLError error = document.Parse(strict.text.data(), strict.text.size());
    // What follows the root may be anything.
    if (error != tinyxml2::XML_SUCCESS && error != tinyxml2::XML_ERROR_EMPTY_DOCUMENT)
        error = document.Parse(strict.text.data(), strict.end_of_root);
    if (error == tinyxml2::XML_ERROR_EMPTY_DOCUMENT)
        throw CaseError(name, 0,
                        "the file is empty, expected an XML document with the root <case>");
    if (error != tinyxml2::XML_SUCCESS)
    {
        const TagFault fault = find_tag_fault(strict.text);
        if (!fault.text.empty())
            throw CaseError(name, fault.line,
                            fmt::format("this is not well-formed XML: {}", fault.text));
        throw CaseError(name, document.ErrorLineNum(),
                        fmt::format("this is not well-formed XML ({})",
                                    tinyxml2::XMLDocument::ErrorIDToName(error)));
    }
    if (document.RootElement() == nullptr)
        throw CaseError(name, 0, "there is no element, expected the root <case>");
    Element out;
    convert_children(document, name, 0, out);
    return out;
}

Element read_document(const std::string& path)
{
    expect_regular_file(path);
    std::ifstream in(std::filesystem::path(path), std::ios::binary);
    if (!in)
    {
        const int why = errno;
        throw IoError(fmt::format("{}: cannot open the file: {}{}", path, std::strerror(why),
                                  why == ENOENT ? what_lies_at({path}) : ""));
    }
    std::ostringstream text;
    text << in.rdbuf();
    if (in.bad() || (text.fail() && in.peek() != EOF))
        throw IoError(fmt::format("{}: cannot read the file: {}", path, std::strerror(errno)));
    return parse_document(std::move(text).str(), path);
}

const Element& root_of(const Element& document)
{
    return *std::find_if(document.children.begin(), document.children.end(),
                         [](const Element& e) { return e.kind == Element::Kind::Tag; });
}

Element read_xml(const std::string& path)
{
    return root_of(read_document(path));
}

Element parse_xml(std::string text, const std::string& name)
{
    return root_of(parse_document(std::move(text), name));
}

} // namespace fppg
