#include "relax/sliding_walls.h"

#include "offset/offset_surface.h"

#include <algorithm>

namespace fppg
{
namespace
{

/// A layer in the middle of thin parts, which both sides share.
bool is_shared(const FittedBody& body)
{
    return body.is_layer() && body.mesh.facets.empty();
}

} // namespace

SlidingWalls find_sliding(const FittedWalls& walls, const Region& region)
{
    std::vector<char> is_cut(walls.bodies.size(), 0);
    for (const std::uint32_t b : walls.cut_bodies) is_cut[b] = 1;
    SlidingWalls out;
    const WallParticles& particles = walls.particles;
    for (std::uint32_t i = 0; i < particles.size(); ++i)
    {
        const std::uint32_t b = particles.bodies[i];
        const FittedBody& body = walls.bodies[b];
        if (!body.is_inside || !body.is_layer() || region.band[walls.owner_of(b).mk] <= 0 ||
            particles.kinds[i] != FitKind::Surface)
            continue;
        if (is_shared(body) ? is_cut[b] != 0 : particles.held[i] != 0) continue;
        out.particles.push_back(i);
        out.slides.push_back(is_shared(body) ? 2 : 1);
    }
    return out;
}

Vec3 put_back(const FittedWalls& walls, std::uint32_t particle, const Vec3& p)
{
    const FittedBody& body = walls.bodies[walls.particles.bodies[particle]];
    return project_to_depth(*body.wall, p, body.depth);
}

} // namespace fppg
