#pragma once

#include "fppg/element.h"

#include "casedef/attributes.h"

namespace fppg
{

/// An element and its children with all `#expressions` of attributes replaced by plain numbers;
/// comments, elements that begin with `_` and elements with a false `if` are left out.
Element evaluated_element(const Element& element, const AttributeReader& read);

/// The motion of a definition with all numbers evaluated: `#expressions` become plain numbers,
/// elements that begin with `_`, comments and elements with a false `if` are left out. objreal refs
/// stay mkbound.
///
/// throws CaseError for an element that is not known or a number that cannot be read
Element evaluated_motion(const Element& motion, const AttributeReader& read);

} // namespace fppg
