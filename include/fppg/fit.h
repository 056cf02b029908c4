#pragma once

#include "fppg/features.h"
#include "fppg/surface_mesh.h"

#include <cstdint>
#include <vector>

namespace fppg
{

enum class FitDensity : std::uint8_t
{
    Area, ///< one particle per dp^2 of surface
    Cell, ///< one per crossed cell, as the paper: 1.0 to 1.7 per dp^2 by tilt
};

struct FitOptions
{
    double dp = 0;       ///< metres, above 0
    Vec3 lattice_origin; ///< a node of the background lattice; FitDensity Cell only
    FitDensity density = FitDensity::Area;
};

enum class FitKind : std::uint8_t
{
    Corner = 0,
    Edge = 1,
    Surface = 2,
    Volume = 3,
};

/// Particles on a surface, one entry each in all arrays; corners first, then edge, then surface
/// particles. Corners and edges are the given feature particles, each kind in the given order.
struct SurfaceParticles
{
    std::vector<Vec3> positions;
    std::vector<FitKind> kinds;
    std::vector<std::uint32_t> facets; ///< a facet of the mesh that the particle lies on
};

/// Particles on the true surface of a mesh: those of its features, and between them one per dp^2 or
/// one a crossed cell. Positions lie on the facets to rounding of double.
///
/// Area: no surface point is farther than 0.92 dp from a particle, and no surface particle is
/// nearer than 0.86 dp to another particle of its sheet; before relaxation, 0.9 to 1.15 particles a
/// dp^2. Facets whose normals are more than 120 degrees apart are of two sheets: both sides of a
/// plate are covered, however thin it is; but edges and corners of another sheet, and the other
/// side of a gap, that are nearer than 0.6 dp count as of the same sheet. Feature edges and edges
/// without exactly two facets end a surface. A part narrower than half a dp has one particle for
/// all its sides, unless another is near.
///
/// Cell: every cell of the lattice (the cube of side dp around each node) that a facet crosses or
/// touches is mapped to the surface point nearest to its node; points within 0.001 dp of another
/// count once. They may lie arbitrarily close.
///
/// mesh, features, feature_particles  belong together, as repair_mesh(), find_features() and
///                                    place_feature_particles() made them
/// threads  number of threads; the result does not depend on it
/// throws   GeometryError for Cell when the mesh has no facet or spans more than 2^30 dp
/// source   a hexagonal front of spacing 1.075 dp that starts from rows 0.93 dp off the feature
///          lines, then farthest-point insertion in the holes; constants by trial on ten shapes
/// cost     about 0.6 microseconds per particle on one core, 50 bytes per particle at its peak;
///          more where features crowd or facets are far smaller than dp
SurfaceParticles fit_surface(const SurfaceMesh& mesh, const Features& features,
                             const std::vector<FeatureParticle>& feature_particles,
                             const FitOptions& options, int threads);

} // namespace fppg
