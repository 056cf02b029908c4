#pragma once

#include "fppg/element.h"

#include "casedef/attributes.h"

#include <fmt/format.h>

#include <initializer_list>
#include <string_view>

namespace fppg
{

/// Reads elements of `<fppg>`. The block belongs to this program, so all that it holds is
/// understood or refused; only what the language takes for a remark is passed over: `_elements`,
/// `_attributes` and `comment`.
class BlockReader
{
public:
    explicit BlockReader(const AttributeReader& read) : read_(read) {}

    static bool is_remark(const Element& e)
    {
        return e.kind != Element::Kind::Tag || e.name.starts_with('_');
    }

    /// throws CaseError for an attribute or child that is none of these, and for text
    void require_known(const Element& e, std::initializer_list<std::string_view> attributes,
                       std::initializer_list<std::string_view> children) const;

    template <typename IsValid>
    double number_or(const Element& e, std::string_view name, double otherwise,
                     const IsValid& is_valid, const char* expected) const
    {
        const std::string* value = e.find_attribute(name);
        if (value == nullptr) return otherwise;
        // An empty number is 0 elsewhere, as with GenCase; here it is a mistake.
        if (value->find_first_not_of(" \t\r\n") == std::string::npos)
            read_.fail(e, fmt::format("attribute {}=\"\" is empty, expected {}", name, expected));
        const double number = read_.number(e, name);
        if (!is_valid(number))
            read_.fail(e, fmt::format("attribute {}=\"{}\" is {:g}, expected {}", name, *value,
                                      number, expected));
        return number;
    }

protected:
    const AttributeReader& read_;
};

} // namespace fppg
