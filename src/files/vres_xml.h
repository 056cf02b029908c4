#pragma once

#include "fppg/case_def.h"

#include <optional>

namespace fppg
{

/// `<vres>` of `<execution>`: the boxes of all zones, one in the other, and which zone this case
/// is.
Element vres_tag(const CaseDef& def);

/// `<simulationdomain>` of a zone that asks for one.
std::optional<Element> zone_domain_tag(const CaseDef& def);

} // namespace fppg
