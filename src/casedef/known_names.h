#pragma once

#include "fppg/element.h"

#include <string>
#include <vector>

namespace fppg
{

/// A warning for each attribute of a definition that nobody reads, and for each element that no
/// section of a case knows: GenCase v5.4.354 and this
/// program pass over it without a word, so a mistyped one changes the case. What each element may
/// have is that of the schema, xml-templates/fppg.xsd; elements for the solver (`<special>`,
/// properties) may have any. Remarks are left alone: `comment`, `cmt`, `_name`, what ends in
/// `_comment`, `objname`, and `name` of setmkbound and its like. The attributes of 207 public
/// definitions that are warned of then have no effect in v5.4: `mask` of drawsphere and
/// `value0` of hdp.
///
/// root  `<case>`
/// file  for the messages
std::vector<std::string> unknown_names(const Element& root, const std::string& file);

} // namespace fppg
