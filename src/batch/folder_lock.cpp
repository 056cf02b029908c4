#include "batch/folder_lock.h"

#include "fppg/error.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <thread>

namespace fppg
{

namespace
{

std::string name_of_machine()
{
    std::array<char, 256> name{};
    return ::gethostname(name.data(), name.size() - 1) == 0 ? name.data() : "this machine";
}

/// Who wrote the file of a lock: "process 123 on name".
std::string owner_of(const std::string& path)
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

/// Takes the lock. A batch that was killed while it started a child leaves it to that child, which
/// gives it back as soon as it runs its program; so that is waited for.
bool take(int file, int how, const std::string& path)
{
    using namespace std::chrono_literals;
    const auto end = std::chrono::steady_clock::now() + 10s;
    while (true)
    {
        if (::flock(file, how | LOCK_NB) == 0) return true;
        if (errno != EWOULDBLOCK) return false;
        if (std::chrono::steady_clock::now() > end || !is_gone(owner_of(path)))
        {
            errno = EWOULDBLOCK;
            return false;
        }
        std::this_thread::sleep_for(20ms);
    }
}

} // namespace

FolderLock::FolderLock(const std::string& folder, bool is_shared)
{
    const std::string path = (std::filesystem::path(folder) / ".batch.lock").string();
    file_ = ::open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0644);
    if (file_ < 0) throw IoError(fmt::format("{}: cannot be made: {}", path, std::strerror(errno)));
    if (take(file_, is_shared ? LOCK_SH : LOCK_EX, path))
    {
        const std::string text = fmt::format("process {} on {}\n", ::getpid(), name_of_machine());
        const bool is_written =
            ::ftruncate(file_, 0) == 0 &&
            ::pwrite(file_, text.data(), text.size(), 0) == static_cast<ssize_t>(text.size());
        if (!is_written)
            throw IoError(fmt::format("{}: cannot be written: {}", path, std::strerror(errno)));
        return;
    }
    const int cause = errno;
    ::close(file_);
    file_ = -1;
    if (cause != EWOULDBLOCK)
    {
        fmt::print(stderr,
                   "{}: this file system has no locks ({}); take care that no other batch works in "
                   "this folder\n",
                   path, std::strerror(cause));
        return;
    }
    const std::string owner = owner_of(path);
    throw IoError(
        fmt::format("{}: another batch is at work in this folder ({}); wait for it or "
                    "stop it, or name another folder by --out",
                    folder, owner.empty() ? "an unknown process" : owner));
}

FolderLock::~FolderLock()
{
    if (file_ >= 0) ::close(file_);
}

} // namespace fppg
