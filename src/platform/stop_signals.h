#pragma once

namespace fppg
{

/// Makes every signal that asks to stop (SIGINT of Ctrl-C, SIGTERM, SIGHUP, SIGPIPE, SIGXCPU, ...)
/// end the program at any moment with exit code 128 + its number: the temporary files go, the
/// outputs of before stay. A signal that the caller ignores (nohup) stays ignored. After a crash
/// the temporary files go too. A file size limit is left to the write that meets it.
void catch_stop_signals();

/// For an end that nobody caught: the temporary files go.
void drop_unfinished_files();

/// While one exists, signals that ask to stop are ignored: the renames at the end of a run take no
/// time, and stopping between two of them would leave a mixture of old and new files. Blocking the
/// signals in one thread would not do, another thread of the pool would take them.
class StopSignalsIgnored
{
public:
    StopSignalsIgnored();
    ~StopSignalsIgnored();
    StopSignalsIgnored(const StopSignalsIgnored&) = delete;
    StopSignalsIgnored& operator=(const StopSignalsIgnored&) = delete;
};

/// While one exists, the first signal that asks to stop only asks the work to end early with what
/// it has; the second ends the program as usual.
class StopSignalsAsk
{
public:
    StopSignalsAsk();
    ~StopSignalsAsk();
    StopSignalsAsk(const StopSignalsAsk&) = delete;
    StopSignalsAsk& operator=(const StopSignalsAsk&) = delete;

    bool is_asked() const;
    /// The signal that asked; 0 while none did.
    int signal() const;
};

} // namespace fppg
