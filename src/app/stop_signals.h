#pragma once

namespace fppg
{

/// Makes Ctrl-C and SIGTERM end the program at any moment with exit code 130: the temporary files
/// go, the outputs of before stay. A file size limit is left to the write that meets it.
void catch_stop_signals();

/// While one exists, Ctrl-C and SIGTERM are ignored: the renames at the end of a run take no time,
/// and stopping between two of them would leave a mixture of old and new files. Blocking the
/// signals in one thread would not do, another thread of the pool would take them.
class StopSignalsIgnored
{
public:
    StopSignalsIgnored();
    ~StopSignalsIgnored();
    StopSignalsIgnored(const StopSignalsIgnored&) = delete;
    StopSignalsIgnored& operator=(const StopSignalsIgnored&) = delete;
};

/// While one exists, the first Ctrl-C or SIGTERM only asks the work to end early with what it has;
/// the second ends the program as usual.
class StopSignalsAsk
{
public:
    StopSignalsAsk();
    ~StopSignalsAsk();
    StopSignalsAsk(const StopSignalsAsk&) = delete;
    StopSignalsAsk& operator=(const StopSignalsAsk&) = delete;

    bool is_asked() const;
};

} // namespace fppg
