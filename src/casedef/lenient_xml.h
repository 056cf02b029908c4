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

} // namespace fppg
