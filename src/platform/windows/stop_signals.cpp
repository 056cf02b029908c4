#include "platform/stop_signals.h"

#include "platform/stop_request.h"
#include "platform/temporary_files.h"

#include <windows.h>

#include <csignal>
#include <cstring>

namespace fppg
{
namespace
{

/// Windows calls it in a thread of its own. Ctrl-Break is what a batch sends to its runs.
BOOL WINAPI stop(DWORD event)
{
    const int signal = event == CTRL_C_EVENT ? SIGINT : SIGTERM;
    if (is_stop_put_off(signal)) return TRUE;
    clean_up_after_stop(signal == SIGINT            ? "the user"
                        : event == CTRL_BREAK_EVENT ? "Ctrl-Break"
                                                    : "the end of its session");
    ::ExitProcess(static_cast<UINT>(128 + signal));
    return TRUE;
}

LONG WINAPI clean_up(EXCEPTION_POINTERS* what)
{
    if (what->ExceptionRecord->ExceptionCode != EXCEPTION_IN_PAGE_ERROR)
    {
        remove_temporary_files();
        return EXCEPTION_CONTINUE_SEARCH;
    }
    clean_up_after_lost_input();
    ::TerminateProcess(::GetCurrentProcess(), 4);
    return EXCEPTION_EXECUTE_HANDLER;
}

extern "C" void abort_cleanly(int /*signal*/)
{
    remove_temporary_files();
}

} // namespace

void catch_stop_signals()
{
    // A run of a batch is in a process group of its own, for which Windows switches Ctrl-C off.
    ::SetConsoleCtrlHandler(nullptr, FALSE);
    ::SetConsoleCtrlHandler(stop, TRUE);
    ::SetUnhandledExceptionFilter(clean_up);
    std::signal(SIGABRT, abort_cleanly);
    // No window that waits for a click where nobody looks.
    ::SetErrorMode(SEM_FAILCRITICALERRORS | SEM_NOGPFAULTERRORBOX | SEM_NOOPENFILEERRORBOX);
}

void write_to_standard_error(const char* text)
{
    DWORD written = 0;
    ::WriteFile(::GetStdHandle(STD_ERROR_HANDLE), text, static_cast<DWORD>(std::strlen(text)),
                &written, nullptr);
}

} // namespace fppg
