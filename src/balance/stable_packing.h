#pragma once

#include "fppg/particles.h"

#include "balance/fluid_at_rest.h"

#include <optional>

namespace fppg
{

/// What packed_stably() has to know of walls.
struct PackedWalls
{
    const ClosestWallPoint& closest;
    double least_distance = 0; ///< of particles of fluid, metres
    double gap = 0;            ///< between a wall and the volume of the fluid, metres
};

/// Lays fluid at rest on the lattice that is the most stable under pressure (lattice_stability.h),
/// fitted to the bounds of each body of fluid, its layers level. Bounds are flat walls where fluid
/// ends at these, else half a dp beyond its nodes. Layers are a little lower than on a lattice of
/// equal steps, so that their midst is at rest.
///
/// A square or cubic lattice is at rest under pressure, but not stable for most smoothing lengths:
/// its rows slide along one another, twice as fast every 0.05 s where it is 50 dp deep, and after a
/// second it moves as much as GenCase's particles. 2D, 40 x 50 dp, h = 1.7 dp, DBC, mean speed
/// after 0.1, 0.5 and 1 s: hexagonal 0.0004, 0.0005 and 0.0004 m/s, square 0.0004, 0.0068 and
/// 0.0116. 3D, 16 x 16 dp, 10 deep, h = 1.73 dp, after 0.1 and 1 s: layers 0.57 of their step apart
/// 0.0001 and 0.0002 m/s, face-centred cubic (0.71) 0.0003 and 0.0007, GenCase's cubic 0.0155 and
/// 0.0041.
///
/// Each body of fluid keeps its number of particles, and so does each mk. Places are taken where
/// fluid was: where the sum of a kernel over its particles is at least half of that in their midst.
/// The lattice is made coarser or finer until it has up to 2 % more of them than there are
/// particles (6 % where none has); these are left out of the highest rows, where pressures are
/// lowest. Places nearer to walls than their `least_distance` are moved off them. What is left to
/// do near walls that do not fit the lattice, balancing does.
///
/// Bodies of fluid no thicker than 3 dp, or spread over bounds 20 times as large, stay as they are.
/// Nothing is returned where no lattice is more stable than the cubic one, where less than 95 % of
/// the fluid is packed, where fluid is held, along which what is packed would slide, or where
/// gravity is along no axis.
///
/// rest       all fluid that moves, and what is around; ids, levels and roles go along
/// particles  whose blocks say which ids have which mk
/// source     trials in tools/solver-trials, "What they showed of stable lattices"
std::optional<FluidAtRest> packed_stably(const FluidAtRest& rest, const CaseParticles& particles,
                                         const PackedWalls& walls, int threads);

} // namespace fppg
