#include "platform/file_map.h"

#include "fppg/error.h"
#include "platform/regular_file.h"
#include "platform/windows/errors.h"

#include <algorithm>

namespace fppg
{

namespace
{

[[noreturn]] void fail(const std::string& path, const char* what)
{
    throw IoError(path + what + windows_text(::GetLastError()));
}

class OpenFile
{
public:
    explicit OpenFile(const std::string& path)
        : handle_(::CreateFileW(wide(path).c_str(), GENERIC_READ,
                                FILE_SHARE_READ | FILE_SHARE_WRITE | FILE_SHARE_DELETE, nullptr,
                                OPEN_EXISTING, FILE_FLAG_BACKUP_SEMANTICS, nullptr))
    {
        if (handle_ == INVALID_HANDLE_VALUE) fail(path, ": cannot be opened: ");
    }
    ~OpenFile() { ::CloseHandle(handle_); }
    OpenFile(const OpenFile&) = delete;
    OpenFile& operator=(const OpenFile&) = delete;
    HANDLE get() const { return handle_; }

private:
    HANDLE handle_;
};

std::vector<char> read_to_the_end(HANDLE file, const std::string& path)
{
    constexpr DWORD step = DWORD{1} << 20;
    std::vector<char> buffer;
    std::size_t filled = 0;
    while (true)
    {
        if (buffer.size() - filled < step) buffer.resize(2 * buffer.size() + step);
        DWORD got = 0;
        if (::ReadFile(file, buffer.data() + filled, step, &got, nullptr) == 0)
            fail(path, ": cannot be read: ");
        if (got == 0) break;
        filled += got;
    }
    buffer.resize(filled);
    return buffer;
}

} // namespace

FileMap::FileMap(const std::string& path)
{
    expect_regular_file(path);
    const OpenFile file(path);
    BY_HANDLE_FILE_INFORMATION info = {};
    if (::GetFileInformationByHandle(file.get(), &info) == 0) fail(path, ": cannot be read: ");
    if ((info.dwFileAttributes & FILE_ATTRIBUTE_DIRECTORY) != 0)
        throw IoError(path + ": is a folder, expected a file");
    const std::size_t size = std::size_t{info.nFileSizeHigh} << 32 | info.nFileSizeLow;
    const HANDLE section =
        size > 0 ? ::CreateFileMappingW(file.get(), nullptr, PAGE_READONLY, 0, 0, nullptr)
                 : nullptr;
    if (section != nullptr)
    {
        mapping_ = ::MapViewOfFile(section, FILE_MAP_READ, 0, 0, 0);
        ::CloseHandle(section);
    }
    if (mapping_ == nullptr) buffer_ = read_to_the_end(file.get(), path);
    data_ = mapping_ != nullptr ? static_cast<const char*>(mapping_) : buffer_.data();
    size_ = mapping_ != nullptr ? size : buffer_.size();
}

void FileMap::release() const
{
    // Unlocking pages that are not locked takes them out of this program's memory, and fails.
    if (mapping_ != nullptr) (void)::VirtualUnlock(mapping_, size_);
}

FileMap::~FileMap()
{
    if (mapping_ != nullptr) ::UnmapViewOfFile(mapping_);
}

} // namespace fppg
