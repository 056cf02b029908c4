#pragma once

#include "fppg/vec.h"

#include <cstddef>
#include <cstdint>
#include <map>
#include <vector>

namespace fppg
{

/// A place between walls that is too narrow for fluid and is left empty.
struct FluidPocket
{
    Vec3 center;             ///< of its volume, metres
    double volume = 0;       ///< between the true walls, m3 (2D: of a slice dp thick)
    double narrowest_dp = 0; ///< between the walls
    std::size_t nodes = 0;   ///< of fluid that were there
};

/// The space between body-fitted walls beside fluid; volumes in m3 (2D: of a slice dp thick).
struct FluidSpace
{
    /// By mk of the fluid: the volume between it and the walls beside it that its nodes do not
    /// stand for (dp^3 each), less what they stand for behind walls. Pockets do not count.
    std::map<std::uint16_t, double> missing;
    /// Of the volume that is missing, what is beside fluid that stays on the lattice at buffers of
    /// `<vres>` and zones of `<inout>`, so that nothing may come there. At the ends of a period
    /// fluid spreads in the run.
    double missing_at_zones = 0;
    std::map<std::uint16_t, std::size_t> nodes;    ///< by mk of the fluid, those that stay
    std::map<std::uint16_t, std::size_t> left_out; ///< by mk of the fluid: in pockets
    double pocket_dp = 0; ///< walls nearer to one another have a pocket between them, if none moves
    std::vector<FluidPocket> pockets; ///< the largest first
    std::vector<Vec3> pocket_places;  ///< of the nodes that were in pockets, ascending x, y, z
};

} // namespace fppg
