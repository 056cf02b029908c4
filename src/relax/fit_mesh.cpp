#include "fppg/fit_mesh.h"

#include "fppg/error.h"
#include "fppg/relax.h"

#include <fmt/format.h>

#include <cmath>

namespace fppg
{

namespace
{

WallParticles walls_of(SurfaceParticles&& fitted)
{
    WallParticles out;
    out.bodies.assign(fitted.positions.size(), 0);
    out.mk.assign(fitted.positions.size(), 0);
    out.positions = std::move(fitted.positions);
    out.kinds = std::move(fitted.kinds);
    out.facets = std::move(fitted.facets);
    return out;
}

} // namespace

FittedMesh fit_mesh(const TriangleSoup& soup, const FitMeshOptions& options)
{
    if (!(options.dp > 0) || !std::isfinite(options.dp))
        throw GeometryError(fmt::format("dp = {:g}: expected a distance above 0", options.dp));
    FittedMesh out;
    FittedBody body;
    body.mesh = repair_mesh(soup, {.dp = options.dp}, options.threads, body.report);
    const FeatureOptions features{.angle_deg = options.feature_angle_deg, .dp = options.dp};
    body.features = find_features(body.mesh, features);
    SurfaceParticles fitted = fit_surface(
        body.mesh, body.features, place_feature_particles(body.mesh, body.features, features),
        {.dp = options.dp, .lattice_origin = {}}, options.threads);
    out.area = body.report.area;
    out.volume = body.report.is_watertight ? body.report.volume : 0;
    out.warnings = body.report.warnings;
    WallParticles particles = walls_of(std::move(fitted));
    const std::vector<FittedBody> bodies{std::move(body)};
    if (options.is_relaxed)
    {
        std::vector<char> held;
        RelaxSurfaceOptions relax;
        relax.dp = options.dp;
        relax.on_progress = [&](const RelaxProgress& progress)
        {
            if (options.on_progress) options.on_progress(progress.iteration);
            return true;
        };
        relax_surface(bodies, particles, held, relax, options.threads);
    }
    for (const std::uint32_t facet : particles.facets)
    {
        const Vec3& n = bodies[0].mesh.normals[facet];
        out.normals.push_back(
            {static_cast<float>(n.x), static_cast<float>(n.y), static_cast<float>(n.z)});
    }
    out.positions = std::move(particles.positions);
    out.kinds = std::move(particles.kinds);
    return out;
}

} // namespace fppg
