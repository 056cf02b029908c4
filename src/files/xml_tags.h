#pragma once

#include "fppg/case_def.h"

#include <fmt/format.h>

#include <initializer_list>
#include <string>
#include <utility>

namespace fppg
{

/// A number as Case.xml has it: the shortest text that reads back exactly.
inline std::string number(double value)
{
    return fmt::format("{}", value);
}

inline Element tag(std::string name, std::initializer_list<Element::Attribute> attributes = {})
{
    Element element;
    element.name = std::move(name);
    element.attributes = attributes;
    return element;
}

/// A tag with the attributes x, y and z.
inline Element vector_tag(std::string name, const Vec3& v)
{
    return tag(std::move(name), {{"x", number(v.x)}, {"y", number(v.y)}, {"z", number(v.z)}});
}

} // namespace fppg
