#pragma once

namespace fppg
{

/// The threads that this process may use: SLURM_CPUS_PER_TASK, else OMP_NUM_THREADS, else
/// allowed_processors().
int default_threads();

} // namespace fppg
