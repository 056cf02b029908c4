#pragma once

#include <string>

namespace fppg
{

/// A blank, tab or line end.
inline bool is_xml_blank(char c)
{
    return c == ' ' || (c >= 9 && c <= 13);
}

/// Brings a text into what tinyxml2 reads where the XML parser of GenCase v5.4.354 takes more:
/// values of attributes without quotes get some; a byte order mark, instructions (`<? ?>`, the
/// declaration too, which may have comments before it) and all behind the end of the root that is
/// no comment become blanks. Line ends stay, so that lines still count.
std::string strict_xml(const std::string& text);

} // namespace fppg
