#pragma once

#include "app/command_line.h"

namespace fppg
{

/// Does what GenCase does with the same arguments: reads the definition, generates, writes the
/// files and prints what callers read (the particle counts, the limits, the time).
///
/// All files appear together at the end, each whole, Case.bi4 and Case.xml last; a run that fails
/// or is stopped leaves older ones as they were. One run at a time writes an output: a second one
/// waits up to five seconds for its turn and is refused then.
///
/// returns  the exit code
/// throws   Error
int run_drop_in(const DropInOptions& options);

} // namespace fppg
