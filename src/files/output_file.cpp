#include "files/output_file_registry.h"
#include "fppg/error.h"
#include "fppg/files.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>
#include <array>
#include <atomic>
#include <cerrno>
#include <climits>
#include <csignal>
#include <cstring>
#include <filesystem>
#include <utility>

namespace fppg
{

namespace
{

/// The places of the registry. A path is written only while its slot is Reserved and read by a
/// signal handler only while it is Live.
enum SlotState
{
    Free,
    Reserved,
    Live,
};
struct Slot
{
    std::atomic<int> state{Free};
    std::array<char, PATH_MAX> path{};
};
static_assert(std::atomic<int>::is_always_lock_free, "a signal handler must not wait for a lock");
std::array<Slot, 64> slots;

int register_temporary(const std::string& path)
{
    if (path.size() >= PATH_MAX) return -1;
    for (std::size_t i = 0; i < slots.size(); ++i)
    {
        int expected = Free;
        if (!slots[i].state.compare_exchange_strong(expected, Reserved)) continue;
        std::memcpy(slots[i].path.data(), path.c_str(), path.size() + 1);
        slots[i].state.store(Live);
        return static_cast<int>(i);
    }
    return -1;
}

void unregister_temporary(int slot) noexcept
{
    if (slot >= 0) slots[static_cast<std::size_t>(slot)].state.store(Free);
}

[[noreturn]] void fail(const std::string& path, int error)
{
    std::string text = fmt::format("cannot write '{}': {}", path, std::strerror(error));
    if (error == ENOSPC || error == EDQUOT) text += "; an older file of that name is untouched";
    throw IoError(text);
}

/// `.<name>.part-<pid>` beside the file. A name is cut where the longer one would not be allowed.
std::string temporary_name(const std::string& path, int attempt)
{
    const std::filesystem::path full(path);
    std::string name =
        fmt::format(".{}.part-{}", full.filename().string().substr(0, 200), ::getpid());
    if (attempt > 0) name += fmt::format("-{}", attempt);
    return (full.parent_path() / name).string();
}

} // namespace

void remove_temporary_files() noexcept
{
    const int saved_errno = errno;
    for (Slot& slot : slots)
        if (slot.state.load() == Live) ::unlink(slot.path.data());
    errno = saved_errno;
}

namespace
{

/// Keeps signals from this thread while it lives; the program's other threads never take any.
class SignalsBlocked
{
public:
    SignalsBlocked()
    {
        sigset_t all;
        sigfillset(&all);
        pthread_sigmask(SIG_BLOCK, &all, &before_);
    }
    ~SignalsBlocked() { pthread_sigmask(SIG_SETMASK, &before_, nullptr); }
    SignalsBlocked(const SignalsBlocked&) = delete;
    SignalsBlocked& operator=(const SignalsBlocked&) = delete;

private:
    sigset_t before_;
};

} // namespace

OutputFile::OutputFile(std::string path) : path_(std::move(path))
{
    struct stat status = {};
    if (::stat(path_.c_str(), &status) == 0 && S_ISDIR(status.st_mode)) fail(path_, EISDIR);
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
}

OutputFile::~OutputFile()
{
    discard();
}

OutputFile::OutputFile(OutputFile&& other) noexcept
    : path_(std::move(other.path_)),
      temporary_path_(std::move(other.temporary_path_)),
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
    temporary_path_ = std::move(other.temporary_path_);
    descriptor_ = std::exchange(other.descriptor_, -1);
    registry_slot_ = std::exchange(other.registry_slot_, -1);
    end_ = other.end_;
    return *this;
}

void OutputFile::discard() noexcept
{
    if (descriptor_ < 0) return;
    ::close(std::exchange(descriptor_, -1));
    ::unlink(temporary_path_.c_str());
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

void OutputFile::commit()
{
    // Some file systems report a failed write only here. After EINTR the descriptor is closed.
    if (::close(std::exchange(descriptor_, -1)) != 0 && errno != EINTR)
    {
        const int error = errno;
        ::unlink(temporary_path_.c_str());
        unregister_temporary(std::exchange(registry_slot_, -1));
        fail(path_, error);
    }
    const int result = ::rename(temporary_path_.c_str(), path_.c_str());
    const int error = errno;
    if (result != 0) ::unlink(temporary_path_.c_str());
    unregister_temporary(std::exchange(registry_slot_, -1));
    if (result != 0) fail(path_, error);
}

} // namespace fppg
