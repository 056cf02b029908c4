#pragma once

#include "fppg/fitted_walls.h"
#include "fppg/lattice.h"

#include "meshes/point_grid.h"
#include "relax/all_walls.h"
#include "relax/regions.h"

namespace fppg
{

/// Adds the empty nodes beside those of a solid that are deep inside it: what a later draw or a
/// void cut out of it. Particles beside them would flow into the cut, as no wall is there.
void add_cut_nodes(const RunField& field, const Region& region, const AllWalls& all, int threads,
                   PointGrid& cut);

} // namespace fppg
