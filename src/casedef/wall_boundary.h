#pragma once

#include "casedef/attributes.h"

#include "fppg/case_def.h"

namespace fppg
{

/// Of one wall; no kernel of fluid at its surface reaches a farther one.
inline constexpr int most_layers = 16;

/// Gives every fitted wall without a boundary condition of its own that of the case's parameter
/// Boundary (2: mDBC), warns where the two disagree or one layer stands for mDBC, and hints at
/// parameters that hold fluid in the solver. Solids that float, with dynamic boundaries, have
/// their particles inside (Placement::Inside) unless the case asks for something else.
///
/// throws  CaseError where the kernel would see more layers than most_layers, whatever the walls,
///         and for lists of flexible bodies that are none
void settle_boundaries(const AttributeReader& read, CaseDef& def);

} // namespace fppg
