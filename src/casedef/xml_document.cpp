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

/// Brings a text into what tinyxml2 reads where the XML parser of GenCase v5.4.354 takes more:
/// values of attributes without quotes get some, instructions (`<? ?>`, the declaration too, which
/// may have comments before it) become blanks, and so does all that stands behind the end of the
/// root. Line ends stay, so that lines still count.
class LenientText
{
public:
    explicit LenientText(const std::string& text) : text_(text) {}

    std::string run()
    {
        while (at_ < text_.size() && !(has_root_ && depth_ == 0))
        {
            if (is_at("<!--"))
                copy_past("-->");
            else if (is_at("<![CDATA["))
                copy_past("]]>");
            else if (is_at("<?"))
                drop_to(end_of("?>"));
            else if (text_[at_] == '<')
                copy_tag();
            else
                out_ += text_[at_++];
        }
        drop_to(text_.size());
        return std::move(out_);
    }

private:
    bool is_at(std::string_view mark) const { return text_.compare(at_, mark.size(), mark) == 0; }
    static bool is_blank(char c) { return c == ' ' || (c >= 9 && c <= 13); }

    std::size_t end_of(std::string_view mark) const
    {
        const std::size_t found = text_.find(mark, at_);
        return found == std::string::npos ? text_.size() : found + mark.size();
    }
    void copy_past(std::string_view mark)
    {
        const std::size_t end = end_of(mark);
        out_.append(text_, at_, end - at_);
        at_ = end;
    }
    void drop_to(std::size_t end)
    {
        for (; at_ < end; ++at_) out_ += text_[at_] == '\n' ? '\n' : ' ';
    }

    void copy_tag()
    {
        const bool is_end = is_at("</");
        const bool is_element = !is_at("<!");
        bool is_value = false; // behind a '='
        char last = 0;
        while (at_ < text_.size())
        {
            const char c = text_[at_];
            if (c == '"' || c == '\'')
            {
                const std::size_t end = std::min(text_.find(c, at_ + 1), text_.size() - 1);
                out_.append(text_, at_, end - at_ + 1);
                at_ = end + 1;
                is_value = false;
            }
            else if (is_value && !is_blank(c) && c != '>' && c != '/')
                quote_value();
            else
            {
                out_ += c;
                ++at_;
                if (c == '>') break;
                if (!is_blank(c)) is_value = c == '=';
                last = c;
                continue;
            }
            is_value = false;
            last = 0;
        }
        if (!is_element) return;
        has_root_ = true;
        if (is_end)
            --depth_;
        else if (last != '/')
            ++depth_;
    }

    void quote_value()
    {
        out_ += '"';
        while (at_ < text_.size() && !is_blank(text_[at_]) && text_[at_] != '/' &&
               text_[at_] != '>')
            out_ += text_[at_++];
        out_ += '"';
    }

    const std::string& text_;
    std::string out_;
    std::size_t at_ = 0;
    int depth_ = 0;
    bool has_root_ = false;
};

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
    text = LenientText(text).run();
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
