#include "upgrade/definition_text.h"

#include "fppg/error.h"

#include <fmt/format.h>

#include <algorithm>

namespace fppg
{
namespace
{

constexpr int max_depth = 200;

bool is_blank(char c)
{
    return c == ' ' || (c >= '\t' && c <= '\r');
}

bool ends_name(char c)
{
    return is_blank(c) || c == '>' || c == '/' || c == '=' || c == '<' || c == '"' || c == '\'';
}

class Scanner
{
public:
    Scanner(const std::string& text, const std::string& file) : text_(text), file_(file) {}

    TextNode run()
    {
        TextNode document;
        read_children(document, 0);
        for (TextNode& node : document.children)
            if (!node.is_comment)
            {
                if (node.name != "case")
                    fail(node.whole.begin,
                         fmt::format("the root element is <{}>, expected <case>", node.name));
                return std::move(node);
            }
        throw CaseError(file_, 0, "there is no element, expected the root <case>");
    }

private:
    [[noreturn]] void fail(std::size_t at, const std::string& text) const
    {
        const auto lines = std::count(
            text_.begin(), text_.begin() + static_cast<std::ptrdiff_t>(std::min(at, text_.size())),
            '\n');
        throw CaseError(file_, static_cast<int>(lines) + 1, text);
    }

    /// Lines are counted from where the last call ended.
    int line_of(std::size_t at)
    {
        for (; counted_ < at; ++counted_)
            if (text_[counted_] == '\n') ++line_;
        return line_;
    }

    bool starts(std::string_view mark) const { return text_.compare(at_, mark.size(), mark) == 0; }

    void skip_past(std::string_view mark, const char* what)
    {
        const std::size_t found = text_.find(mark, at_);
        if (found == std::string::npos) fail(at_, fmt::format("{} is not closed", what));
        at_ = found + mark.size();
    }

    /// Up to the end tag of `parent`, or to the end of the text for the document.
    void read_children(TextNode& parent, int depth)
    {
        if (depth > max_depth)
            fail(at_, fmt::format("elements are nested more than {} deep", max_depth));
        for (;;)
        {
            at_ = std::min(text_.find('<', at_), text_.size());
            if (at_ == text_.size())
            {
                if (depth > 0)
                    fail(parent.whole.begin, fmt::format("<{}>: is not closed", parent.name));
                return;
            }
            const std::size_t begin = at_;
            if (starts("<!--"))
            {
                TextNode comment;
                comment.is_comment = true;
                comment.line = line_of(begin);
                at_ += 4;
                skip_past("-->", "the comment");
                comment.whole = {begin, at_};
                parent.children.push_back(std::move(comment));
            }
            else if (starts("<![CDATA["))
                skip_past("]]>", "the CDATA section");
            else if (starts("<?"))
                skip_past("?>", "the declaration");
            else if (starts("<!"))
                skip_past(">", "the declaration");
            else if (starts("</"))
            {
                read_end_tag(parent, depth);
                return;
            }
            else
                read_element(parent, depth);
        }
    }

    TextSpan read_name()
    {
        const std::size_t begin = at_;
        while (at_ < text_.size() && !ends_name(text_[at_])) ++at_;
        return {begin, at_};
    }

    std::string part(TextSpan span) const
    {
        return text_.substr(span.begin, span.end - span.begin);
    }

    void skip_blanks()
    {
        while (at_ < text_.size() && is_blank(text_[at_])) ++at_;
    }

    void read_end_tag(TextNode& parent, int depth)
    {
        const std::size_t begin = at_;
        at_ += 2;
        const TextSpan name = read_name();
        if (depth == 0 || part(name) != parent.name)
            fail(begin,
                 fmt::format("</{}> closes nothing{}", part(name),
                             depth == 0 ? "" : fmt::format(", expected </{}>", parent.name)));
        skip_past(">", "the end tag");
        parent.end_name_at = name;
        parent.inside = {parent.start_tag.end, begin};
        parent.whole.end = at_;
    }

    void read_element(TextNode& parent, int depth)
    {
        TextNode& node = parent.children.emplace_back();
        node.whole.begin = at_;
        node.line = line_of(at_);
        ++at_;
        node.name_at = read_name();
        node.name = part(node.name_at);
        if (node.name.empty()) fail(node.whole.begin, "'<' without the name of an element");
        for (;;)
        {
            skip_blanks();
            if (at_ >= text_.size())
                fail(node.whole.begin, fmt::format("<{}>: the tag is not closed", node.name));
            if (starts("/>") || text_[at_] == '>') break;
            read_attribute(node);
        }
        node.is_one_tag = text_[at_] == '/';
        at_ += node.is_one_tag ? 2 : 1;
        node.start_tag = {node.whole.begin, at_};
        node.whole.end = at_;
        node.inside = node.end_name_at = {at_, at_};
        if (!node.is_one_tag) read_children(node, depth + 1);
    }

    void read_attribute(TextNode& node)
    {
        TextAttribute attribute;
        attribute.name_at = read_name();
        attribute.name = part(attribute.name_at);
        skip_blanks();
        if (attribute.name.empty() || at_ >= text_.size() || text_[at_] != '=')
            fail(at_, fmt::format("<{}>: expected attributes as name=\"value\"", node.name));
        ++at_;
        skip_blanks();
        const char quote = at_ < text_.size() ? text_[at_] : ' ';
        if (quote != '"' && quote != '\'')
            fail(at_, fmt::format("<{}>: the value of attribute '{}' has no quotes", node.name,
                                  attribute.name));
        const std::size_t begin = ++at_;
        at_ = text_.find(quote, at_);
        if (at_ == std::string::npos)
            fail(begin, fmt::format("<{}>: the value of attribute '{}' is not closed", node.name,
                                    attribute.name));
        attribute.value_at = {begin, at_};
        attribute.value = part(attribute.value_at);
        ++at_;
        attribute.whole = {attribute.name_at.begin, at_};
        node.attributes.push_back(std::move(attribute));
    }

    const std::string& text_;
    const std::string& file_;
    std::size_t at_ = 0;
    std::size_t counted_ = 0;
    int line_ = 1;
};

} // namespace

const TextAttribute* TextNode::find_attribute(std::string_view attribute_name) const
{
    for (const TextAttribute& a : attributes)
        if (a.name == attribute_name) return &a;
    return nullptr;
}

const TextNode* TextNode::find(std::string_view child_name) const
{
    for (const TextNode& c : children)
        if (!c.is_comment && c.name == child_name) return &c;
    return nullptr;
}

TextNode scan_definition(const std::string& text, const std::string& file)
{
    return Scanner(text, file).run();
}

} // namespace fppg
