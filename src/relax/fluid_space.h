#pragma once

#include "fppg/case_def.h"
#include "fppg/fluid_space.h"
#include "fppg/lattice.h"

#include "relax/all_walls.h"

namespace fppg
{

/// Measures the space beside fluid on nodes and takes fluid out of pockets: places where the
/// largest ball that touches two opposite walls is narrower than 1.5 dp (between layers 0.6 dp),
/// or than 2 dp where one of them moves past the other (between layers 1.25 dp where it does not
/// turn). Their nodes are covered.
///
/// Opposite are walls whose normals at the ball are more than 120 degrees apart, so that corners
/// are no pockets. Pockets whose cells touch are one. Fluid of mks for which the case has no active
/// `<fluidband>` stays.
///
/// The volume is that of the lattice's cells that walls cut, each by the plane of the nearest wall;
/// cells near two walls or beside an edge are cut up first. A place belongs to the fluid that
/// stands 2 dp off the wall, or in the middle between two walls: so the space ends half a dp above
/// the fluid's highest nodes.
///
/// field             with the fluid as drawn, on its nodes
/// is_before_layers  fluid gets the nodes without particles whose cells are nearly all its own, but
///                   for fills by litres
/// threads           number of threads; the result does not depend on it
/// cost              about 5 microseconds per dp^2 of wall beside fluid on one core
FluidSpace measure_fluid_space(const CaseDef& def, RunField& field, const AllWalls& all,
                               bool is_before_layers, int threads);

} // namespace fppg
