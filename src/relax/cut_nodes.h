#pragma once

#include "fppg/fitted_walls.h"
#include "fppg/lattice.h"

#include "meshes/point_grid.h"
#include "relax/all_walls.h"
#include "relax/regions.h"

namespace fppg
{

/// Nodes this near to a place where a wall was cut do not move, dp.
constexpr double reach_of_cuts_dp = 3;

/// The places beside which particles would flow into a cut, as no wall is there: those where a wall
/// was cut, where a second sheet gave way, and the empty nodes beside those of a solid that are
/// deep inside it, which a later draw or a void cut out of it. For queries up to reach_of_cuts_dp.
PointGrid places_of_cuts(const RunField& field, const Region& region, const AllWalls& all,
                         int threads);

} // namespace fppg
