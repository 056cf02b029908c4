#pragma once

#include "fppg/case_def.h"
#include "fppg/lattice.h"
#include "fppg/particles.h"
#include "fppg/vec.h"

#include <cstddef>
#include <functional>
#include <string>

namespace fppg
{

/// Accelerations of the particles that balance_fluid() moves, over that of gravity; where they are
/// on the lattice of the case, less those of a lattice at their depth.
struct Accelerations
{
    double mean = 0;
    double of_99 = 0; ///< 99 in 100 are below
    double largest = 0;
    double above_5 = 0; ///< how many are above 0.05, 0 to 1
};

struct BalanceProgress
{
    int iteration = 0; ///< from 1
    int last_iteration = 0;
    double mean_acceleration = 0; ///< over gravity
};

/// Cases with no more particles of fluid have all of it balanced that is joined to fluid near
/// fitted walls, but for what is beside other walls. Where fluid near walls has left the lattice it
/// slides along the rest if that stays (2D, 30 dp deep, stairs off the lattice, DBC, after 0.3 and
/// 1 s: mean 0.0093 and 0.0123 m/s; all balanced 0.0019, and 0.0033 after 1 s; GenCase's particles
/// 0.0056 and 0.0122). To balance 3 million takes two minutes on two cores, two to three times as
/// long as what is near walls alone, and 1.2 kB a particle.
inline constexpr std::size_t most_balanced_whole = 3'000'000;

struct BalanceReport
{
    std::size_t particles = 0; ///< near walls, that may move; all else here is of them
    std::size_t held = 0;    ///< of the fluid near walls, as a free face that is not level is near
    std::size_t falling = 0; ///< the same, as the walls there do not hold it
    Vec3 fastest;            ///< where such fluid has the largest acceleration
    int iterations = 0;
    bool is_packed = false;   ///< all fluid is on lattices that are more stable
    bool is_balanced = false; ///< false: accelerations stay too large, the fluid is left as it was
    Accelerations before, after;
    double mean_move_dp = 0;
    double largest_move_dp = 0;
    std::string why_not; ///< empty; else why nothing was done
};

/// Moves fluid near fitted walls to where the solver's own forces at rest are those on a lattice of
/// fluid, and gives boundary particles near fluid the pressure of their depth.
///
/// Particles that are spread evenly are not at rest in SPH: kernels end at the free surface and at
/// the particles of walls, and the sums of the pressure differ from its gradient there. The
/// equations are those of DualSPHysics v5.4 (JSphCpu.cpp, InteractionForcesFluid):
///   a_i = g - sum_j m_j (p_i + p_j) / (rho_i rho_j) grad W(x_i - x_j),
/// p the hydrostatic pressure rho0 g (level - height) below the level of the particle's column,
/// half a dp above its highest particle; rho by the equation of state. Boundary particles have the
/// pressure of their depth (DBC), 0 above the level; or what mDBC gives them at each step from the
/// fluid around their ghost nodes (JSphCpu_mdbc.cpp). Steps follow the acceleration, scaled with
/// h^2 rho / p, the first 40 with Anderson's mixing (balance/anderson_mixing.h), all others with
/// momentum (heavy ball, factors 0.3 and 0.9); none is longer than 0.05 dp, no particle moves
/// farther than one dp in all (4 dp on another lattice), none comes nearer to a wall than 0.5 dp
/// (mDBC: 0.2 dp) or than it was, none higher than 0.25 dp below its level.
///
/// Walls thinner than the kernel push less than fluid presses against them, and it comes as near as
/// it may. Where the solver holds it there (NoPenetration of mDBC) that part of its acceleration
/// is not counted: beside a plate of 2.2 dp, 50 dp deep, 0.0019 instead of 0.037 g are left, and
/// the solver has 0.0006 instead of 0.0039 m/s on average after 0.02 s.
///
/// On a lattice a_i is not quite zero: it falls by 0.004 to 0.03 g. Fluid that stays there
/// has that acceleration, and so has all that is moved: where it was brought to zero,
/// fluid beside walls slid along the rest at 0.01 to 0.03 g (2D tanks of 50 dp: mean speed after
/// 0.2 s 0.0066 m/s, now 0.0012).
///
/// Where all fluid is moved and none held it is laid on the most stable lattice first
/// (balance/stable_packing.h), unless that is the cubic one, and brought to rest without a fall.
/// It keeps its numbers and levels; ids of one mk go along x, then y, then z. Where more than 0.01
/// g is left in the mean, its own lattice is tried too, and the one that leaves less is taken.
///
/// Fluid of a free face that is not level stays, with all within 2h of it: it is meant to fall, as
/// in a dam break. So does fluid across a border of the case. Where accelerations stay above 0.1 g
/// in the mean, what keeps 0.25 g stays, with all within 2h of it, and the rest is balanced beside
/// it; all of it stays where that is more than 0.6 of the fluid near walls. A single sheet of DBC,
/// behind which nothing pushes, holds none at rest (raising its pressures as the solver does made a
/// tank of sheets worse: mean speed 0.12 instead of 0.076 m/s).
///
/// normals    of `particles` must have been made where the case asks for them
/// particles  fluid nodes that move become particles off the lattice, with the ids that they had
/// threads    number of threads; the result does not depend on it
/// on_iteration  ends the work when it returns false; may be empty
/// source     trials in tools/solver-trials; a tank of still water at dp 0.0125 m, largest speed in
///            0.2 s: DBC 0.080 m/s on the lattice, 0.013 balanced; mDBC in layers 0.114 m/s with
///            fluid that is only even, 0.019 balanced
/// cost       at most 1000 iterations (balance/iterations.h), 20 where walls do not hold the fluid.
///            On one core 0.1 milliseconds a particle where there are 480,000, 1 for a few thousand
BalanceReport balance_fluid(const CaseDef& def, const RunField& field,
                            const CaseConstants& constants, CaseParticles& particles, int threads,
                            const std::function<bool(const BalanceProgress&)>& on_iteration);

} // namespace fppg
