#pragma once

#include "batch/record.h"
#include "batch/sweep.h"

#include <string>
#include <vector>

namespace fppg
{

/// The runs of a batch, kept in `<folder>/plan.json` so that other processes can do them one by
/// one: `fppg batch --task N <folder>`, and `fppg batch --summary <folder>` at the end.
struct Plan
{
    std::vector<BatchRun> runs;
    int jobs = 1;
    int threads = 1; ///< of each run
    bool resumes = false;
    bool has_pictures = true;
};

/// throws IoError
void write_plan(const std::string& folder, const Plan& plan);
/// throws IoError if the folder has none or it cannot be read
Plan read_plan(const std::string& folder);

/// Writes the scripts for Slurm into the folder: `batch.sbatch` (a job array, one run a task),
/// `summary.sbatch` and `submit.sh`, which hands in both, the second to wait for the first.
///
/// estimates  a record a run, for the memory to ask for
/// returns    the path of submit.sh
/// throws     IoError
std::string write_slurm_scripts(const std::string& folder, const Plan& plan,
                                const std::vector<RunRecord>& estimates);

/// One command per run, one per line, as GNU parallel takes them.
std::string task_lines(const std::string& folder, const Plan& plan);

/// A word for the shell, quoted where it has to be.
std::string shell_word(const std::string& text);

} // namespace fppg
