#pragma once

#include "fppg/fitted_walls.h"

#include "relax/regions.h"

#include <cstdint>
#include <vector>

namespace fppg
{

/// Particles of layers that move together with those of the volume behind them.
struct SlidingWalls
{
    std::vector<std::uint32_t> particles; ///< indices into FittedWalls::particles, ascending
    /// 1: it slides on its layer; 2: it is on the middle of a thin part and moves freely.
    std::vector<char> slides;
};

/// Those of bodies with Placement::Inside in a region, but for edges, corners and what is held
/// beside cuts.
SlidingWalls find_sliding(const FittedWalls& walls, const Region& region);

/// The place of a particle on its layer that is nearest to p.
Vec3 put_back(const FittedWalls& walls, std::uint32_t particle, const Vec3& p);

} // namespace fppg
