#include "relax/sliding_walls.h"

#include "offset/middle.h"
#include "offset/offset_surface.h"
#include "relax/wall_planes.h"

#include <algorithm>
#include <cmath>

namespace fppg
{
namespace
{

/// Walls that meet in an edge are no farther from its particles than the layer is deep and so much,
/// dp.
constexpr double edge_room_dp = 0.3;

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
        if (!body.is_inside || !body.is_layer() || region.band[walls.owner_of(b).mk] <= 0) continue;
        if (is_shared(body) ? is_cut[b] != 0 : particles.held[i] != 0) continue;
        out.particles.push_back(i);
        const bool is_free = is_shared(body) && walls.owner_of(b).sheets == 0;
        const bool is_on_face = is_shared(body) || particles.kinds[i] == FitKind::Surface;
        out.motions.push_back(is_free      ? VolumeMotion::Lasting
                              : is_on_face ? VolumeMotion::AlongWall
                                           : VolumeMotion::AlongEdge);
    }
    return out;
}

Vec3 put_back(const FittedWalls& walls, std::uint32_t particle, const Vec3& p, double dp,
              const ClosestWallPoint& closest)
{
    const FittedBody& body = walls.bodies[walls.particles.bodies[particle]];
    if (is_shared(body))
        return on_middle(*body.wall, p,
                         0.65 * walls.owner_of(walls.particles.bodies[particle]).thickness);
    if (walls.particles.kinds[particle] == FitKind::Surface)
        return project_to_depth(*body.wall, p, body.depth);
    Vec3 at = p;
    for (int step = 0; step < 3; ++step)
    {
        const WallPlanes found = find_wall_planes(at, body.depth + edge_room_dp * dp, closest);
        if (found.count != 2) break;
        const WallPlane& a = found.planes[0];
        const WallPlane& b = found.planes[1];
        const double turn = dot(a.normal, b.normal);
        const double off_a = a.distance - body.depth;
        const double off_b = b.distance - body.depth;
        const double size = 1 - turn * turn;
        if (size < 0.1) break;
        const Vec3 way =
            ((off_a - turn * off_b) / size) * a.normal + ((off_b - turn * off_a) / size) * b.normal;
        if (!(norm(way) < edge_room_dp * dp)) break;
        at = at + way;
    }
    return project_to_depth(*body.wall, at, body.depth);
}

void keep_slid(const SlidingWalls& sliding, std::size_t nodes, FittedWalls& walls,
               std::vector<Vec3>& positions, RelaxVolumeReport& done)
{
    WallParticles& particles = walls.particles;
    std::size_t count = 0;
    for (std::size_t i = 0; i < positions.size(); ++i)
    {
        const std::uint32_t source = done.sources[i];
        if (source < nodes)
        {
            positions[count] = positions[i];
            done.sources[count++] = source;
            continue;
        }
        const std::uint32_t wall = sliding.particles[source - nodes];
        if (i < done.kept)
            particles.positions[wall] = positions[i];
        else
        {
            walls.volume.positions.push_back(positions[i]);
            walls.volume.mk.push_back(particles.mk[wall]);
        }
    }
    positions.resize(count);
    done.sources.resize(count);
}

} // namespace fppg
