#include "platform/processors.h"

#include <windows.h>

#include <algorithm>
#include <bit>

namespace fppg
{

int allowed_processors()
{
    DWORD_PTR ours = 0;
    DWORD_PTR all = 0;
    // Zero where the process is in several groups of 64 processors each.
    if (::GetProcessAffinityMask(::GetCurrentProcess(), &ours, &all) == 0 || ours == 0)
        return std::max(1, static_cast<int>(::GetActiveProcessorCount(ALL_PROCESSOR_GROUPS)));
    return std::popcount(ours);
}

std::optional<int> processors_of_group(const std::string& /*groups*/,
                                       const std::filesystem::path& /*root*/)
{
    return {};
}

} // namespace fppg
