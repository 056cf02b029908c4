#pragma once

#include "fppg/fitted_walls.h"
#include "fppg/lattice.h"

#include "relax/all_walls.h"
#include "relax/regions.h"

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

namespace fppg
{

/// A lattice that goes along the faces of a body, however the body is turned: between the outermost
/// faces stands a whole number of particles, half a step from them, each for dp^3 (2D: dp^2).
struct OwnLattice
{
    std::array<Vec3, 3> axes; ///< unit vectors; in 2D the second is y
    Vec3 corner;              ///< where the first particle stands
    std::array<double, 3> steps{};
    std::array<std::size_t, 3> counts{};
    double dp = 0; ///< metres
};

/// Those of bodies with Placement::Inside, by index. None for a body of sheets, of several mks,
/// that is cut, that has more than two million nodes, or less than half of whose surface goes along
/// three directions at right angles, as for a ball.
std::vector<std::optional<OwnLattice>> own_lattices(const FittedWalls& walls,
                                                    const LatticeGrid& grid);

/// Whether a body of an mk has one.
bool has_own_lattice(const FittedWalls& walls,
                     const std::vector<std::optional<OwnLattice>>& lattices, std::uint16_t mk);

/// Puts nodes that move on the own lattice of their body: as many places of it as there are nodes,
/// those first that are far from the layers. Straight and turned, a beam then has the same
/// particles. A body stays as it is where its lattice has too few places.
///
/// movers     of a region, in the order of nodes
/// positions  of the movers; changed
void move_to_own_lattices(const FittedWalls& walls,
                          const std::vector<std::optional<OwnLattice>>& lattices,
                          const AllWalls& all, const std::vector<Mover>& movers,
                          std::vector<Vec3>& positions, int threads);

} // namespace fppg
