#pragma once

#include <string>
#include <vector>

namespace fppg
{

/// `fppg batch FOLDER|LIST ...`: many cases side by side, with sweeps, a summary and a report; or
/// the scripts that hand them to Slurm or GNU parallel. Returns 0 when all runs are done, 1 when
/// one failed, 130 when stopped; throws Error.
int run_batch_command(const std::vector<std::string>& arguments);

} // namespace fppg
