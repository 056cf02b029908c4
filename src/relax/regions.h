#pragma once

#include "fppg/case_def.h"
#include "fppg/fitted_walls.h"
#include "fppg/fluid_space.h"
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
    return grid.place(n.x, n.y, n.z);
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
    /// So many more are wanted than move now, as their number is given; empty: as many as fit.
    std::optional<std::size_t> missing;
    std::vector<Vec3> left_empty; ///< where particles would fit that are not wanted, metres
    double h_dp = 1;
    std::optional<int> iterations;
};

/// All fluid near walls: as many as fit. Where a fill gives it its litres, their number stays what
/// it was before pockets were emptied, unless several fluids would have to share that.
Region fluid_region(const CaseDef& def, const FluidSpace& space);

/// The mks of solid bodies, those of one body together; ascending by the first of each.
std::vector<std::vector<std::uint16_t>> solid_mks(const std::vector<FittedBody>& bodies);

/// How many particles of fluid make up the volume that layers behind the surface leave to it. What
/// a stretched lattice is off by stays, up to half a percent: it would tear the crystal that it is.
///
/// moving   particles that move now
/// returns  nothing where so many are missing that they cannot come among those that move
std::optional<double> number_between_layers(const FluidSpace& space, std::size_t moving,
                                            const LatticeGrid& grid);

/// Covers nodes of a slab, sorted by (y, z).
void cover(std::vector<Run>& runs, const std::vector<Mover>& nodes);

/// Puts the particles of two sets of bodies together again by body.
WallParticles join(const WallParticles& a, const WallParticles& b);

} // namespace fppg
