#pragma once

#include "fppg/case_def.h"
#include "fppg/scene.h"

#include "walls/lattice_stretch.h"

#include <array>
#include <vector>

namespace fppg
{

/// The flat parts of walls beside fluid, per axis; their depths in metres.
using WetPlanesOfAxes = std::array<std::vector<WetPlane>, 3>;

/// Along the axes whose nodes were moved, lets boxes and fills of fluid, and voids in it, end at
/// the nodes that lie in them, in solid mode too. A node stands for the cell around it: so many
/// nodes fill the volume that is drawn, not those that ends halfway between nodes are rounded to.
/// Where a body of fluid ends within half a step of the row beside a wall, it ends there: as on a
/// lattice that is not moved, none is left out between them (public CaseForces at 0.83 of its dp,
/// whose fluid is drawn 1.08 dp off its tank: 0.044 g were left).
void end_fluid_between_nodes(const std::array<bool, 3>& is_moved, const WetPlanesOfAxes& planes,
                             CaseDef& def);

/// Lets bodies of fluid that are drawn up to fitted walls end at the last nodes before these. As on
/// the lattice they would end at the nearest nodes, which are those of a wall there; beside fitted
/// walls some would be fluid up to half a dp beyond them, along their edges.
void end_fluid_at_walls(const Scene& scene, int threads, CaseDef& def);

} // namespace fppg
