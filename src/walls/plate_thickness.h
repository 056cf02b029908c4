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

/// Whether a surface has so little volume for its area that half of it may be thin.
bool may_be_plate(const TriangleSoup& soup, double dp);

struct PlateThickness
{
    /// Per facet how thick the body is behind it, metres; infinite where it is thicker than asked
    /// for, and in 2D of facets across the plane of the particles.
    std::vector<double> of_facets;
    double least = 0; ///< metres; infinite: nothing is thin
    double area = 0;  ///< of the surface, m2
    /// At least half of the surface is thin; the rest is a rim, or thicker parts that it is joined
    /// to.
    bool is_plate = false;
};

/// thin_dp  what is thicker is not thin, dp
PlateThickness plate_thickness(const SurfaceMesh& mesh, const LatticeGrid& grid, int threads,
                               double thin_dp = plate_dp);

} // namespace fppg
