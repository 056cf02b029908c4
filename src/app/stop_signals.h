#pragma once

namespace fppg
{

/// Makes Ctrl-C and SIGTERM end the program at any moment with exit code 130: the temporary files
/// go, the outputs of before stay. A file size limit is left to the write that meets it.
void catch_stop_signals();

} // namespace fppg
