#pragma once

#include "fppg/fitted_walls.h"
#include "fppg/relax_volume.h"

#include "relax/regions.h"

#include <cstdint>
#include <vector>

namespace fppg
{

/// Particles of layers that move together with those of the volume behind them.
struct SlidingWalls
{
    std::vector<std::uint32_t> particles; ///< indices into FittedWalls::particles, ascending
    std::vector<VolumeMotion> motions;
};

/// Those of bodies with Placement::Inside in a region, but for what is held beside cuts: surface
/// particles slide on their layer, those of edges and corners along edges; those on the middle of a
/// thin part are free.
SlidingWalls find_sliding(const FittedWalls& walls, const Region& region);

/// The place of a particle on its layer, or on the edge of it, that is nearest to p.
Vec3 put_back(const FittedWalls& walls, std::uint32_t particle, const Vec3& p, double dp,
              const ClosestWallPoint& closest);

/// Puts wall particles that slid to their new places; those of the volume stay in `positions`.
///
/// nodes  the first of `positions` were nodes, the others `sliding`; inserted ones come last
void keep_slid(const SlidingWalls& sliding, std::size_t nodes, FittedWalls& walls,
               std::vector<Vec3>& positions, RelaxVolumeReport& done);

} // namespace fppg
