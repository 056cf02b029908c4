#pragma once

#include "fppg/fit.h"
#include "fppg/lattice.h"

#include "lattice/fitted_draw.h"

#include <vector>

namespace fppg
{

/// Gives flat parts of a surface or layer that lie on a plane of the lattice's nodes, and whose
/// edges are a step from these, the nodes as their particles. Fluid beside them stands on nodes too
/// (lattice_shift()), and walls and fluid are one crystal, as on the lattice: beside even rows that
/// run otherwise, water in a tank of 16 x 16 x 12 dp moves twice as fast in the first half second
/// (mDBC: mean 0.0066 m/s, beside nodes 0.0034). DBC, 16 x 14 x 30 dp, after 0.2 s: 0.0050, 0.0041.
///
/// least_matched  of the particles on the edges around a plane, how many must be a step from its
///                outermost nodes, 0 to 1; with fewer, nodes near the edges that do not fit go. No
///                nodes where fewer than 0.6 (2D: 0.5) fit, where less than half of the nodes are
///                left, and in 2D where they would leave a gap
/// particles      of the layer; those that nodes replace go, nodes come behind the others
/// returns        per particle, whether it is such a node
std::vector<char> take_nodes_on_flats(const FittedBody& layer, const LatticeGrid& grid,
                                      double least_matched, SurfaceParticles& particles);

} // namespace fppg
