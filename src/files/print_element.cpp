#include "fppg/element.h"

#include <string>

namespace fppg
{

namespace
{

/// Line ends and tabs of an attribute would be read back as blanks, a carriage return of a text as
/// a line end: they are written as character references.
std::string escape(const std::string& raw, bool is_attribute)
{
    std::string escaped;
    escaped.reserve(raw.size());
    for (const char c : raw)
    {
        switch (c)
        {
            case '&':
                escaped += "&amp;";
                break;
            case '<':
                escaped += "&lt;";
                break;
            case '>':
                escaped += "&gt;";
                break;
            case '\r':
                escaped += "&#13;";
                break;
            case '"':
                escaped += is_attribute ? "&quot;" : "\"";
                break;
            case '\n':
                escaped += is_attribute ? "&#10;" : "\n";
                break;
            case '\t':
                escaped += is_attribute ? "&#9;" : "\t";
                break;
            default:
                escaped += c;
        }
    }
    return escaped;
}

void print(const Element& element, int depth, std::string& out);

/// What stands between the indent of an element and its tail.
void print_bare(const Element& element, int depth, std::string& out)
{
    if (element.kind == Element::Kind::Comment)
    {
        out += "<!--";
        out += element.text;
        out += "-->";
        return;
    }
    out += '<';
    out += element.name;
    for (const Element::Attribute& a : element.attributes)
    {
        out += ' ';
        out += a.name;
        out += "=\"";
        out += escape(a.value, true);
        out += '"';
    }
    if (element.children.empty() && element.text.empty())
    {
        out += " />";
        return;
    }
    out += '>';
    out += escape(element.text, false);
    if (!element.children.empty())
    {
        out += "\n";
        for (const Element& child : element.children) print(child, depth + 1, out);
        out.append(4 * static_cast<std::size_t>(depth), ' ');
    }
    out += "</";
    out += element.name;
    out += '>';
}

void print(const Element& element, int depth, std::string& out)
{
    out.append(4 * static_cast<std::size_t>(depth), ' ');
    print_bare(element, depth, out);
    out += escape(element.tail, false);
    out += '\n';
}

} // namespace

std::string print_element(const Element& element, int depth)
{
    std::string out;
    print(element, depth, out);
    return out;
}

std::string print_document(const Element& document)
{
    std::string out = "<?xml version=\"1.0\" encoding=\"UTF-8\" ?>\n";
    for (const Element& child : document.children) print(child, 0, out);
    return out;
}

} // namespace fppg
