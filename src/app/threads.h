#pragma once

#include <filesystem>
#include <optional>
#include <string>

namespace fppg
{

/// The threads that this process may use: SLURM_CPUS_PER_TASK, else OMP_NUM_THREADS, else the
/// processors of the affinity mask (a two-core job on a large node must not start a thread for
/// every core), and no more than the limit of its control group (a container's share of them).
int default_threads();

/// The processors that a control group and those above it allow, rounded up; none where they do
/// not limit them.
///
/// groups  as /proc/self/cgroup lists the groups of a process, version 1 or 2
/// root    where control groups are mounted
std::optional<int> processors_of_group(const std::string& groups,
                                       const std::filesystem::path& root);

} // namespace fppg
