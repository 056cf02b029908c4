#pragma once

#include "batch/progress.h"
#include "batch/record.h"
#include "batch/sweep.h"

#include <functional>
#include <vector>

namespace fppg
{

struct BatchOptions
{
    int jobs = 1;             ///< runs side by side
    int threads = 1;          ///< of each
    double memory_bytes = 0;  ///< that the estimates of runs side by side may add up to
    bool resumes = false;     ///< runs that are current are not done again
    bool has_pictures = true; ///< and what else the report shows of a run
    std::function<bool()> is_asked_to_stop; ///< asked often; may be empty
};

/// Does runs as child processes of this program, each in the folder of its definition: first all
/// estimates, which also tell the files that a case reads, then the runs, those that take longest
/// first, then a picture of each. A run that fails is noted and the others go on; one that alone
/// needs more than the memory is refused. When asked to stop, the children are ended and their runs
/// are noted as stopped. The record of a run is written before it begins, as stopped, and at its
/// end, so that a batch that is killed can be resumed.
///
/// returns  a record a run
/// throws   IoError if a folder or record cannot be written
std::vector<RunRecord> run_batch(const std::vector<BatchRun>& runs, const BatchOptions& options,
                                 Progress& progress);

/// The estimates alone, in the records.
std::vector<RunRecord> estimate_runs(const std::vector<BatchRun>& runs, const BatchOptions& options,
                                     Progress& progress);

} // namespace fppg
