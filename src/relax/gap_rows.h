#pragma once

#include "fppg/case_def.h"
#include "fppg/lattice.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace fppg
{

/// What closes the gaps between two mks.
struct ClosedGap
{
    std::uint16_t mk = 0;    ///< absolute, of the particles; that which moves, if one does
    std::uint16_t other = 0; ///< on the other side; may be the same
    bool moves = false;
    std::size_t count = 0;
    double least_dp = 0, most_dp = 0; ///< how wide the gaps are
    Vec3 place;                       ///< of the first particle
};

/// Puts a row of boundary particles into the middle of gaps between walls in layers for modified
/// boundaries that are too narrow for fluid: of 0.25 to 0.6 dp, and to 1.25 dp where one wall
/// slides along the other, as a gate over the floor. The first layers on both sides are a dp
/// farther apart than the surfaces, so that fluid runs into such gaps in the solver, though none
/// was put there (v5.4: a slot of 0.5 dp behind a block in water 12 dp deep, largest speed 0.43
/// m/s, with the row 0.004; 0.2 dp: 0.004 without). Where parts turn against each other, float or
/// are flexible gaps stay open.
///
/// field    body-fitted, relaxed; gets the particles in walls.volume and walls.gaps
/// returns  by mks
/// cost     about 1 microsecond a particle of the first layers on one core
std::vector<ClosedGap> close_gaps(const CaseDef& def, RunField& field, int threads);

} // namespace fppg
