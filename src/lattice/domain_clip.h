#pragma once

#include "fppg/mesh.h"
#include "fppg/vec.h"

namespace fppg
{

/// Cuts triangles at a box: what lies outside is left out, a triangle across a side is cut there
/// and the rest of it drawn as triangles of its first corner. Nothing closes the cut.
///
/// returns  uncut triangles as they were, in the same order
TriangleSoup clip_to_box(const TriangleSoup& soup, const Box3& box);

} // namespace fppg
