#pragma once

#include "fppg/fit.h"
#include "fppg/lattice.h"

#include "lattice/fitted_draw.h"

#include <vector>

namespace fppg
{

/// Gives flat parts of a layer that lie on a plane of the lattice's nodes these nodes as their
/// particles, up to 0.7 dp from particles on edges and corners and 0.75 dp from those of other
/// parts. Fluid beside them stands on nodes too (lattice_shift()), and walls and fluid are one
/// crystal, as on the lattice: beside rows that are even but run otherwise, water in a tank of
/// 16 x 16 x 12 dp circulates at 0.009 m/s.
///
/// particles  of the layer; those that nodes replace go, nodes come behind the others
/// returns    per particle, whether it is such a node
std::vector<char> take_nodes_on_flats(const FittedBody& layer, const LatticeGrid& grid,
                                      SurfaceParticles& particles);

} // namespace fppg
