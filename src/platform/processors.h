#pragma once

#include <filesystem>
#include <optional>
#include <string>

namespace fppg
{

/// The processors that this process may use: those of its affinity mask (a two-core job on a large
/// node must not start a thread for every core), and no more than the limit of its control group (a
/// container's share of them).
int allowed_processors();

/// The processors that a control group of Linux and those above it allow, rounded up; none where
/// they do not limit them.
///
/// groups  as /proc/self/cgroup lists the groups of a process, version 1 or 2
/// root    where control groups are mounted
std::optional<int> processors_of_group(const std::string& groups,
                                       const std::filesystem::path& root);

} // namespace fppg
