#pragma once

#include "platform/file_lock.h"

#include <string>

namespace fppg
{

/// Keeps other batches out of a folder of results as long as it lives.
class FolderLock
{
public:
    /// folder     must exist; `.batch.lock` is made in it and stays
    /// is_shared  beside others that share, as the tasks of one plan do
    /// throws     IoError if another batch holds the folder (names its process and machine), or the
    ///            file cannot be made
    FolderLock(const std::string& folder, bool is_shared);

private:
    FileLock lock_;
};

} // namespace fppg
