#include "platform/processors.h"

#include <sched.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <limits>
#include <sstream>
#include <thread>

namespace fppg
{
namespace
{

constexpr double unlimited = std::numeric_limits<double>::infinity();

/// The number that a file begins with; 0 where there is none.
double number_in(const std::filesystem::path& file)
{
    double number = 0;
    std::ifstream(file) >> number;
    return number;
}

/// Processors that one folder of control groups allows: `cpu.max` of version 2 holds a quota, or
/// "max", and its period; version 1 has a file for each.
double limit_in(const std::filesystem::path& folder)
{
    double quota = number_in(folder / "cpu.cfs_quota_us");
    double period = number_in(folder / "cpu.cfs_period_us");
    std::ifstream version_2(folder / "cpu.max");
    if (version_2) version_2 >> quota >> period;
    return quota > 0 && period > 0 ? quota / period : unlimited;
}

} // namespace

std::optional<int> processors_of_group(const std::string& groups, const std::filesystem::path& root)
{
    double least = unlimited;
    std::istringstream lines(groups);
    for (std::string line; std::getline(lines, line);)
    {
        const std::size_t first = line.find(':');
        const std::size_t second = line.find(':', first + 1);
        if (first == std::string::npos || second == std::string::npos) continue;
        const std::string controllers = line.substr(first + 1, second - first - 1);
        const std::filesystem::path top = controllers.empty() ? root : root / controllers;
        // A group is bound by those above it, too.
        std::filesystem::path below =
            std::filesystem::path(line.substr(second + 1)).relative_path();
        for (; !below.empty(); below = below.parent_path())
            least = std::min(least, limit_in(top / below));
        least = std::min(least, limit_in(top));
    }
    if (least == unlimited) return {};
    return std::max(1, static_cast<int>(std::ceil(std::min(least, 1e6))));
}

int allowed_processors()
{
    auto processors = static_cast<int>(std::thread::hardware_concurrency());
    cpu_set_t allowed;
    CPU_ZERO(&allowed);
    if (sched_getaffinity(0, sizeof allowed, &allowed) == 0) processors = CPU_COUNT(&allowed);
    std::ostringstream groups;
    groups << std::ifstream("/proc/self/cgroup").rdbuf();
    const auto limit = processors_of_group(groups.str(), "/sys/fs/cgroup");
    return std::max(1, std::min(processors, limit.value_or(processors)));
}

} // namespace fppg
