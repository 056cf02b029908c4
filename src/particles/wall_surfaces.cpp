#include "particles/wall_surfaces.h"

#include "meshes/cad_surface.h"
#include "meshes/round_surface.h"
#include "offset/wall_depth.h"

namespace fppg
{
namespace
{

std::array<float, 3> as_floats(const Vec3& v)
{
    return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)};
}

} // namespace

WallSurfaces::WallSurfaces(const FittedWalls& walls) : walls_(walls)
{
    std::vector<char> has_features(walls.bodies.size(), 0);
    for (std::size_t i = 0; i < walls.particles.size(); ++i)
        if (walls.particles.kinds[i] == FitKind::Corner ||
            walls.particles.kinds[i] == FitKind::Edge)
            has_features[walls.particles.bodies[i]] = 1;
    normals_.resize(walls.bodies.size());
    for (std::size_t b = 0; b < walls.bodies.size(); ++b)
        if (has_features[b] != 0 && !walls.bodies[b].is_layer())
            normals_[b] = std::make_unique<PseudoNormals>(walls.bodies[b].mesh);
}

SurfacePlace WallSurfaces::at(std::size_t particle) const
{
    const WallParticles& particles = walls_.particles;
    const std::size_t b = particles.bodies[particle];
    const std::uint32_t facet = particles.facets[particle];
    const Vec3& p = particles.positions[particle];
    if (walls_.bodies[b].is_layer())
    {
        const DepthPlace place = walls_.bodies[b].wall->at(p);
        const Vec3 way = place.nearest - p;
        const double distance = norm(way);
        return {as_floats(distance > 0 ? way / distance : -place.direction),
                static_cast<float>(-distance)};
    }
    Vec3 normal = exact_normal(walls_.bodies[b], p, facet);
    const FitKind kind = particles.kinds[particle];
    const auto& cad = walls_.bodies[b].cad;
    const auto of_edge = cad != nullptr && kind == FitKind::Edge
                             ? cad->edge_normal(walls_.bodies[b].mesh, p, facet)
                             : std::nullopt;
    if (of_edge)
        normal = *of_edge;
    else if (kind == FitKind::Corner || kind == FitKind::Edge)
    {
        const PseudoNormals& normals = *normals_[b];
        const Vec3 mean = kind == FitKind::Corner
                              ? normals.at(facet, {normals.nearest_corner(facet, p), -1})
                              : normals.at(facet, {-1, normals.nearest_side(facet, p)});
        // Below this length the direction is that of rounding errors.
        if (norm(mean) > 1e-6) normal = mean / norm(mean);
    }
    return {as_floats(normal), static_cast<float>(exact_distance(walls_.bodies[b], p, facet))};
}

} // namespace fppg
