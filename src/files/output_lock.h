#pragma once

#include "platform/file_lock.h"

#include <string>

namespace fppg
{

/// Keeps other runs out of an output as long as it lives, so that its files are all of one run.
class OutputLock
{
public:
    /// Waits five seconds for another run into this output. Removes what killed runs left of it.
    ///
    /// output  of a run, without extension; `.<name>.lock` lies beside it meanwhile
    /// throws  IoError if another run holds it still (names its process and machine), or the folder
    ///         cannot be written
    explicit OutputLock(const std::string& output);

private:
    FileLock lock_;
};

/// The file of the lock of an output. That it is there while nobody holds it says that a run into
/// the output was killed.
std::string output_lock_path(const std::string& output);

} // namespace fppg
