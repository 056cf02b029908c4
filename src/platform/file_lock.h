#pragma once

#include <chrono>
#include <string>

namespace fppg
{

/// How a FileLock is taken.
struct FileLockWish
{
    bool is_shared = false;              ///< beside others that share
    bool is_removed = false;             ///< the file goes with the lock
    std::chrono::milliseconds wait{500}; ///< for another process to give it back
};

/// A lock that processes of this program take on a file, which says who holds it. The system gives
/// it back when the process ends, however it ends.
class FileLock
{
public:
    /// Makes the file if it is not there.
    ///
    /// throws  IoError if the file cannot be made
    FileLock(std::string path, const FileLockWish& wish);
    ~FileLock();
    FileLock(const FileLock&) = delete;
    FileLock& operator=(const FileLock&) = delete;

    bool is_held() const { return file_ >= 0; }
    const std::string& path() const { return path_; }
    /// Where it is not held: who does ("process 123 on name"), or "an unknown process"; empty where
    /// the file system has no locks, and why() says so.
    const std::string& owner() const { return owner_; }
    const std::string& why() const { return why_; }

private:
    std::string path_;
    FileLockWish wish_;
    int file_ = -1;
    int slot_ = -1;
    std::string owner_;
    std::string why_;

    bool is_taken();
    void tell_owner();
    void close_file();
};

} // namespace fppg
