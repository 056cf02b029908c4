#include "platform/file_map.h"

#include "platform/regular_file.h"

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "fppg/error.h"

namespace fppg
{

namespace
{

class Descriptor
{
public:
    explicit Descriptor(const std::string& path)
        : value_(::open(path.c_str(), O_RDONLY | O_CLOEXEC))
    {
        if (value_ < 0) throw IoError(path + ": cannot be opened: " + std::strerror(errno));
    }
    ~Descriptor() { ::close(value_); }
    Descriptor(const Descriptor&) = delete;
    Descriptor& operator=(const Descriptor&) = delete;
    int get() const { return value_; }

private:
    int value_;
};

std::vector<char> read_to_the_end(int descriptor, const std::string& path)
{
    constexpr std::size_t step = std::size_t{1} << 20;
    std::vector<char> buffer;
    std::size_t filled = 0;
    while (true)
    {
        if (buffer.size() - filled < step) buffer.resize(2 * buffer.size() + step);
        const ssize_t got = ::read(descriptor, buffer.data() + filled, buffer.size() - filled);
        if (got < 0 && errno == EINTR) continue;
        if (got < 0) throw IoError(path + ": cannot be read: " + std::strerror(errno));
        if (got == 0) break;
        filled += static_cast<std::size_t>(got);
    }
    buffer.resize(filled);
    return buffer;
}

} // namespace

FileMap::FileMap(const std::string& path)
{
    expect_regular_file(path);
    const Descriptor descriptor(path);
    struct stat info = {};
    if (::fstat(descriptor.get(), &info) != 0)
        throw IoError(path + ": cannot be read: " + std::strerror(errno));
    if (S_ISDIR(info.st_mode)) throw IoError(path + ": is a folder, expected a file");
    if (S_ISREG(info.st_mode) && info.st_size > 0)
    {
        const auto size = static_cast<std::size_t>(info.st_size);
        void* const mapping = ::mmap(nullptr, size, PROT_READ, MAP_PRIVATE, descriptor.get(), 0);
        if (mapping != MAP_FAILED)
        {
            mapping_ = mapping;
            data_ = static_cast<const char*>(mapping);
            size_ = size;
            return;
        }
    }
    buffer_ = read_to_the_end(descriptor.get(), path);
    data_ = buffer_.data();
    size_ = buffer_.size();
}

void FileMap::release() const
{
    // Advice only: where it is not taken, nothing but memory is lost.
    if (mapping_ != nullptr) (void)::madvise(mapping_, size_, MADV_DONTNEED);
}

FileMap::~FileMap()
{
    if (mapping_ != nullptr) ::munmap(mapping_, size_);
}

} // namespace fppg
