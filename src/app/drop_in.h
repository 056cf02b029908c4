#pragma once

#include "app/command_line.h"

namespace fppg
{

/// Does what GenCase does with the same arguments: reads the definition, generates, writes the
/// files and prints what callers read (the particle counts, the limits, the time).
///
/// All files appear together at the end, each whole; a run that fails or is stopped leaves older
/// ones as they were. Only the pictures of a relaxation that the case asks for appear while it
/// runs.
///
/// returns  the exit code
/// throws   Error
int run_drop_in(const DropInOptions& options);

} // namespace fppg
