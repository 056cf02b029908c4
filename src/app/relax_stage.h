#pragma once

#include "fppg/lattice.h"

#include <cstddef>
#include <functional>
#include <string>

namespace fppg
{

class RunLog;
struct CaseRunState;
struct MadeCase;

/// What is to be said of each layer of a body, in one line; layers of both sides of a sheet that
/// are as deep stand together. Empty for a body without layers.
///
/// body     index in walls.bodies, no layer
/// text_of  of a layer, or of the body itself where its surface is the first layer
std::string layers_text(const FittedWalls& walls, std::size_t body,
                        const std::function<std::string(std::size_t)>& text_of);

/// Says of every fitted body how many particles stand on it, and the clearances of solids.
void log_fitted_walls(const RunField& field, RunLog& log);

/// Says, for each body that has any, how many particles are left out because others are nearer than
/// least_pair_dp to their places.
void log_left_out(const FittedWalls& walls, RunLog& log);

/// Runs relax_walls() with a line on the terminal that shows how far it is, and says afterwards
/// what it did. Its history (CSV with a head line) goes into `made`, the snapshots that the case
/// asks for (OUTPUT_Relax_0010.vtk) to the files of the run.
void run_relaxation(CaseRunState& run, MadeCase& made);

} // namespace fppg
