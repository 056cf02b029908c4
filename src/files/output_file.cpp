#include "core/regular_file.h"
#include "core/signals_blocked.h"
#include "core/temporary_files.h"
#include "fppg/error.h"
#include "fppg/files.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <utility>

namespace fppg
{

namespace
{

[[noreturn]] void fail(const std::string& path, int error)
{
    std::string text = fmt::format("cannot write '{}': {}", path, std::strerror(error));
    if (error == ENOSPC || error == EDQUOT) text += "; an older file of that name is untouched";
    throw IoError(text);
}

/// A name is cut where the longer one of its temporary file would not be allowed.
std::string short_name(const std::filesystem::path& path)
{
    return path.filename().string().substr(0, 200);
}

/// `.<name>.part-<pid>` beside the file.
std::string temporary_name(const std::string& path, int attempt)
{
    const std::filesystem::path full(path);
    std::string name = fmt::format(".{}.part-{}", short_name(full), ::getpid());
    if (attempt > 0) name += fmt::format("-{}", attempt);
    return (full.parent_path() / name).string();
}

} // namespace

OutputFile::OutputFile(std::string path) : path_(std::move(path))
{
    struct stat status = {};
    if (::stat(path_.c_str(), &status) == 0 && S_ISDIR(status.st_mode)) fail(path_, EISDIR);
    // A rename would put a file in the place of /dev/null.
    expect_regular_file(path_);
    const std::filesystem::path full(path_);
    remove_dead_parts(full.parent_path().string(), short_name(full), false);
    // A stop signal between the making of the file and its entry in the registry would leave it.
    const SignalsBlocked blocked;
    // A process of the same id may have been killed here before, and two cases of one process may
    // write the same name: another number is tried then.
    for (int attempt = 0; attempt < 100; ++attempt)
    {
        temporary_path_ = temporary_name(path_, attempt);
        do
        {
            descriptor_ =
                ::open(temporary_path_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
        } while (descriptor_ < 0 && errno == EINTR);
        if (descriptor_ >= 0 || errno != EEXIST) break;
    }
    if (descriptor_ < 0) fail(path_, errno);
    registry_slot_ = register_temporary(temporary_path_);
    // Tells other machines that this process lives; where there are no locks, none asks.
    (void)::flock(descriptor_, LOCK_EX | LOCK_NB);
}

OutputFile::~OutputFile()
{
    discard();
}

OutputFile::OutputFile(OutputFile&& other) noexcept
    : path_(std::move(other.path_)),
      temporary_path_(std::exchange(other.temporary_path_, {})),
      descriptor_(std::exchange(other.descriptor_, -1)),
      registry_slot_(std::exchange(other.registry_slot_, -1)),
      end_(other.end_)
{
}

OutputFile& OutputFile::operator=(OutputFile&& other) noexcept
{
    if (this == &other) return *this;
    discard();
    path_ = std::move(other.path_);
    temporary_path_ = std::exchange(other.temporary_path_, {});
    descriptor_ = std::exchange(other.descriptor_, -1);
    registry_slot_ = std::exchange(other.registry_slot_, -1);
    end_ = other.end_;
    return *this;
}

void OutputFile::discard() noexcept
{
    if (descriptor_ >= 0) ::close(std::exchange(descriptor_, -1));
    if (temporary_path_.empty()) return;
    ::unlink(temporary_path_.c_str());
    temporary_path_.clear();
    unregister_temporary(std::exchange(registry_slot_, -1));
}

void OutputFile::reserve(std::uint64_t bytes)
{
    if (bytes == 0) return;
    const auto length = static_cast<off_t>(bytes);
#ifdef __linux__
    int result = 0;
    do
    {
        result = ::fallocate(descriptor_, 0, 0, length);
    } while (result != 0 && errno == EINTR);
    if (result == 0) return;
    if (errno == ENOSPC || errno == EDQUOT)
    {
        const double gib = static_cast<double>(bytes) / (1024.0 * 1024.0 * 1024.0);
        throw IoError(
            fmt::format("cannot write '{}': {} ({:.3f} GiB are needed); an older file of "
                        "that name is untouched",
                        path_, std::strerror(errno), gib));
    }
    if (errno != EOPNOTSUPP && errno != ENOSYS && errno != EINVAL) fail(path_, errno);
#endif
    while (::ftruncate(descriptor_, length) != 0)
        if (errno != EINTR) fail(path_, errno);
}

void OutputFile::write_at(std::uint64_t offset, const void* data, std::size_t bytes)
{
    const char* next = static_cast<const char*>(data);
    while (bytes > 0)
    {
        const ssize_t written = ::pwrite(descriptor_, next, bytes, static_cast<off_t>(offset));
        if (written < 0)
        {
            if (errno == EINTR) continue;
            fail(path_, errno);
        }
        // A file system that takes nothing and reports nothing would be asked for ever.
        if (written == 0) fail(path_, ENOSPC);
        next += written;
        offset += static_cast<std::uint64_t>(written);
        bytes -= static_cast<std::size_t>(written);
    }
}

void OutputFile::append(const void* data, std::size_t bytes)
{
    write_at(end_, data, bytes);
    end_ += bytes;
}

void OutputFile::finish()
{
    if (descriptor_ < 0) return;
    // Some file systems report a failed write only here. After EINTR the descriptor is closed.
    if (::close(std::exchange(descriptor_, -1)) == 0 || errno == EINTR) return;
    const int error = errno;
    discard();
    fail(path_, error);
}

void OutputFile::commit()
{
    finish();
    if (::rename(temporary_path_.c_str(), path_.c_str()) != 0)
    {
        const int error = errno;
        discard();
        fail(path_, error);
    }
    temporary_path_.clear();
    unregister_temporary(std::exchange(registry_slot_, -1));
}

} // namespace fppg
