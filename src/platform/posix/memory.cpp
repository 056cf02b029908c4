#include "platform/memory.h"

#ifdef __linux__
#include <malloc.h>
#endif
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <limits>
#include <sstream>
#include <string>

namespace fppg
{

namespace
{

constexpr std::uint64_t unlimited = std::numeric_limits<std::uint64_t>::max();

/// The first number in a file, or the one behind a name at the begin of a line; `unlimited` where
/// there is none ("max").
std::uint64_t number_of_file(const std::string& path, const std::string& wanted = "")
{
    std::ifstream in(path);
    std::string line;
    while (std::getline(in, line))
    {
        if (!line.starts_with(wanted)) continue;
        std::istringstream rest(line.substr(wanted.size()));
        std::uint64_t number = 0;
        return rest >> number ? number : unlimited;
    }
    return unlimited;
}

/// What a limit leaves of its memory; files that are only kept for a later reader do not count.
std::uint64_t left_of(std::uint64_t limit, std::uint64_t used, std::uint64_t kept_files)
{
    if (limit == unlimited || used == unlimited) return unlimited;
    if (kept_files != unlimited) used -= std::min(used, kept_files);
    return limit - std::min(limit, used);
}

/// What the control group of this process, and those above it, leave: version 2 (`0::/path`), and
/// the memory controller of version 1 (`N:memory:/path`).
std::uint64_t left_in_groups()
{
    std::uint64_t least = unlimited;
    std::ifstream in("/proc/self/cgroup");
    std::string line;
    while (std::getline(in, line))
    {
        const std::size_t begin = line.find(':');
        const std::size_t end = begin == std::string::npos ? begin : line.find(':', begin + 1);
        if (end == std::string::npos) continue;
        const std::string controllers = ',' + line.substr(begin + 1, end - begin - 1) + ',';
        const bool is_new = controllers == ",,";
        if (!is_new && controllers.find(",memory,") == std::string::npos) continue;
        const std::string root = is_new ? "/sys/fs/cgroup" : "/sys/fs/cgroup/memory";
        for (std::string group = line.substr(end + 1);; group.erase(group.find_last_of('/')))
        {
            if (group == "/") group.clear();
            const std::string folder = root + group + '/';
            least = std::min(
                least,
                is_new ? left_of(number_of_file(folder + "memory.max"),
                                 number_of_file(folder + "memory.current"),
                                 number_of_file(folder + "memory.stat", "inactive_file"))
                       : left_of(number_of_file(folder + "memory.limit_in_bytes"),
                                 number_of_file(folder + "memory.usage_in_bytes"),
                                 number_of_file(folder + "memory.stat", "total_inactive_file")));
            if (group.find('/') == std::string::npos) break;
        }
    }
    return least;
}

/// What `ulimit -v` leaves.
std::uint64_t left_of_addresses()
{
    struct rlimit limit = {};
    if (::getrlimit(RLIMIT_AS, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY) return unlimited;
    const std::uint64_t pages = number_of_file("/proc/self/statm");
    const auto page = static_cast<std::uint64_t>(::sysconf(_SC_PAGESIZE));
    return left_of(limit.rlim_cur, pages == unlimited ? pages : pages * page, unlimited);
}

} // namespace

std::uint64_t available_memory()
{
    const std::uint64_t free = number_of_file("/proc/meminfo", "MemAvailable:");
    return std::min(
        {free == unlimited ? free : free * 1024, left_in_groups(), left_of_addresses()});
}

void return_free_memory()
{
#ifdef __GLIBC__
    malloc_trim(0);
#endif
}

} // namespace fppg
