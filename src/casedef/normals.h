#pragma once

#include "fppg/case_def.h"
#include "fppg/normals.h"

#include "casedef/attributes.h"

namespace fppg
{

/// Reads `<normals>`; `active="false"` gives a definition that is not active.
///
/// warnings  appended where GenCase v5.4.354 does something that its user hardly expects
/// throws    CaseError for what GenCase refuses: unknown children, a second norgeometry,
///           norgeometry with a selection, missing values
NormalsDef read_normals(const Element& list, const CaseDef& def, const AttributeReader& read,
                        std::vector<std::string>& warnings);

/// Warns of normals in `<special><initialize>`, which the solvers of v5.0 and v5.2 compute and
/// that of v5.4 refuses: `<boundnormal_plane>`, `_sphere`, `_cylinder` and `_parts` (its source,
/// JDsInitialize.cpp).
void warn_of_refused_normals(const CaseDef& def, const AttributeReader& read,
                             std::vector<std::string>& warnings);

} // namespace fppg
