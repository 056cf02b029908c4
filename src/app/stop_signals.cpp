#include "app/stop_signals.h"

#include "files/output_file_registry.h"

#include <unistd.h>

#include <atomic>
#include <csignal>

namespace fppg
{
namespace
{

std::atomic<bool> is_ignored{false};
std::atomic<bool> asks_first{false};
std::atomic<bool> has_asked{false};
static_assert(std::atomic<bool>::is_always_lock_free, "a signal handler must not wait for a lock");

extern "C" void stop(int)
{
    if (is_ignored.load()) return;
    if (asks_first.load() && !has_asked.exchange(true)) return;
    remove_temporary_files();
    constexpr char text[] = "\n*** Stopped by the user; no output file was changed.\n";
    const auto written = ::write(STDERR_FILENO, text, sizeof text - 1);
    static_cast<void>(written);
    _exit(130);
}

} // namespace

void catch_stop_signals()
{
    std::signal(SIGINT, stop);
    std::signal(SIGTERM, stop);
    std::signal(SIGXFSZ, SIG_IGN);
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
    has_asked.store(false);
    asks_first.store(true);
}
StopSignalsAsk::~StopSignalsAsk()
{
    asks_first.store(false);
}
bool StopSignalsAsk::is_asked() const
{
    return has_asked.load();
}

} // namespace fppg
