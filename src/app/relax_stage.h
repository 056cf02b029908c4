#pragma once

#include "fppg/case_def.h"
#include "fppg/lattice.h"

#include <string>
#include <vector>

namespace fppg
{

class RunLog;

/// Says of every fitted body how many particles stand on it, and the clearances of solids.
void log_fitted_walls(const RunField& field, RunLog& log);

struct RelaxOutcome
{
    std::string history;               ///< of all iterations, as CSV with a head line
    std::vector<std::string> warnings; ///< whole sentences
};

/// Runs relax_walls() with a line on the terminal that shows how far it is, and says afterwards
/// what it did. The first Ctrl-C ends it early with what is reached, the second the program.
/// Snapshots that the case asks for are written at once, as OUTPUT_Relax_0010.vtk.
RelaxOutcome run_relaxation(const CaseDef& def, RunField& field, const std::string& output,
                            int threads, RunLog& log);

} // namespace fppg
