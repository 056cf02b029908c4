#pragma once

namespace fppg
{

/// The threads that this process may use: SLURM_CPUS_PER_TASK, else OMP_NUM_THREADS, else the
/// processors of the affinity mask (a two-core job on a large node must not start a thread for
/// every core).
int default_threads();

} // namespace fppg
