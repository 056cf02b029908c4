#pragma once

#include "fppg/case_def.h"

#include "casedef/attributes.h"

namespace fppg
{

/// Which walls are body-fitted, by the `<fppg>` blocks of `<casedef>` and the command line: fills
/// fit, fluid_bands and booleans of a case whose commands have run, and warns of mks that nothing
/// draws.
///
/// root    `<case>`
/// throws  CaseError with file, line and element for anything inside `<fppg>` that is not known or
///         out of range, for an `<fppg>` elsewhere, and for an mk that cannot stand beside fitted
///         walls
void read_fit(const Element& root, const AttributeReader& read, FitChoice choice, CaseDef& def);

} // namespace fppg
