#include "batch/folder_lock.h"

#include "fppg/error.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>

namespace fppg
{

namespace
{

std::string name_of_machine()
{
    std::array<char, 256> name{};
    return ::gethostname(name.data(), name.size() - 1) == 0 ? name.data() : "this machine";
}

} // namespace

FolderLock::FolderLock(const std::string& folder, bool is_shared)
{
    const std::string path = (std::filesystem::path(folder) / ".batch.lock").string();
    file_ = ::open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0644);
    if (file_ < 0) throw IoError(fmt::format("{}: cannot be made: {}", path, std::strerror(errno)));
    if (::flock(file_, (is_shared ? LOCK_SH : LOCK_EX) | LOCK_NB) == 0)
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
    std::ifstream in(path);
    std::string owner;
    std::getline(in, owner);
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
