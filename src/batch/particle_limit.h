#pragma once

#include "fppg/case_def.h"

#include <string>

namespace fppg
{

/// Refuses a case of more particles than the file format holds before it is drawn, where the nodes
/// of its domain are more than that: draws it with a few larger particle distances on the lattice
/// and goes on from these numbers. A case that cannot be judged so is left to the draw itself,
/// which counts.
///
/// path     of the definition
/// options  that `def` was read with
/// throws   CaseError that names a particle distance that fits
void expect_particles_fit(const std::string& path, const CaseOptions& options, const CaseDef& def,
                          int threads);

} // namespace fppg
