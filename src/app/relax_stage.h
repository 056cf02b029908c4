#pragma once

#include "fppg/lattice.h"

namespace fppg
{

class RunLog;
struct CaseRunState;
struct MadeCase;

/// Says of every fitted body how many particles stand on it, and the clearances of solids.
void log_fitted_walls(const RunField& field, RunLog& log);

/// Runs relax_walls() with a line on the terminal that shows how far it is, and says afterwards
/// what it did. Its history (CSV with a head line) goes into `made`, the snapshots that the case
/// asks for (OUTPUT_Relax_0010.vtk) to the files of the run.
void run_relaxation(CaseRunState& run, MadeCase& made);

} // namespace fppg
