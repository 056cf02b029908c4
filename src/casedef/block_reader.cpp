#include "casedef/block_reader.h"

#include <algorithm>
#include <string>

namespace fppg
{

void BlockReader::require_known(const Element& e,
                                std::initializer_list<std::string_view> attributes,
                                std::initializer_list<std::string_view> children) const
{
    const auto is_in = [](const std::string& name, std::initializer_list<std::string_view> known)
    { return std::find(known.begin(), known.end(), name) != known.end(); };
    for (const Element::Attribute& a : e.attributes)
        if (!a.name.starts_with('_') && a.name != "comment" && !is_in(a.name, attributes))
            read_.fail_unknown_attribute(e, a, attributes);
    for (const Element& c : e.children)
        if (!is_remark(c) && !is_in(c.name, children))
            read_.fail_unknown_element(c, e.name, children);
    if (!e.text.empty())
        read_.fail(e, fmt::format("text \"{}\" has no meaning here, expected {}", e.text,
                                  children.size() == 0 ? "attributes only" : "elements only"));
}

} // namespace fppg
