#pragma once

#include <string>

namespace fppg
{

/// Keeps other batches out of a folder of results as long as it lives; the system gives the lock
/// back when the program ends, however it ends.
class FolderLock
{
public:
    /// folder     must exist; `.batch.lock` is made in it and stays
    /// is_shared  beside others that share, as the tasks of one plan do
    /// throws     IoError if another batch holds the folder (names its process and machine), or the
    ///            file cannot be made
    FolderLock(const std::string& folder, bool is_shared);
    ~FolderLock();
    FolderLock(const FolderLock&) = delete;
    FolderLock& operator=(const FolderLock&) = delete;

private:
    int file_ = -1;
};

} // namespace fppg
