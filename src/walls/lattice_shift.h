#pragma once

#include "fppg/scene.h"
#include "fppg/vec.h"

#include "walls/fluid_ends.h"
#include "walls/lattice_stretch.h"

namespace fppg
{

struct LatticeMove
{
    Vec3 shift;             ///< metres, from 0 to below dp along each axis
    LatticeStretch to;      ///< behind that
    WetPlanesOfAxes planes; ///< of the walls that it is moved to
    /// LatticeReport::flooded, drawn on the lattice where it is.
    std::vector<SpanSet> flooded;

    bool is_none() const;
};

/// How far the lattice of a case moves, and how its steps change, so that fluid stands off flat
/// walls as it does at rest: half a dp off walls in layers for mDBC, whose first particles are half
/// a dp behind the surface, a whole dp off walls of DBC, whose first particles are on it. Walls and
/// fluid then start as a crystal. Else rows are missing or too many, and currents stay. In the
/// solver, mean speed: StillWedge of the public mDBC cases after 2 s 0.0107 m/s, moved 0.0019;
/// tanks of DBC in 2D whose walls are halfway between nodes, 40 dp wide and 20, 50, 100 dp deep,
/// after 0.1 s 0.0116, 0.0122, 0.0129, moved 0.0019, 0.0021, 0.0042 (GenCase's particles 0.0226,
/// 0.0092, 0.0061).
///
/// An axis moves to the walls across it that have most of the area beside fluid; periodic ones
/// stay. Nothing moves where something else than fluid stands on the lattice or depends on its
/// place: walls that are not fitted, zones of vres, inlets that their shape gives; nor where fluid
/// is not relaxed. Particles that are an inlet move with it, across the way in which fluid comes
/// in, and it is not stretched: as much fluid goes in as they stand for.
///
LatticeMove lattice_move(const Scene& scene, int threads);

/// Moves and stretches the lattice, which then begins and ends less than dp beyond the domain.
/// Fills then reach only nodes within dp of those that they reach without: a gap of a step, beside
/// a piston or a gate, has no node between the nodes of its walls, but one in the moved lattice,
/// through which water would get behind them (public WavesFrCylinder: 15,099 particles).
///
/// scene  of the case before
void move_lattice(const LatticeMove& move, int threads, CaseDef& def, Scene& scene);

} // namespace fppg
