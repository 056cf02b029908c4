#pragma once

#include "fppg/element.h"
#include "fppg/particles.h"

namespace fppg
{

/// `<motion>` of Case.xml from that of the definition, as GenCase v5.4.354 rewrites it (seen on a
/// case with all forms of its template):
/// - `<objreal ref>` counts mkbound in, moving blocks (ref_motion) out; one without a moving block
///   is dropped, and an `<obj>` in which nothing is left. Where a dropped objreal holds others that
///   move, it stays as `<obj>`, because they move with it.
/// - Movements that no `<begin>` reaches, itself or by `next`, are dropped; so are comments.
/// - `<begin>` come first, then movements, then objects; each keeps the attributes and the first of
///   the children that it needs, in a fixed order, with units_comment. `next="0"`, a `finish` and a
///   field below 0 are left out; mvrotadvfile and mvpathfile get their defaults written.
/// - `anglesunits` is written where a movement has angles (default degrees). mvpredef and mvfile
///   become mvrectfile; of mvnull the id alone stays.
/// (90 movements.)
///
/// motion  `<motion>` of the definition with numbers evaluated; an empty name: none
Element case_motion(const Element& motion, const std::vector<ParticleBlock>& blocks);

} // namespace fppg
