#include "platform/stop_signals.h"

#include "platform/stop_request.h"
#include "platform/temporary_files.h"

#include <atomic>

namespace fppg
{
namespace
{

std::atomic<bool> is_ignored{false};
std::atomic<bool> asks_first{false};
std::atomic<int> asked_by{0};
static_assert(std::atomic<int>::is_always_lock_free, "a signal handler must not wait for a lock");

void clean_up_and_say(const char* before, const char* what)
{
    remove_temporary_files();
    for (const char* text : {before, what, "; no output file was changed.\n"})
        write_to_standard_error(text);
}

} // namespace

bool is_stop_put_off(int signal)
{
    if (is_ignored.load()) return true;
    int none = 0;
    return asks_first.load() && asked_by.compare_exchange_strong(none, signal);
}

void clean_up_after_stop(const char* stopped_by)
{
    clean_up_and_say("\n*** Stopped by ", stopped_by);
}

void clean_up_after_lost_input()
{
    clean_up_and_say("*** Error: ", "a file became shorter while it was read, or its disk failed");
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
    return signal() != 0;
}
int StopSignalsAsk::signal() const
{
    return asked_by.load();
}

} // namespace fppg
