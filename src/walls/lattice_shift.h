#pragma once

#include "fppg/scene.h"
#include "fppg/vec.h"

namespace fppg
{

struct LatticeMove
{
    Vec3 shift; ///< metres, from 0 to below dp along each axis
    /// LatticeReport::flooded, drawn on the lattice where it is.
    std::vector<SpanSet> flooded;
};

/// How far the lattice of a case moves so that fluid stands half a dp off flat walls in layers, as
/// it does between them at rest: then it starts as a crystal there, which mDBC holds. Where it
/// stands a whole dp off, rows are missing or too many and currents stay (StillWedge of the public
/// mDBC cases in the solver after 2 s: mean speed 0.0107 m/s, moved 0.0019).
///
/// An axis moves to the walls across it that have most of the area beside fluid; periodic ones
/// stay. Nothing moves where something else than fluid stands on the lattice or depends on its
/// place: walls that are not fitted, inlets, zones of vres; nor where fluid is not relaxed.
///
LatticeMove lattice_move(const Scene& scene, int threads);

/// Moves the lattice, which then begins and ends less than dp beyond the domain. Fills then reach
/// only nodes within dp of those that they reach without: a gap of a step, beside a piston or
/// a gate, has no node between the nodes of its walls, but one in the moved lattice, through which
/// water would get behind them (public WavesFrCylinder: 15,099 particles).
///
/// scene  of the case before
void move_lattice(const LatticeMove& move, int threads, CaseDef& def, Scene& scene);

} // namespace fppg
