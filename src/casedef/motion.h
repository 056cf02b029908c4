#pragma once

#include "fppg/element.h"

#include "casedef/attributes.h"

namespace fppg
{

/// An element and its children with all `#expressions` of attributes replaced by plain numbers;
/// comments and elements that begin with `_` are left out.
Element evaluated_element(const Element& element, const AttributeReader& read);

/// The motion of a definition with all numbers evaluated: `#expressions` become plain numbers,
/// elements that begin with `_` and comments are left out; `if` has no effect (GenCase v5.4.354, 3
/// cases). objreal refs stay mkbound.
///
/// throws CaseError for an element that is not known or a number that cannot be read
Element evaluated_motion(const Element& motion, const AttributeReader& read);

} // namespace fppg
