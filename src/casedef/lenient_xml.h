#pragma once

#include <cstddef>
#include <string>

namespace fppg
{

/// A blank, tab or line end.
inline bool is_xml_blank(char c)
{
    return c == ' ' || (c >= 9 && c <= 13);
}

struct StrictXml
{
    std::string text;
    std::size_t end_of_root = 0; ///< bytes of the text up to the end of its root
};

/// Brings a text into what tinyxml2 reads where the XML parser of GenCase v5.4.354 takes more:
/// values of attributes without quotes get some; a byte order mark and instructions (`<? ?>`, the
/// declaration too, which may have comments before it) become blanks. Line ends stay, so that lines
/// still count. Behind the root anything may follow, well-formed or not.
StrictXml strict_xml(const std::string& text);

/// What is wrong with the tags of a text that is no XML.
struct TagFault
{
    int line = 0;     ///< from 1
    std::string text; ///< names the tag and where it was opened; empty: tags are not what is wrong
};

/// Finds the first tag that is not closed, or closed in the wrong place, or has no end, up to the
/// end of the root.
TagFault find_tag_fault(const std::string& strict_text);

} // namespace fppg
