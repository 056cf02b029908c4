#pragma once

#include "fppg/case_def.h"

#include "casedef/attributes.h"

namespace fppg
{

/// Reads `<floatings>` as GenCase v5.4.354 does (found by 80 small definitions):
/// - rhopbody and relativeweight are attributes, massbody, masspart, center, inertia, inertiafull,
///   the two DOFs, velocities and forces are children, each once; one of the three masses is not 0
/// - rhopbody is 1000 times a relativeweight, whatever rhop0 is: with a warning where that differs
/// - masspart 0 is massbody / n, as distributed_bodymass is
///
/// def  gives rhop0 and takes the bodies and warnings of elements that have no effect
/// throws CaseError for what GenCase refuses: elements that are not known, missing values
void read_floatings(const Element& list, const AttributeReader& read, CaseDef& def);

} // namespace fppg
