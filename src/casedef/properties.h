#pragma once

#include "fppg/case_def.h"

#include "casedef/attributes.h"

namespace fppg
{

/// The names in a sum of materials like "steel + rubber", each once, sorted by bytes. Blanks do not
/// count, inside a name either, and "+" without a name before or behind it is passed over (found by
/// experiment with GenCase v5.4.354: 17 sums in links, 8 in floatings).
std::vector<std::string> property_names(const std::string& sum);

/// Reads `<properties>` into `properties` and `property_links` of the case, and joins to these the
/// property of each floating that the case has by then; of two floatings for one mkbound the later
/// one counts. As in GenCase v5.4.354 only the first `<links>` counts; a warning names others.
///
/// e       null: there is none, then no floating may have a property
/// throws  CaseError for unknown children, a property of two parts that repeats a value, and a link
///         or floating with a property that is not there; IoError for a property file
void read_properties(const Element* e, const AttributeReader& read, CaseDef& def);

} // namespace fppg
