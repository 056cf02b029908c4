#pragma once

#include "fppg/case_def.h"
#include "fppg/initials.h"

#include "casedef/attributes.h"

#include <string_view>
#include <vector>

namespace fppg
{

/// Children of a list that are to be run: tags that do not begin with '_' and are not switched off.
std::vector<const Element*> active_children(const Element& list, const AttributeReader& read);

/// Refuses the children of `e` that are not named, but for those that begin with '_'.
void require_known_children(const Element& e, const std::vector<std::string_view>& known,
                            const AttributeReader& read);

/// The filter of the child `<onlypos>`; everywhere without one.
PositionFilter read_only_pos(const Element& e, const AttributeReader& read);

/// Reads `<initials>`.
///
/// warnings  appended for each mk that <mkconfig> does not have
/// throws    CaseError as GenCase v5.4.354 does: no mk, or both; mkbound where only fluid can have
///           values; unknown children; a file of mesh data that is wrong. IoError for a file of
///           mesh data that is not there
std::vector<InitialOp> read_initials(const Element& list, const CaseDef& def,
                                     const AttributeReader& read,
                                     std::vector<std::string>& warnings);

} // namespace fppg
