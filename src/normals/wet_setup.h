#pragma once

#include "fppg/case_def.h"
#include "fppg/particles.h"

#include "normals/wet_surface.h"

namespace fppg
{

/// What the wet surface of a case depends on: which mks move, float, and turn over.
///
/// reach  metres, 2 h
WetSurface::Setup wet_setup(const CaseDef& def, const CaseParticles& particles, double reach);

} // namespace fppg
