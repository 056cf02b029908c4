#include "platform/memory.h"

#include <windows.h>

#include <algorithm>
#include <limits>

namespace fppg
{

namespace
{

std::uint64_t limit_given = 0;

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

/// The process goes into a job of its own, which stays for as long as it runs.
void limit_memory(std::uint64_t bytes, int /*threads*/)
{
    limit_given = bytes;
    const HANDLE job = ::CreateJobObjectW(nullptr, nullptr);
    if (job == nullptr) return;
    JOBOBJECT_EXTENDED_LIMIT_INFORMATION limits = {};
    limits.BasicLimitInformation.LimitFlags = JOB_OBJECT_LIMIT_PROCESS_MEMORY;
    limits.ProcessMemoryLimit = static_cast<SIZE_T>(bytes);
    if (::SetInformationJobObject(job, JobObjectExtendedLimitInformation, &limits, sizeof limits) !=
        0)
        ::AssignProcessToJobObject(job, ::GetCurrentProcess());
}

std::uint64_t memory_limit()
{
    return limit_given;
}

void return_free_memory()
{
    HeapCompact(GetProcessHeap(), 0);
}

} // namespace fppg
