#include "platform/files.h"

#include "fppg/error.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>

namespace fppg
{

int make_file(const std::string& path)
{
    int file = -1;
    do
    {
        file = ::open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    } while (file < 0 && errno == EINTR);
    return file;
}

int open_lock_file(const std::string& path)
{
    return ::open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0644);
}

bool reserve_file(int file, std::uint64_t bytes)
{
    const auto length = static_cast<off_t>(bytes);
#ifdef __linux__
    int result = 0;
    do
    {
        result = ::fallocate(file, 0, 0, length);
    } while (result != 0 && errno == EINTR);
    if (result == 0) return true;
    if (errno != EOPNOTSUPP && errno != ENOSYS && errno != EINVAL) return false;
#endif
    while (::ftruncate(file, length) != 0)
        if (errno != EINTR) return false;
    return true;
}

std::int64_t write_file_at(int file, std::uint64_t offset, const void* data, std::size_t bytes)
{
    ssize_t written = 0;
    do
    {
        written = ::pwrite(file, data, bytes, static_cast<off_t>(offset));
    } while (written < 0 && errno == EINTR);
    return written;
}

bool close_file(int file)
{
    // After EINTR the descriptor is closed.
    return ::close(file) == 0 || errno == EINTR;
}

bool replace_file(const std::string& from, const std::string& to)
{
    return ::rename(from.c_str(), to.c_str()) == 0;
}

bool remove_file(const char* path) noexcept
{
    return ::unlink(path) == 0;
}

bool is_disk_full(int error)
{
    return error == ENOSPC || error == EDQUOT;
}

bool lock_file(int file, bool is_shared)
{
    return ::flock(file, (is_shared ? LOCK_SH : LOCK_EX) | LOCK_NB) == 0;
}

bool write_locked_file(int file, const std::string& text)
{
    return ::ftruncate(file, 0) == 0 &&
           ::pwrite(file, text.data(), text.size(), 0) == static_cast<ssize_t>(text.size());
}

std::string first_line_of_locked_file(const std::string& path)
{
    std::ifstream in(path);
    std::string line;
    std::getline(in, line);
    return line;
}

bool has_name(int file, const std::string& path)
{
    struct stat ours = {};
    struct stat there = {};
    return ::fstat(file, &ours) == 0 && ::stat(path.c_str(), &there) == 0 &&
           ours.st_ino == there.st_ino && ours.st_dev == there.st_dev;
}

bool is_locked(const std::string& path)
{
    const int file = ::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK | O_NOFOLLOW);
    if (file < 0) return true;
    const bool is_held = ::flock(file, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK;
    ::close(file);
    return is_held;
}

std::string_view folder_ends()
{
    return "/";
}

std::string with_line_ends(std::string text)
{
    return text;
}

std::string make_scratch_folder()
{
    const std::filesystem::path folder = std::filesystem::temp_directory_path();
    std::string name = (folder / "fppg-new-XXXXXX").string();
    if (::mkdtemp(name.data()) == nullptr)
        throw IoError("cannot make a folder in " + folder.string());
    return name;
}

} // namespace fppg
