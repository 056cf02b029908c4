#include "platform/child_process.h"

#include "fppg/error.h"
#include "platform/processes.h"
#include "platform/windows/errors.h"

#include <fmt/format.h>
#include <psapi.h>

#include <chrono>

namespace fppg
{
namespace
{

double now()
{
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch())
        .count();
}

HANDLE handle_of(std::intptr_t id)
{
    return reinterpret_cast<HANDLE>(id);
}

/// A word as programs of C find it again in their command line.
std::wstring quoted(const std::string& word)
{
    std::wstring out = L"\"";
    std::size_t backslashes = 0;
    for (const wchar_t c : wide_text(word))
    {
        if (c == L'"') out.append(backslashes + 1, L'\\');
        backslashes = c == L'\\' ? backslashes + 1 : 0;
        out += c;
    }
    out.append(backslashes, L'\\');
    return out + L'"';
}

/// The children of this process end with it: Windows closes the job, and that ends them.
HANDLE job_of_children()
{
    static const HANDLE job = []
    {
        const HANDLE made = ::CreateJobObjectW(nullptr, nullptr);
        JOBOBJECT_EXTENDED_LIMIT_INFORMATION limits = {};
        limits.BasicLimitInformation.LimitFlags = JOB_OBJECT_LIMIT_KILL_ON_JOB_CLOSE;
        ::SetInformationJobObject(made, JobObjectExtendedLimitInformation, &limits, sizeof limits);
        return made;
    }();
    return job;
}

HANDLE open_for_child(const std::wstring& path, DWORD access, DWORD how)
{
    SECURITY_ATTRIBUTES inherited = {};
    inherited.nLength = sizeof inherited;
    inherited.bInheritHandle = TRUE;
    return ::CreateFileW(path.c_str(), access,
                         FILE_SHARE_READ | FILE_SHARE_WRITE | FILE_SHARE_DELETE, &inherited, how,
                         FILE_ATTRIBUTE_NORMAL, nullptr);
}

} // namespace

ChildProcess::ChildProcess(const std::vector<std::string>& arguments, const std::string& folder,
                           const std::string& log)
    : start_(now())
{
    const std::string program = program_path();
    std::wstring line = quoted(program);
    for (const std::string& a : arguments) line += L' ' + quoted(a);
    const HANDLE file = open_for_child(wide(log), GENERIC_WRITE, CREATE_ALWAYS);
    if (file == INVALID_HANDLE_VALUE)
        throw IoError(fmt::format("cannot write '{}': {}", log, windows_text(::GetLastError())));
    const HANDLE nothing = open_for_child(L"NUL", GENERIC_READ, OPEN_EXISTING);
    STARTUPINFOW start = {};
    start.cb = sizeof start;
    start.dwFlags = STARTF_USESTDHANDLES;
    start.hStdInput = nothing;
    start.hStdOutput = file;
    start.hStdError = file;
    PROCESS_INFORMATION made = {};
    const std::wstring in = wide_text(folder);
    const BOOL is_made =
        ::CreateProcessW(wide_text(program).c_str(), line.data(), nullptr, nullptr, TRUE,
                         CREATE_NEW_PROCESS_GROUP | CREATE_SUSPENDED, nullptr,
                         folder.empty() ? nullptr : in.c_str(), &start, &made);
    const DWORD error = ::GetLastError();
    ::CloseHandle(file);
    ::CloseHandle(nothing);
    if (is_made == 0) throw IoError(fmt::format("cannot start a process: {}", windows_text(error)));
    ::AssignProcessToJobObject(job_of_children(), made.hProcess);
    ::ResumeThread(made.hThread);
    ::CloseHandle(made.hThread);
    id_ = reinterpret_cast<std::intptr_t>(made.hProcess);
}

ChildProcess::~ChildProcess()
{
    if (!has_ended_)
    {
        ::TerminateProcess(handle_of(id_), 1);
        ::WaitForSingleObject(handle_of(id_), INFINITE);
    }
    ::CloseHandle(handle_of(id_));
}

bool ChildProcess::has_ended()
{
    if (has_ended_) return true;
    if (::WaitForSingleObject(handle_of(id_), 0) != WAIT_OBJECT_0) return false;
    has_ended_ = true;
    DWORD code = 0;
    ::GetExitCodeProcess(handle_of(id_), &code);
    // Windows' own codes of crashes, as that of a program that touched what is not its memory.
    constexpr DWORD crashes = 0xC0000000;
    exit_code_ = code >= crashes ? 128 + 11 : static_cast<int>(code);
    seconds_ = now() - start_;
    PROCESS_MEMORY_COUNTERS memory = {};
    if (::GetProcessMemoryInfo(handle_of(id_), &memory, sizeof memory) != 0)
        peak_bytes_ = memory.PeakWorkingSetSize;
    return true;
}

void ChildProcess::stop()
{
    if (has_ended_) return;
    // Without a console there is nothing to send it by.
    if (::GenerateConsoleCtrlEvent(CTRL_BREAK_EVENT, ::GetProcessId(handle_of(id_))) == 0)
        ::TerminateProcess(handle_of(id_), 128 + 15);
}

} // namespace fppg
