#include "core/byte_digest.h"
#include "fppg/error.h"
#include "fppg/files.h"
#include "platform/files.h"
#include "platform/processes.h"
#include "platform/regular_file.h"
#include "platform/signals_blocked.h"
#include "platform/temporary_files.h"

#include <fmt/format.h>

#include <algorithm>
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
    if (is_disk_full(error)) text += "; an older file of that name is untouched";
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
    std::string name = fmt::format(".{}.part-{}", short_name(full), process_id());
    if (attempt > 0) name += fmt::format("-{}", attempt);
    return (full.parent_path() / name).string();
}

} // namespace

OutputFile::OutputFile(std::string path) : path_(std::move(path))
{
    const std::filesystem::path full(path_);
    std::error_code ignored;
    if (std::filesystem::is_directory(full, ignored)) fail(path_, EISDIR);
    // A rename would put a file in the place of /dev/null.
    expect_regular_file(path_);
    remove_dead_parts(full.parent_path().string(), short_name(full), false);
    // A stop signal between the making of the file and its entry in the registry would leave it:
    // the entry comes first, since a crash or a signal to another thread is not blocked here.
    const SignalsBlocked blocked;
    // A process of the same id may have been killed here before, and two cases of one process may
    // write the same name: another number is tried then.
    for (int attempt = 0; attempt < 100; ++attempt)
    {
        temporary_path_ = temporary_name(path_, attempt);
        registry_slot_ = register_temporary(temporary_path_);
        descriptor_ = make_file(temporary_path_);
        if (descriptor_ >= 0) break;
        const int error = errno;
        unregister_temporary(std::exchange(registry_slot_, -1));
        if (error != EEXIST || attempt == 99) fail(path_, error);
    }
    // Tells other machines that this process lives; where there are no locks, none asks.
    (void)lock_file(descriptor_, false);
}

OutputFile OutputFile::not_written(std::string path)
{
    OutputFile file;
    file.path_ = std::move(path);
    file.digest_ = std::make_unique<Digest>();
    return file;
}

std::string OutputFile::digest() const
{
    if (!digest_) return {};
    return digest_text(digest_->sum, std::max(end_, digest_->reserved));
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
      end_(other.end_),
      digest_(std::move(other.digest_))
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
    digest_ = std::move(other.digest_);
    return *this;
}

void OutputFile::discard() noexcept
{
    if (descriptor_ >= 0) close_file(std::exchange(descriptor_, -1));
    if (temporary_path_.empty()) return;
    remove_file(temporary_path_.c_str());
    temporary_path_.clear();
    unregister_temporary(std::exchange(registry_slot_, -1));
}

void OutputFile::reserve(std::uint64_t bytes)
{
    if (bytes == 0) return;
    if (digest_)
    {
        digest_->reserved = bytes;
        return;
    }
    if (reserve_file(descriptor_, bytes)) return;
    if (!is_disk_full(errno)) fail(path_, errno);
    const double gib = static_cast<double>(bytes) / (1024.0 * 1024.0 * 1024.0);
    throw IoError(
        fmt::format("cannot write '{}': {} ({:.3f} GiB are needed); an older file of "
                    "that name is untouched",
                    path_, std::strerror(errno), gib));
}

void OutputFile::write_at(std::uint64_t offset, const void* data, std::size_t bytes)
{
    if (digest_)
    {
        digest_->sum += byte_digest(offset, data, bytes);
        return;
    }
    const char* next = static_cast<const char*>(data);
    while (bytes > 0)
    {
        const std::int64_t written = write_file_at(descriptor_, offset, next, bytes);
        if (written < 0) fail(path_, errno);
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
    if (close_file(std::exchange(descriptor_, -1))) return;
    const int error = errno;
    discard();
    fail(path_, error);
}

void OutputFile::commit()
{
    if (digest_) return;
    finish();
    if (!replace_file(temporary_path_, path_))
    {
        const int error = errno;
        discard();
        fail(path_, error);
    }
    temporary_path_.clear();
    unregister_temporary(std::exchange(registry_slot_, -1));
}

} // namespace fppg
