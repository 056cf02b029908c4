#pragma once

#include "fppg/case_def.h"

#include "casedef/attributes.h"

#include <map>
#include <memory>
#include <string>

namespace fppg
{

/// Patterns by their names in small letters.
using PatternTable = std::map<std::string, std::shared_ptr<const DrawPattern>>;

/// Reads `<patterns>`, whether they are used or not. The cells are given as X and - (x too) or as a
/// hexadecimal number, most significant bit first, of as many digits as are needed; bits that are
/// left over are dropped (found by experiment with GenCase v5.4.354).
///
/// throws CaseError for a name that is there twice, sizes below 1, a gap outside the pattern, cells
///        that are not as many as the size says, other letters
PatternTable read_patterns(const Element& patterns, const AttributeReader& read);

} // namespace fppg
