#include "upgrade/edited_text.h"

#include "core/text.h"

#include <algorithm>
#include <cctype>
#include <cstdlib>

namespace fppg
{
namespace
{

bool is_space(char c)
{
    return c == ' ' || c == '\t';
}

/// Blanks and line ends as one blank.
std::string one_line(const std::string& text)
{
    std::string out;
    for (const char c : text)
    {
        const bool blank = std::isspace(static_cast<unsigned char>(c)) != 0;
        if (!blank)
            out += c;
        else if (!out.empty() && out.back() != ' ')
            out += ' ';
    }
    if (out.ends_with(' ')) out.pop_back();
    return out;
}

} // namespace

void EditedText::rename(const TextNode& node, const std::string& name)
{
    replace(node.name_at, name);
    if (!node.is_one_tag) replace(node.end_name_at, name);
}

void EditedText::remove(const TextAttribute& attribute)
{
    TextSpan span = attribute.whole;
    while (is_space(text_[span.begin - 1])) --span.begin;
    replace(span, "");
}

void EditedText::remove(const TextNode& node)
{
    TextSpan span = node.whole;
    std::size_t end = span.end;
    while (end < text_.size() && is_space(text_[end])) ++end;
    if (end < text_.size() && text_[end] == '\r') ++end;
    const auto indent = indent_at(span.begin);
    if (indent && end < text_.size() && text_[end] == '\n')
        span = {span.begin - indent->size(), end + 1};
    replace(span, "");
}

void EditedText::report(int line, const std::string& from, const std::string& to)
{
    out_.changes.push_back({line, one_line(from), one_line(to)});
}

void EditedText::note(int line, const std::string& text)
{
    out_.notes.push_back({line, one_line(text)});
}

std::optional<std::string> EditedText::indent_at(std::size_t at) const
{
    std::size_t begin = at;
    while (begin > 0 && is_space(text_[begin - 1])) --begin;
    if (begin > 0 && text_[begin - 1] != '\n') return std::nullopt;
    return text_.substr(begin, at - begin);
}

std::string EditedText::indent_step(const TextNode& node) const
{
    const auto outer = indent_at(node.whole.begin);
    for (const TextNode& child : node.children)
    {
        const auto inner = indent_at(child.whole.begin);
        if (outer && inner && inner->size() > outer->size() && inner->starts_with(*outer))
            return inner->substr(outer->size());
    }
    return outer && outer->find('\t') != std::string::npos ? "\t" : "    ";
}

std::string EditedText::line_end(std::size_t at) const
{
    const std::size_t end = text_.find('\n', at);
    return end != std::string::npos && end > 0 && text_[end - 1] == '\r' ? "\r\n" : "\n";
}

std::string EditedText::apply() const
{
    std::vector<const Edit*> order;
    for (const Edit& e : edits_) order.push_back(&e);
    std::stable_sort(order.begin(), order.end(),
                     [](const Edit* a, const Edit* b) { return a->span.begin < b->span.begin; });
    std::string out;
    std::size_t at = 0;
    for (const Edit* e : order)
    {
        out.append(text_, at, e->span.begin - at);
        out += e->with;
        at = e->span.end;
    }
    out.append(text_, at);
    return out;
}

std::optional<double> literal_number(const std::string& value)
{
    char* end = nullptr;
    const double number = std::strtod(value.c_str(), &end);
    if (end == value.c_str()) return std::nullopt;
    while (std::isspace(static_cast<unsigned char>(*end)) != 0) ++end;
    if (*end != 0) return std::nullopt;
    return number;
}

bool is_true(const std::string& value)
{
    return value == "1" || lower_case(value) == "true";
}

bool is_switched_on(const TextNode& node)
{
    const TextAttribute* active = node.find_attribute("active");
    return active == nullptr || (active->value != "0" && lower_case(active->value) != "false");
}

std::vector<const TextNode*> active_children(const TextNode& node, std::string_view name)
{
    std::vector<const TextNode*> out;
    for (const TextNode& c : node.children)
        if (!c.is_comment && c.name == name) out.push_back(&c);
    return out;
}

const TextNode* find_active(const TextNode& node, std::string_view path)
{
    const TextNode* at = &node;
    for (const std::string_view name : split(path, '/'))
        if (at != nullptr && !name.empty()) at = at->find(name);
    return at;
}

} // namespace fppg
