#include "platform/stop_signals.h"

#include "platform/temporary_files.h"

#include <windows.h>

#include <atomic>
#include <csignal>
#include <cstdlib>
#include <cstring>

namespace fppg
{
namespace
{

std::atomic<bool> is_ignored{false};
std::atomic<bool> asks_first{false};
std::atomic<int> asked_by{0};

void print_end(const char* before, const char* what)
{
    constexpr const char* after = "; no output file was changed.\n";
    for (const char* text : {before, what, after})
    {
        DWORD written = 0;
        ::WriteFile(::GetStdHandle(STD_ERROR_HANDLE), text, static_cast<DWORD>(std::strlen(text)),
                    &written, nullptr);
    }
}

/// Windows calls it in a thread of its own. Ctrl-Break is what a batch sends to its runs.
BOOL WINAPI stop(DWORD event)
{
    const int signal = event == CTRL_C_EVENT ? SIGINT : SIGTERM;
    if (is_ignored.load()) return TRUE;
    int none = 0;
    if (asks_first.load() && asked_by.compare_exchange_strong(none, signal)) return TRUE;
    remove_temporary_files();
    print_end("\n*** Stopped by ", signal == SIGINT            ? "the user"
                                   : event == CTRL_BREAK_EVENT ? "Ctrl-Break"
                                                               : "the end of its session");
    ::ExitProcess(static_cast<UINT>(128 + signal));
    return TRUE;
}

LONG WINAPI clean_up(EXCEPTION_POINTERS* what)
{
    remove_temporary_files();
    if (what->ExceptionRecord->ExceptionCode != EXCEPTION_IN_PAGE_ERROR)
        return EXCEPTION_CONTINUE_SEARCH;
    print_end("*** Error: ", "a file became shorter while it was read, or its disk failed");
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

void drop_unfinished_files()
{
    remove_temporary_files();
}

StopSignalsIgnored::StopSignalsIgnored()
{
    is_ignored.store(true);
}
StopSignalsIgnored::~StopSignalsIgnored()
{
    is_ignored.store(false);
}

StopSignalsAsk::StopSignalsAsk()
{
    asked_by.store(0);
    asks_first.store(true);
}
StopSignalsAsk::~StopSignalsAsk()
{
    asks_first.store(false);
}
bool StopSignalsAsk::is_asked() const
{
    return asked_by.load() != 0;
}
int StopSignalsAsk::signal() const
{
    return asked_by.load();
}

} // namespace fppg
