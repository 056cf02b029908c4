#include "core/memory.h"

#include <fstream>
#include <limits>
#include <string>

namespace fppg
{

std::uint64_t available_memory()
{
    std::ifstream in("/proc/meminfo");
    std::string name;
    std::uint64_t kibibytes = 0;
    std::string unit;
    while (in >> name >> kibibytes)
    {
        if (name == "MemAvailable:") return kibibytes * 1024;
        std::getline(in, unit);
    }
    return std::numeric_limits<std::uint64_t>::max();
}

} // namespace fppg
