#include "platform/stop_signals.h"

#include "platform/stop_request.h"
#include "platform/temporary_files.h"

#include <unistd.h>

#include <array>
#include <csignal>
#include <cstring>

namespace fppg
{
namespace
{

constexpr std::array stops{SIGINT,  SIGTERM, SIGHUP,  SIGPIPE, SIGXCPU,
                           SIGQUIT, SIGUSR1, SIGUSR2, SIGALRM, SIGVTALRM};
constexpr std::array crashes{SIGSEGV, SIGFPE, SIGILL, SIGABRT, SIGSYS};

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
    if (is_stop_put_off(signal)) return;
    clean_up_after_stop(name_of_stop(signal));
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
    if (info->si_code != BUS_ADRERR)
    {
        remove_temporary_files();
        std::signal(signal, SIG_DFL);
        raise(signal);
        return;
    }
    clean_up_after_lost_input();
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

void write_to_standard_error(const char* text)
{
    const auto written = ::write(STDERR_FILENO, text, std::strlen(text));
    static_cast<void>(written);
}

} // namespace fppg
