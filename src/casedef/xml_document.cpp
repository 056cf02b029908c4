#include "casedef/xml_document.h"

#include "fppg/error.h"

#include <fmt/format.h>
#include <tinyxml2.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <sstream>

namespace fppg
{
namespace
{

constexpr int max_depth = 200;

std::string trimmed(const std::string& text)
{
    const auto is_blank = [](unsigned char c) { return c == ' ' || (c >= 9 && c <= 13); };
    auto first = std::find_if_not(text.begin(), text.end(), is_blank);
    auto last = std::find_if_not(text.rbegin(), std::make_reverse_iterator(first), is_blank).base();
    return {first, last};
}

/// Replaces what stands before the declaration by blanks, line ends kept so that lines still count.
void blank_before_declaration(std::string& text)
{
    std::size_t start = 0;
    if (text.compare(0, 3, "\xEF\xBB\xBF") == 0) start = 3;
    std::size_t pos = start;
    while (pos < text.size())
    {
        if (std::strchr(" \t\r\n", text[pos]) != nullptr && text[pos] != 0)
            ++pos;
        else if (text.compare(pos, 4, "<!--") == 0)
        {
            const std::size_t end = text.find("-->", pos + 4);
            if (end == std::string::npos) return;
            pos = end + 3;
        }
        else
            break;
    }
    if (text.compare(pos, 5, "<?xml") != 0) pos = start;
    for (std::size_t i = 0; i < pos; ++i)
        if (text[i] != '\n') text[i] = ' ';
    if (text.compare(pos, 5, "<?xml") == 0)
    {
        // The declaration itself says nothing that is used here, and it must be the first node.
        const std::size_t end = text.find("?>", pos);
        if (end != std::string::npos)
            for (std::size_t i = pos; i < end + 2; ++i)
                if (text[i] != '\n') text[i] = ' ';
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
    for (const auto* node = source.FirstChild(); node != nullptr; node = node->NextSibling())
    {
        if (const auto* tag = node->ToElement())
            out.children.push_back(convert(*tag, file, depth + 1));
        else if (const auto* text = node->ToText())
            out.text += text->Value();
        else if (const auto* comment = node->ToComment())
        {
            Element c;
            c.kind = Element::Kind::Comment;
            c.text = comment->Value();
            c.line = comment->GetLineNum();
            out.children.push_back(std::move(c));
        }
    }
    out.text = trimmed(out.text);
    return out;
}

} // namespace

Element parse_xml(std::string text, const std::string& name)
{
    blank_before_declaration(text);
    tinyxml2::XMLDocument document;
    const tinyxml2::XMLError error = document.Parse(text.data(), text.size());
    if (error == tinyxml2::XML_ERROR_EMPTY_DOCUMENT)
        throw CaseError(name, 0,
                        "the file is empty, expected an XML document with the root <case>");
    if (error != tinyxml2::XML_SUCCESS)
        throw CaseError(name, document.ErrorLineNum(),
                        fmt::format("this is not well-formed XML ({})",
                                    tinyxml2::XMLDocument::ErrorIDToName(error)));
    if (document.RootElement() == nullptr)
        throw CaseError(name, 0, "there is no element, expected the root <case>");
    return convert(*document.RootElement(), name, 0);
}

Element read_xml(const std::string& path)
{
    std::ifstream in(path, std::ios::binary);
    if (!in) throw IoError(fmt::format("{}: cannot open the file: {}", path, std::strerror(errno)));
    std::ostringstream text;
    text << in.rdbuf();
    if (in.bad() || (text.fail() && in.peek() != EOF))
        throw IoError(fmt::format("{}: cannot read the file: {}", path, std::strerror(errno)));
    return parse_xml(std::move(text).str(), path);
}

} // namespace fppg
