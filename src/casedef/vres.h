#pragma once

#include "fppg/case_def.h"

#include "casedef/attributes.h"
#include "casedef/variables.h"

namespace fppg
{

/// `<vres>`: the zones and their boxes. Rules found by experiment with GenCase v5.4.354
/// (the template VRes and 8 random cases of 2 or 3 zones, equal in order of ids).
///
/// def   with grid, limits and constants of the whole domain, and the variables of zone 0; gets
///       warnings of attributes that GenCase does not heed here, `if` among them
/// ref   the point that the lattice of the domain goes through
/// throws  CaseError with file, line and element for what is not known or out of range, and for a
///         box that is too small, or too near to the limits of the zone around it
VresDef read_vres(const Element& vres, const Element& definition, const AttributeReader& read,
                  Variables& variables, CaseDef& def, const Vec3& ref);

} // namespace fppg
