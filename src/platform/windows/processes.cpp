#include "platform/processes.h"

#include "fppg/error.h"
#include "platform/windows/errors.h"

#include <array>

namespace fppg
{

int process_id()
{
    return static_cast<int>(::GetCurrentProcessId());
}

bool is_process_gone(int id)
{
    const HANDLE process = ::OpenProcess(SYNCHRONIZE, FALSE, static_cast<DWORD>(id));
    if (process == nullptr) return ::GetLastError() == ERROR_INVALID_PARAMETER;
    const bool has_ended = ::WaitForSingleObject(process, 0) == WAIT_OBJECT_0;
    ::CloseHandle(process);
    return has_ended;
}

std::string machine_name()
{
    std::array<wchar_t, 256> name{};
    auto length = static_cast<DWORD>(name.size());
    if (::GetComputerNameExW(ComputerNameDnsHostname, name.data(), &length) == 0)
        return "this machine";
    return utf8({name.data(), length});
}

std::string program_path()
{
    std::wstring path(32768, L'\0');
    const DWORD length =
        ::GetModuleFileNameW(nullptr, path.data(), static_cast<DWORD>(path.size()));
    if (length == 0)
        throw IoError("cannot find the path of this program: " + windows_text(::GetLastError()));
    path.resize(length);
    return utf8(path);
}

bool has_shell()
{
    return false;
}

int run_script(const std::string& quoted_path)
{
    throw IoError(quoted_path + ": scripts of a shell do not run on Windows");
}

} // namespace fppg
