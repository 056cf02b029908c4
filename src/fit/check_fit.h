#pragma once

#include "fppg/case_def.h"
#include "fppg/fitted_walls.h"

#include <string>
#include <vector>

namespace fppg
{

/// Says of every fitted body whose particles do not make up its shape what was expected and what
/// came out: the volume that they stand for against that of the shape, and the particles on the
/// surface against one a dp^2, where either is off by more than 2 %. Bodies of one draw that differ
/// alike (those of a loop, layers) share a sentence about the worst of them.
///
/// returns  sentences that begin with the line of the draw, for "file:" in front
std::vector<std::string> check_fit(const FitDef& settings, const FittedWalls& walls, double dp);

} // namespace fppg
