#include "casedef/lenient_xml.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

namespace fppg
{
namespace
{

class LenientText
{
public:
    explicit LenientText(const std::string& text) : text_(text) {}

    StrictXml run()
    {
        if (is_at("\xEF\xBB\xBF")) drop_to(3);
        while (at_ < text_.size())
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
        const std::size_t end = end_of_root_.value_or(out_.size());
        return {std::move(out_), end};
    }

private:
    bool is_at(std::string_view mark) const { return text_.compare(at_, mark.size(), mark) == 0; }

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
            else if (is_value && !is_xml_blank(c) && c != '>' && c != '/')
                quote_value();
            else
            {
                out_ += c;
                ++at_;
                if (c == '>') break;
                if (!is_xml_blank(c)) is_value = c == '=';
                last = c;
                continue;
            }
            is_value = false;
            last = 0;
        }
        if (!is_element) return;
        if (is_end)
            --depth_;
        else if (last != '/')
            ++depth_;
        if (depth_ == 0 && !end_of_root_) end_of_root_ = out_.size();
    }

    void quote_value()
    {
        out_ += '"';
        while (at_ < text_.size() && !is_xml_blank(text_[at_]) && text_[at_] != '/' &&
               text_[at_] != '>')
            out_ += text_[at_++];
        out_ += '"';
    }

    const std::string& text_;
    std::string out_;
    std::size_t at_ = 0;
    int depth_ = 0;
    std::optional<std::size_t> end_of_root_;
};

struct OpenTag
{
    std::string_view name;
    int line = 0;
};

class TagWalk
{
public:
    explicit TagWalk(std::string_view text) : text_(text) {}

    TagFault run()
    {
        do
        {
            step_to(text_.find('<', at_));
            if (at_ == text_.size()) break;
            if (text_.substr(at_).starts_with("<!--"))
                pass("-->", "the comment");
            else if (text_.substr(at_).starts_with("<![CDATA["))
                pass("]]>", "the CDATA section");
            else
                take_tag();
        } while (fault_.text.empty() && !open_.empty());
        if (fault_.text.empty() && !open_.empty())
            fault_ = {open_.back().line,
                      fmt::format("<{}> is opened here and is not closed up to the end of the file",
                                  open_.back().name)};
        return fault_;
    }

private:
    void step_to(std::size_t to)
    {
        to = std::min(to, text_.size());
        line_ +=
            static_cast<int>(std::count(text_.begin() + static_cast<std::ptrdiff_t>(at_),
                                        text_.begin() + static_cast<std::ptrdiff_t>(to), '\n'));
        at_ = to;
    }

    void pass(std::string_view end, const char* what)
    {
        const std::size_t found = text_.find(end, at_);
        if (found == std::string_view::npos)
            fault_ = {line_, fmt::format("{} that is opened here has no end {}", what, end)};
        else
            step_to(found + end.size());
    }

    /// The end of a tag, values in quotes passed over; npos: it has none.
    std::size_t end_of_tag()
    {
        for (std::size_t i = at_ + 1; i < text_.size(); ++i)
        {
            const char c = text_[i];
            if (c == '>') return i;
            if (c == '<') return std::string_view::npos;
            if (c != '"' && c != '\'') continue;
            i = text_.find(c, i + 1);
            if (i == std::string_view::npos) break;
        }
        return std::string_view::npos;
    }

    void take_tag()
    {
        const bool is_end = text_.substr(at_).starts_with("</");
        const std::size_t begin = at_ + (is_end ? 2 : 1);
        const std::size_t name_end =
            std::min(text_.find_first_of(" \t\r\n/>", begin), text_.size());
        const std::string_view name = text_.substr(begin, name_end - begin);
        const std::size_t end = end_of_tag();
        if (end == std::string_view::npos)
        {
            fault_ = {line_,
                      fmt::format("the tag <{}{} that begins here has no end '>', or a value "
                                  "in it has no closing quote",
                                  is_end ? "/" : "", name)};
            return;
        }
        if (is_end)
            close(name);
        else if (text_[end - 1] != '/' && !name.starts_with('!'))
            open_.push_back({name, line_});
        step_to(end + 1);
    }

    void close(std::string_view name)
    {
        if (!open_.empty() && open_.back().name == name)
        {
            open_.pop_back();
            return;
        }
        const bool is_open = std::any_of(open_.begin(), open_.end(),
                                         [&](const OpenTag& tag) { return tag.name == name; });
        if (is_open)
            fault_ = {open_.back().line,
                      fmt::format("<{}> is opened here and is not closed before </{}> of line {}",
                                  open_.back().name, name, line_)};
        else if (open_.empty())
            fault_ = {line_, fmt::format("</{}> closes nothing, as no tag is open", name)};
        else
            fault_ = {line_,
                      fmt::format("</{}> closes nothing; the tag that is open is <{}> of line "
                                  "{}, expected </{}>",
                                  name, open_.back().name, open_.back().line, open_.back().name)};
    }

    std::string_view text_;
    std::size_t at_ = 0;
    int line_ = 1;
    std::vector<OpenTag> open_;
    TagFault fault_;
};

} // namespace

TagFault find_tag_fault(const std::string& strict_text)
{
    return TagWalk(strict_text).run();
}

StrictXml strict_xml(const std::string& text)
{
    return LenientText(text).run();
}

} // namespace fppg
