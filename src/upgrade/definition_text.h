#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace fppg
{

/// Bytes of a text, from `begin` to before `end`.
struct TextSpan
{
    std::size_t begin = 0;
    std::size_t end = 0;
};

struct TextAttribute
{
    std::string name;
    std::string value; ///< as it stands in the text, entities not resolved
    TextSpan whole;    ///< name, equals sign and value with its quotes
    TextSpan name_at;
    TextSpan value_at; ///< between the quotes
};

/// An element or a comment of a definition, and where its parts stand in the text. Unlike Element
/// (fppg/element.h) it is there to change some bytes of a file and leave all others.
struct TextNode
{
    bool is_comment = false;
    std::string name; ///< empty for a comment
    int line = 0;     ///< of its first byte, from 1
    TextSpan whole;   ///< from '<' of the start tag to behind '>' of the end tag
    TextSpan start_tag;
    TextSpan name_at;     ///< in the start tag
    TextSpan end_name_at; ///< in the end tag; empty where the element is one tag
    TextSpan inside;      ///< between start and end tag; empty where the element is one tag
    bool is_one_tag = false;
    std::vector<TextAttribute> attributes;
    std::vector<TextNode> children; ///< elements and comments, in the order of the text

    const TextAttribute* find_attribute(std::string_view attribute_name) const;
    /// The first element of that name, or nullptr.
    const TextNode* find(std::string_view child_name) const;
    /// GenCase passes over elements whose names begin with an underscore.
    bool is_active() const { return !is_comment && !name.empty() && name[0] != '_'; }
};

/// Finds the elements of a definition in its text, as leniently as GenCase v5.4 reads it: blanks
/// and comments before the declaration, a '<' in values, bytes that are no UTF-8.
///
/// file    for messages
/// throws  CaseError that names the line where an element is not closed, or the root is not <case>
TextNode scan_definition(const std::string& text, const std::string& file);

} // namespace fppg
