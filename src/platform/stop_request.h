#pragma once

// What the signal handlers of both systems share; all of it is async-signal-safe.

namespace fppg
{

/// Whether a signal that asks to stop shall not end the program now: signals are ignored, or it is
/// the first while a StopSignalsAsk exists, which notes it.
bool is_stop_put_off(int signal);

/// These remove the temporary files and say on standard error why the program ends.
void clean_up_after_stop(const char* stopped_by);
void clean_up_after_lost_input();

/// Each system's own.
void write_to_standard_error(const char* text);

} // namespace fppg
