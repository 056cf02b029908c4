#pragma once

#include "fppg/mesh.h"

#include "lattice/spans.h"

namespace fppg
{

/// The nodes inside a closed mesh whose distance to its surface is within [depth_min, depth_max]
/// (rule X3, verified on a cube, an L and an icosphere with GenCase v5.4.354); nothing is snapped.
///
/// depth_min, depth_max  metres; depth_max may be infinite
/// cost                  O(nodes near the two depths), distances being skipped where the surface is
/// far
SlabRegion depth_region(const TriangleSoup& soup, double depth_min, double depth_max,
                        const LatticeGrid& grid, int threads);

} // namespace fppg
