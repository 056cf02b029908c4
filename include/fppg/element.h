#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace fppg
{

/// An XML tree as plain data, so that only the parser (src/casedef/xml_document.cpp) sees an XML
/// library. Comments are kept, because the generated Case.xml repeats the definition whole.
struct Element
{
    enum class Kind
    {
        Tag,
        Comment, ///< `text` is what stands between the comment marks
    };
    struct Attribute
    {
        std::string name;
        std::string value;
    };

    Kind kind = Kind::Tag;
    std::string name;
    std::string text;                  ///< character data before the first child, blanks condensed
    std::string tail;                  ///< character data behind it, up to the next element
    int line = 0;                      ///< in the file the tree was read from, from 1
    std::vector<Attribute> attributes; ///< in the order of the file
    std::vector<Element> children;     ///< in the order of the file

    /// The value of an attribute, or nullptr.
    const std::string* find_attribute(std::string_view attribute_name) const
    {
        for (const Attribute& a : attributes)
            if (a.name == attribute_name) return &a.value;
        return nullptr;
    }
    /// Sets an attribute, in place or at the end.
    void set_attribute(std::string_view attribute_name, std::string value)
    {
        for (Attribute& a : attributes)
            if (a.name == attribute_name)
            {
                a.value = std::move(value);
                return;
            }
        attributes.push_back({std::string(attribute_name), std::move(value)});
    }
    /// The first child tag of that name, or nullptr.
    const Element* find_child(std::string_view child_name) const
    {
        for (const Element& c : children)
            if (c.kind == Kind::Tag && c.name == child_name) return &c;
        return nullptr;
    }
    Element* find_child(std::string_view child_name)
    {
        return const_cast<Element*>(std::as_const(*this).find_child(child_name));
    }
};

/// Prints a tree as GenCase does: four blanks an indent, ` />` at empty elements, attributes in
/// their order, LF line ends; `depth` is the indent of the element itself. Text stands right behind
/// the tag before it. Text and attributes are escaped so that they read back the same.
std::string print_element(const Element& element, int depth);

/// Prints a whole file: the declaration, then the children of `document`. GenCase writes comments
/// that stand before the declaration there again, which is no XML.
std::string print_document(const Element& document);

} // namespace fppg
