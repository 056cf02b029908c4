#pragma once

#include "fppg/case_def.h"
#include "fppg/fitted_walls.h"
#include "fppg/lattice.h"

#include <optional>
#include <string>
#include <vector>

namespace fppg
{

// Plates and shells of dynamic boundaries that are thinner than 1.6 dp have room for one or two
// rows of particles, and fluid on one side of them feels more: a tilted plate of 0.5 dp before
// water 19 dp deep (2D) could not be balanced (0.27 g). As a sheet the side that fluid is on gets
// all rows, the others behind it, where the plate ends. The same with those of modified boundaries
// that are round the fluid: thickened, a tank of 0.7 dp lost a tenth of its volume (solver v5.4,
// after 0.1 s 0.0024 m/s on average; by its wet side 0.0002).

/// The side of a plate or shell that fluid is on.
struct WetSide
{
    ShapeMesh sheet;                  ///< it looks to the fluid
    ShapeMesh rest;                   ///< shells with fluid on both of their faces, or too thick
    std::vector<std::string> of_mesh; ///< warnings
    double thickness = 0;             ///< the least of the plate, metres
};

/// The side that a wall is fitted to, by its settings: thin plates of dynamic boundaries to the one
/// with fluid, and those of modified ones that have no room for all layers too, where they are
/// round the fluid, as tanks, housings, pipes and troughs are. Gates and baffles are not: fluid may
/// come to their other side.
///
/// Nothing where the shape is no such plate, or fluid is on both faces of all its shells. A tank of
/// thin slabs that cross each other has several sides that look to the fluid; they make up one
/// sheet.
///
/// settings  with `thickens` and fluid_places: each is on the side of the nearest thin facet, and
///           on those that face it along an axis
std::optional<WetSide> wet_side(const ShapeMesh& shape, const LatticeGrid& grid,
                                const FitSettings& settings, int threads);

/// Those of its mesh, and one of its rows.
std::vector<std::string> warnings_of(const WetSide& side, const std::vector<double>& depths_dp,
                                     double dp);

} // namespace fppg
