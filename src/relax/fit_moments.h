#pragma once

#include "fppg/lattice.h"

#include "relax/all_walls.h"

#include <cstddef>

namespace fppg
{

/// Moves the particles of a body with Placement::Inside a little, all by one linear field, so that
/// their centre and their second moments are those of its shape. Each particle counts as spread
/// over its cell, dp wide (in sheets the n-th part of the thickness across). Layers stay at their
/// depth and nodes of the lattice where they are; no particle moves by more than 0.75 dp,
/// or 3 % of the body's size about its centre. In 2D these are those of its section. Bodies that
/// are cut stay as they are.
///
/// body  index into field.walls.bodies
void fit_moments(RunField& field, std::size_t body, const AllWalls& all, int threads);

} // namespace fppg
