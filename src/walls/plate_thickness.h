#pragma once

#include "fppg/lattice.h"
#include "fppg/surface_mesh.h"

#include "walls/layer_builder.h"

#include <vector>

namespace fppg
{

/// Thinner, the layers half a step behind both sides of a plate are one, dp.
inline constexpr double plate_dp = 1 + merge_dp;
inline constexpr double least_thickness_dp = 1e-6; ///< of sides that lie on each other
/// Of the surface of a plate; the rest is its rim, or thicker parts that it is joined to.
inline constexpr double least_plate_share = 0.5;

/// Whether a surface has so little volume for its area that half of it may be thin.
bool may_be_plate(const TriangleSoup& soup, double dp);

/// Per facet how thick the body is behind it, metres; infinite where it is thicker than plate_dp,
/// and in 2D of facets across the plane of the particles.
std::vector<double> plate_thicknesses(const SurfaceMesh& mesh, const LatticeGrid& grid,
                                      int threads);

} // namespace fppg
