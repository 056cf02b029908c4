#pragma once

#include "fppg/fitted_walls.h"
#include "fppg/lattice.h"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace fppg
{

struct NodeIndex
{
    std::uint32_t x = 0;
    std::uint32_t y = 0;
    std::uint32_t z = 0;
    bool operator==(const NodeIndex&) const = default;
};

inline Vec3 place_of(const NodeIndex& n, const LatticeGrid& grid)
{
    return {grid.origin.x + n.x * grid.dp, grid.origin.y + n.y * grid.dp,
            grid.origin.z + n.z * grid.dp};
}

struct Mover
{
    NodeIndex node;
    std::uint16_t mk = 0;
};

/// Nodes of a set of mks that are relaxed together.
struct Region
{
    std::string what;
    std::vector<double> band; ///< per mk, in dp; 0: not of the region
    std::vector<char> beside; ///< per mk: not of the region, but its nodes push
    bool is_solid = false;
    bool fits_count = true; ///< particles come and go (RelaxVolumeOptions::fit_count)
    double h_dp = 1;
    std::optional<int> iterations;
};

/// The mks of solid bodies, those of one body together; ascending by the first of each.
std::vector<std::vector<std::uint16_t>> solid_mks(const std::vector<FittedBody>& bodies);

/// Covers nodes of a slab, sorted by (y, z).
void cover(std::vector<Run>& runs, const std::vector<Mover>& nodes);

/// Puts the particles of two sets of bodies together again by body.
WallParticles join(const WallParticles& a, const WallParticles& b);

} // namespace fppg
