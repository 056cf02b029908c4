#include "platform/memory.h"

#ifdef __linux__
#include <malloc.h>
#endif
#include <pthread.h>
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

std::uint64_t limit_given = 0;

/// The first number in a file, or the one behind a name at the begin of a line, and of several the
/// one at `place`; `unlimited` where there is none ("max").
std::uint64_t number_of_file(const std::string& path, const std::string& wanted = "", int place = 0)
{
    std::ifstream in(path);
    std::string line;
    while (std::getline(in, line))
    {
        if (!line.starts_with(wanted)) continue;
        std::istringstream rest(line.substr(wanted.size()));
        std::uint64_t number = 0;
        for (int k = 0; k < place; ++k) rest >> number;
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

/// What a limit of the process leaves.
///
/// place  of what counts for it in /proc/self/statm
std::uint64_t left_of_process(decltype(RLIMIT_AS) what, int place)
{
    struct rlimit limit = {};
    if (::getrlimit(what, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY) return unlimited;
    const std::uint64_t pages = number_of_file("/proc/self/statm", "", place);
    const auto page = static_cast<std::uint64_t>(::sysconf(_SC_PAGESIZE));
    return left_of(limit.rlim_cur, pages == unlimited ? pages : pages * page, unlimited);
}

/// Of a thread whose maker does not name a size.
std::uint64_t bytes_of_stack()
{
    pthread_attr_t attributes;
    std::size_t bytes = 0;
    if (::pthread_attr_init(&attributes) != 0) return 0;
    ::pthread_attr_getstacksize(&attributes, &bytes);
    ::pthread_attr_destroy(&attributes);
    return bytes;
}

} // namespace

std::uint64_t available_memory()
{
    const std::uint64_t free = number_of_file("/proc/meminfo", "MemAvailable:");
    constexpr int all_pages = 0, data_pages = 5;
    return std::min({free == unlimited ? free : free * 1024, left_in_groups(),
                     left_of_process(RLIMIT_AS, all_pages),
                     left_of_process(RLIMIT_DATA, data_pages)});
}

void limit_memory(std::uint64_t bytes, int threads)
{
    limit_given = bytes;
    struct rlimit limit = {};
    if (::getrlimit(RLIMIT_DATA, &limit) != 0) return;
    const std::uint64_t with_stacks =
        bytes + bytes_of_stack() * static_cast<std::uint64_t>(std::max(threads, 1));
    limit.rlim_cur = std::min<rlim_t>({limit.rlim_cur, limit.rlim_max, with_stacks});
    ::setrlimit(RLIMIT_DATA, &limit);
}

std::uint64_t memory_limit()
{
    return limit_given;
}

void return_free_memory()
{
#ifdef __GLIBC__
    malloc_trim(0);
#endif
}

} // namespace fppg
