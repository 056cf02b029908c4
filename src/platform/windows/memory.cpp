#include "platform/memory.h"

#include <windows.h>

#include <algorithm>
#include <limits>

namespace fppg
{

namespace
{

/// What the job that this process is in leaves of its limit.
std::uint64_t left_in_job()
{
    constexpr std::uint64_t unlimited = std::numeric_limits<std::uint64_t>::max();
    JOBOBJECT_EXTENDED_LIMIT_INFORMATION job = {};
    if (::QueryInformationJobObject(nullptr, JobObjectExtendedLimitInformation, &job, sizeof job,
                                    nullptr) == 0)
        return unlimited;
    const DWORD flags = job.BasicLimitInformation.LimitFlags;
    const std::uint64_t of_process =
        (flags & JOB_OBJECT_LIMIT_PROCESS_MEMORY) != 0 ? job.ProcessMemoryLimit : unlimited;
    const std::uint64_t of_job =
        (flags & JOB_OBJECT_LIMIT_JOB_MEMORY) != 0 ? job.JobMemoryLimit : unlimited;
    return std::min(of_process, of_job);
}

} // namespace

std::uint64_t available_memory()
{
    MEMORYSTATUSEX status = {};
    status.dwLength = sizeof status;
    if (::GlobalMemoryStatusEx(&status) == 0) return left_in_job();
    // A process gets no more than what is left of memory and page file together.
    return std::min<std::uint64_t>(
        {status.ullAvailPhys, status.ullAvailPageFile, status.ullAvailVirtual, left_in_job()});
}

void return_free_memory()
{
    HeapCompact(GetProcessHeap(), 0);
}

} // namespace fppg
