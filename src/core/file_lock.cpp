#include "core/file_lock.h"

#include "core/signals_blocked.h"
#include "core/temporary_files.h"
#include "fppg/error.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <thread>
#include <utility>

namespace fppg
{

namespace
{

using namespace std::chrono_literals;

/// For the child of a process that was killed while it started it: the child gives the lock back
/// as soon as it runs its program.
constexpr auto wait_for_gone = 10s;

std::string name_of_machine()
{
    std::array<char, 256> name{};
    return ::gethostname(name.data(), name.size() - 1) == 0 ? name.data() : "this machine";
}

/// Who wrote the file of a lock: "process 123 on name".
std::string owner_in(const std::string& path)
{
    std::ifstream in(path);
    std::string owner;
    std::getline(in, owner);
    return owner;
}

/// Whether a process of this machine is gone.
bool is_gone(const std::string& owner)
{
    int process = 0;
    int read = 0;
    if (std::sscanf(owner.c_str(), "process %d on %n", &process, &read) != 1 || read == 0)
        return false;
    return owner.substr(static_cast<std::size_t>(read)) == name_of_machine() &&
           ::kill(process, 0) != 0 && errno == ESRCH;
}

} // namespace

FileLock::FileLock(std::string path, const FileLockWish& wish) : path_(std::move(path)), wish_(wish)
{
    const auto start = std::chrono::steady_clock::now();
    while (!is_taken() && why_.empty())
    {
        owner_ = owner_in(path_);
        const auto waited = std::chrono::steady_clock::now() - start;
        if (waited > (is_gone(owner_)
                          ? std::max<std::chrono::milliseconds>(wish_.wait, wait_for_gone)
                          : wish_.wait))
        {
            if (owner_.empty()) owner_ = "an unknown process";
            return;
        }
        std::this_thread::sleep_for(20ms);
    }
    owner_.clear();
}

/// Tries once. The file that was opened may have gone with the lock of its owner meanwhile: then
/// another one is made.
bool FileLock::is_taken()
{
    // A stop between the lock and its entry among the temporary files would leave the file.
    const SignalsBlocked blocked;
    file_ = ::open(path_.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0644);
    if (file_ < 0)
        throw IoError(fmt::format("{}: cannot be made: {}", path_, std::strerror(errno)));
    if (::flock(file_, (wish_.is_shared ? LOCK_SH : LOCK_EX) | LOCK_NB) != 0)
    {
        if (errno != EWOULDBLOCK) why_ = std::strerror(errno);
        close_file();
        return false;
    }
    struct stat ours = {};
    struct stat there = {};
    if (wish_.is_removed && (::fstat(file_, &ours) != 0 || ::stat(path_.c_str(), &there) != 0 ||
                             ours.st_ino != there.st_ino || ours.st_dev != there.st_dev))
    {
        close_file();
        return false;
    }
    tell_owner();
    if (wish_.is_removed) slot_ = register_temporary(path_);
    return true;
}

void FileLock::tell_owner()
{
    const std::string text = fmt::format("process {} on {}\n", ::getpid(), name_of_machine());
    const bool is_written =
        ::ftruncate(file_, 0) == 0 &&
        ::pwrite(file_, text.data(), text.size(), 0) == static_cast<ssize_t>(text.size());
    if (is_written) return;
    const std::string cause = std::strerror(errno);
    if (wish_.is_removed) ::unlink(path_.c_str());
    close_file();
    throw IoError(fmt::format("{}: cannot be written: {}", path_, cause));
}

void FileLock::close_file()
{
    ::close(std::exchange(file_, -1));
}

FileLock::~FileLock()
{
    if (file_ < 0) return;
    if (wish_.is_removed) ::unlink(path_.c_str());
    unregister_temporary(std::exchange(slot_, -1));
    close_file();
}

} // namespace fppg
