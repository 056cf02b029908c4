#pragma once

#include "fppg/balance.h"

#include "balance/fluid_at_rest.h"
#include "balance/lattice_fall.h"
#include "balance/wall_pressure.h"

#include <functional>

namespace fppg
{

/// Of walls beside fluid that is brought to rest.
struct RestWalls
{
    const ClosestWallPoint& closest;
    RestBoundary boundary{};
    /// Whether the solver holds fluid that is pressed against them (NoPenetration of mDBC).
    bool keep_out = false;
    /// Whether the first particles of the wall nearest to a place stand half a dp behind its
    /// surface though those of others do not (Placement::Inside); empty: nowhere.
    std::function<bool(const Vec3& place, double within)> is_behind{};
};

/// To walls, that fluid is moved off, in dp.
double least_distance_dp(RestBoundary boundary);

/// Moves particles along their accelerations until these are small, as balance_fluid() says.
///
/// fall          what particles on the lattice keep of gravity
/// on_iteration  ends the work when it returns false; may be empty
/// report        its particles, held ones and is_packed are given, all else is set
void bring_to_rest(FluidAtRest& rest, const LatticeFall& fall, const RestWalls& walls, int threads,
                   const std::function<bool(const BalanceProgress&)>& on_iteration,
                   BalanceReport& report);

} // namespace fppg
