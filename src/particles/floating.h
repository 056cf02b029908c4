#pragma once

#include "fppg/case_def.h"
#include "fppg/particles.h"

namespace fppg
{

/// Mass, centre and inertia of a floating block as GenCase computes them (rules F2, F3): massbody =
/// rhopbody * n * dp^dim; masspart = massbound; centre = mean of the positions; inertia of equal
/// point masses massbody / n about the centre, off-diagonal entries with the minus sign; in a flat
/// case with y left out. What the definition gives replaces it. Sums over nodes are exact, in whole
/// numbers of dp; those over particles off the lattice are of doubles, in id order. Particles of
/// fitted walls count by their shares (FreeParticles::shares), so that mass, centre and inertia are
/// those of the volume that the body has.
FloatingBody floating_body(const FloatingDef& def, const CaseParticles& particles,
                           std::size_t block, double mass_bound);

} // namespace fppg
