#pragma once

#include "fppg/case_def.h"
#include "fppg/files.h"
#include "fppg/fitted_walls.h"

#include <optional>
#include <string>
#include <vector>

namespace fppg
{

/// Says of walls in layers for mDBC how far the polygons of `<norgeometry>` with their mk are from
/// their surface. GenCase's cases often draw walls half a dp behind the surface that normals lead
/// to; fitted walls have theirs where they are drawn, so that fluid has more room.
///
/// bodies   of the case, layers too
/// returns  a sentence with the mks whose polygons are mostly more than 0.05 dp off, and less than
///          2 dp, as what is farther is another thing; nothing where there are none
std::optional<std::string> note_other_surfaces(const CaseDef& def,
                                               const std::vector<FittedBody>& bodies,
                                               const std::vector<ShapePolygons>& geometry,
                                               int threads);

} // namespace fppg
