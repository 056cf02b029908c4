#include "casedef/lenient_xml.h"

#include <algorithm>
#include <optional>
#include <string_view>
#include <utility>

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

} // namespace

StrictXml strict_xml(const std::string& text)
{
    return LenientText(text).run();
}

} // namespace fppg
