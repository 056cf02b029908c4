#include "platform/stop_signals.h"

#include "platform/temporary_files.h"

#include <unistd.h>

#include <array>
#include <atomic>
#include <csignal>
#include <cstring>

namespace fppg
{
namespace
{

std::atomic<bool> is_ignored{false};
std::atomic<bool> asks_first{false};
std::atomic<int> asked_by{0};
static_assert(std::atomic<int>::is_always_lock_free, "a signal handler must not wait for a lock");

constexpr std::array stops{SIGINT,  SIGTERM, SIGHUP,  SIGPIPE, SIGXCPU,
                           SIGQUIT, SIGUSR1, SIGUSR2, SIGALRM, SIGVTALRM};
constexpr std::array crashes{SIGSEGV, SIGFPE, SIGILL, SIGABRT, SIGSYS};

void print_end(const char* before, const char* what)
{
    constexpr const char* after = "; no output file was changed.\n";
    for (const char* text : {before, what, after})
    {
        const auto written = ::write(STDERR_FILENO, text, std::strlen(text));
        static_cast<void>(written);
    }
}

const char* name_of_stop(int signal)
{
    switch (signal)
    {
        case SIGINT:
            return "the user";
        case SIGTERM:
            return "SIGTERM";
        case SIGHUP:
            return "SIGHUP";
        case SIGPIPE:
            return "SIGPIPE (nobody reads the output)";
        case SIGXCPU:
            return "SIGXCPU (the limit of processor time)";
        default:
            return "a signal";
    }
}

extern "C" void stop(int signal)
{
    if (is_ignored.load()) return;
    int none = 0;
    if (asks_first.load() && asked_by.compare_exchange_strong(none, signal)) return;
    remove_temporary_files();
    print_end("\n*** Stopped by ", name_of_stop(signal));
    _exit(128 + signal);
}

extern "C" void clean_up(int signal)
{
    remove_temporary_files();
    // SA_RESETHAND: this ends the program as if nobody had caught it.
    raise(signal);
}

/// Of files that are read as memory: the part that another program cuts off meanwhile is gone.
extern "C" void lose_input(int signal, siginfo_t* info, void* /*context*/)
{
    remove_temporary_files();
    if (info->si_code != BUS_ADRERR)
    {
        std::signal(signal, SIG_DFL);
        raise(signal);
        return;
    }
    print_end("*** Error: ", "a file became shorter while it was read, or its disk failed");
    _exit(4);
}

} // namespace

void catch_stop_signals()
{
    const auto set = [](int signal, void (*handler)(int), int flags)
    {
        struct sigaction old = {};
        if (sigaction(signal, nullptr, &old) != 0 || old.sa_handler == SIG_IGN) return;
        struct sigaction action = {};
        action.sa_handler = handler;
        action.sa_flags = flags;
        sigfillset(&action.sa_mask);
        sigaction(signal, &action, nullptr);
    };
    for (const int signal : stops) set(signal, stop, SA_RESTART);
    for (const int signal : crashes) set(signal, clean_up, static_cast<int>(SA_RESETHAND));
    struct sigaction action = {};
    action.sa_sigaction = lose_input;
    // Several threads may meet it at once.
    action.sa_flags = SA_SIGINFO;
    sigfillset(&action.sa_mask);
    sigaction(SIGBUS, &action, nullptr);
    std::signal(SIGXFSZ, SIG_IGN);
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
