#pragma once

#include "files/particle_source.h"
#include "fppg/compare.h"

#include <string>

namespace fppg
{

/// Whether the particles of a result stand on one lattice of this dp, all but one in a thousand of
/// a sample of 20,000, and all but 19.
bool is_on_lattice(const ParticleSource& source, double dp);

/// Why two results cannot be of one case, or nothing: with a hundred particles and more in both,
/// they have no mk in common; the boxes around their particles share less than a tenth of what they
/// cover together; or the dps differ and the boxes share less than half.
std::string why_unrelated(const Comparison& comparison);

} // namespace fppg
