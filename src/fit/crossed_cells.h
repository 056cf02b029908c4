#pragma once

#include "fppg/surface_mesh.h"

#include <array>
#include <cstdint>
#include <vector>

namespace fppg
{

/// The cells of a lattice that a mesh crosses or touches. Cell (i, j, k) is the closed cube with
/// sides dp around the node origin + dp (i, j, k). Sorted; each once.
///
/// throws  GeometryError when the mesh is wider than 2^30 dp
/// source  separating axes of a box and a triangle: T. Akenine-Moller, Fast 3D Triangle-Box Overlap
///         Testing, 2001
/// cost    O(cells) a facet, in columns along the axis that its normal is nearest to
std::vector<std::array<std::int32_t, 3>> find_crossed_cells(const SurfaceMesh& mesh,
                                                            const Vec3& origin, double dp,
                                                            int threads);

} // namespace fppg
