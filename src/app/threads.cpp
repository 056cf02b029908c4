#include "app/threads.h"

#include "platform/processors.h"

#include <charconv>
#include <cstdlib>
#include <string_view>

namespace fppg
{

int default_threads()
{
    for (const char* name : {"SLURM_CPUS_PER_TASK", "OMP_NUM_THREADS"})
    {
        const char* value = std::getenv(name);
        if (value == nullptr) continue;
        const std::string_view text(value);
        int n = 0;
        // OMP_NUM_THREADS may be a list, one entry a nesting level; the first one counts.
        const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), n);
        if (error == std::errc() && n > 0 && (end == text.data() + text.size() || *end == ','))
            return n;
    }
    return allowed_processors();
}

} // namespace fppg
