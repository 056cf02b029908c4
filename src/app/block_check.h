#pragma once

#include "fppg/case_def.h"
#include "fppg/particles.h"

#include <cstdint>
#include <set>
#include <string>
#include <vector>

namespace fppg
{

/// What a definition says of mks that got no particle, which GenCase v5.4.354 passes over without a
/// word: motions of such an mkbound, and `<floating>`s that have no other (lists of mkbound are
/// often longer than what is drawn: 6 of 207 public definitions).
///
/// mks      absolute, with particles; of a case with `<vres>` those of all zones
/// returns  a sentence an element, with file, line and what was expected
std::vector<std::string> check_mks(const CaseDef& def, const std::set<std::uint16_t>& mks);

/// Parts of a drawn union that do not move together: a fixed one and a moving one, or two with
/// motions of their own. Each particle keeps the mk of its part, so that the wall is torn open when
/// the first of them moves.
std::vector<std::string> check_unions(const CaseDef& def);

/// Fluid with no boundary particle below it, so that gravity takes it out of the domain: by
/// mkfluid, with the number of particles and where they are. Columns of one dp are compared, with
/// those around them. Not told: without boundary particles, without gravity, with gravity along no
/// axis, for zones of `<vres>`, and for cases that are periodic along it or have `<inout>`.
std::vector<std::string> check_floor(const CaseDef& def, const CaseParticles& particles);

} // namespace fppg
