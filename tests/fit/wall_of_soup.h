#pragma once

#include "fit/inside_angles.h"
#include "fppg/exclusion_band.h"
#include "fppg/features.h"
#include "fppg/fit.h"

#include <cmath>
#include <string>
#include <vector>

namespace fppg::test
{

/// A mesh from its triangles to the nodes around its fitted wall.
struct FittedMesh
{
    MeshReport report;
    std::size_t wall_particles = 0;
    LatticeGrid grid;
    ExclusionBand zone;
    std::vector<std::string> warnings; ///< of intake and zone

    std::size_t volume_nodes() const
    {
        std::size_t count = 0;
        for (const auto& slab : zone.volume.slabs)
            for (const Span& span : slab) count += span.z_end - span.z_begin;
        return count;
    }
    /// Nodes and wall particles of the body, metres cubed.
    double volume() const
    {
        return (static_cast<double>(volume_nodes()) +
                static_cast<double>(wall_particles) * zone.wall_share_inside) *
               grid.dp * grid.dp * grid.dp;
    }
};

/// A lattice around a box whose nodes lie `shift` dp beside whole multiples of dp.
inline LatticeGrid lattice_around(const Box3& bounds, double dp, double shift)
{
    LatticeGrid grid;
    grid.dp = dp;
    for (int axis = 0; axis < 3; ++axis)
    {
        grid.origin[axis] = (std::floor(bounds.min[axis] / dp) - 3 + shift) * dp;
        grid.n[static_cast<std::size_t>(axis)] =
            static_cast<std::uint32_t>(std::ceil((bounds.max[axis] - grid.origin[axis]) / dp) + 3);
    }
    return grid;
}

/// dp  metres; 0: a fortieth of the longest side of the mesh
inline FittedMesh fit_soup(const TriangleSoup& soup, double dp = 0, double shift = 0.3,
                           int threads = 1)
{
    FittedMesh result;
    const SurfaceMesh mesh = repair_mesh(soup, {}, threads, result.report);
    const Vec3 size = result.report.bounds.max - result.report.bounds.min;
    if (dp == 0) dp = std::max({size.x, size.y, size.z}) / 40;
    FeatureOptions feature_options;
    feature_options.dp = dp;
    const Features features = find_features(mesh, feature_options);
    FitOptions fit_options;
    fit_options.dp = dp;
    const SurfaceParticles particles =
        fit_surface(mesh, features, place_feature_particles(mesh, features, feature_options),
                    fit_options, threads);
    result.wall_particles = particles.positions.size();
    result.grid = lattice_around(result.report.bounds, dp, shift);
    ExclusionBandOptions options;
    options.wall_particles = result.wall_particles;
    options.share_inside =
        mean_share_inside(mesh, {particles.positions, particles.kinds, particles.facets}, false);
    result.zone = exclusion_band(mesh, result.report, result.grid, options, threads);
    result.warnings = result.report.warnings;
    result.warnings.insert(result.warnings.end(), result.zone.warnings.begin(),
                           result.zone.warnings.end());
    return result;
}

} // namespace fppg::test
