#pragma once

#include "fppg/fitted_walls.h"

#include <cstdint>
#include <vector>

namespace fppg
{

/// A hole that a void or the fluid of an inlet makes in sheets: an inlet's points go on through the
/// wall, and the solver refuses a wall nearer than 0.7 dp to them (v5.4, JSphInOut).
struct WallOpening
{
    ShapeMesh shape; ///< at least one facet
    bool is_inlet = false;
    std::uint32_t bodies = 0;            ///< drawn before it
    std::vector<std::uint32_t> shaped{}; ///< of these, walls whose surface has it cut out already
};

/// Bodies and layers whose draw fills no inside, one entry per body: these are open where a shape
/// is drawn over their surface, through all their layers.
std::vector<char> sheets_among(const std::vector<FittedBody>& bodies);

/// Cuts particles of sheets at openings: those whose place on the surface lies in the shape (of an
/// inlet, within 0.75 dp), or within half a dp over one of its faces, as on the lattice both take
/// the same nodes. Behind what is drawn later on the hole (the walls of a building on the ground
/// that was taken out) layers stay.
///
/// is_cut  per particle of the walls; 1 for those that are cut
void cut_openings(const std::vector<WallOpening>& openings, const FittedWalls& walls, double dp,
                  int threads, std::vector<char>& is_cut);

} // namespace fppg
