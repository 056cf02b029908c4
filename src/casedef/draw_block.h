#pragma once

#include "fppg/case_def.h"

#include "casedef/attributes.h"

namespace fppg
{

/// What the `<fppg>` blocks of `<casedef>` add to the drawing: `<fill>`s follow the operations of a
/// case whose commands have run, `<points>` go into point_files, `<offlattice>` is a switch.
/// -fit:off does not touch them.
///
/// throws  CaseError with file, line and element
void read_draw_block(const AttributeReader& read, CaseDef& def);

} // namespace fppg
