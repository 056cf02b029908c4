#pragma once

#include "fppg/case_def.h"
#include "fppg/particles.h"

namespace fppg
{

/// Mass, centre and inertia of a floating body as GenCase v5.4.354 computes them: massbody =
/// rhopbody * n * dp^dim; masspart = rhop0 * dp^dim, whatever massbound is; centre = mean of the
/// places; inertia of equal point masses massbody / n about the centre, off-diagonal entries with
/// the minus sign, in a flat case too. What the definition gives replaces it. Sums are plain ones
/// of doubles in id order, so that their rounding is GenCase's: it decides which form the inertia
/// has in Case.xml (equal to all printed digits for 670 bodies of public cases). Particles of
/// fitted walls count by their shares (OffLatticeParticles::shares), so that mass, centre and
/// inertia are those of the volume that the body has.
///
/// nodes     with the block; where `<lattice>` doubles particles, those before it: GenCase counts
///           each pair once
/// initials  of the block: the sums are over the places where they leave its particles
/// rhop0     kg/m^3
/// cost      O(particles of the block) time
FloatingBody floating_body(const FloatingDef& def, const CaseParticles& nodes, std::size_t block,
                           const std::vector<InitialOp>& initials, double rhop0);

} // namespace fppg
