#pragma once

#include "fppg/features.h"
#include "fppg/surface_mesh.h"

#include <cstdint>
#include <vector>

namespace fppg
{

enum class FitDensity : std::uint8_t
{
    Area, ///< one particle a dp^2 of surface
    Cell, ///< one a crossed cell of the background lattice, as the paper
};

struct FitOptions
{
    double dp = 0; ///< metres
    Vec3 lattice_origin;
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
/// particles.
struct SurfaceParticles
{
    std::vector<Vec3> positions;
    std::vector<FitKind> kinds;
    std::vector<std::uint32_t> facets; ///< a facet that the particle lies on
};

/// Particles on the true surface of a mesh: those of its features, and between them one a dp^2
/// (FitDensity Area), without holes: no surface point is farther than 0.92 dp from a particle, no
/// two particles of one sheet are closer than 0.3 dp. Positions lie on the facets to rounding.
///
/// threads  number of threads; the result does not depend on it
SurfaceParticles fit_surface(const SurfaceMesh& mesh, const Features& features,
                             const std::vector<FeatureParticle>& feature_particles,
                             const FitOptions& options, int threads);

} // namespace fppg
