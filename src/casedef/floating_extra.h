#pragma once

#include "casedef/attributes.h"

#include <optional>
#include <string>
#include <vector>

namespace fppg
{

/// A child of `<floating>` for Case.xml, with the attributes that GenCase v5.4 keeps of it (35
/// experiments): translationDOF and rotationDOF (0 or 1), linearvelini and angularvelini (x, y, z),
/// linearvel, angularvel, linearforce and angularforce (a file, or rows of time, x, y, z, of which
/// velocities may leave axes out: "none"; an axis that all rows leave out is not written).
///
/// warnings  gets a line for what stands in a table and is no row of it
/// returns   nothing where it says what holds without it: free axes, velocities of zero
/// throws    CaseError for another element, for a number that is missing or wrong
std::optional<Element> floating_extra(const Element& given, const AttributeReader& read,
                                      std::vector<std::string>& warnings);

} // namespace fppg
