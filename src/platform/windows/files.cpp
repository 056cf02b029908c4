#include "platform/files.h"

#include "fppg/error.h"
#include "platform/processes.h"
#include "platform/windows/errors.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <io.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <filesystem>

namespace fppg
{

namespace
{

HANDLE handle_of(int file)
{
    return reinterpret_cast<HANDLE>(::_get_osfhandle(file));
}

/// Files that are open can be renamed and removed by those who open them like this, as on other
/// systems.
constexpr DWORD shared = FILE_SHARE_READ | FILE_SHARE_WRITE | FILE_SHARE_DELETE;

/// Other programs look into files for a moment, and a name that was removed is there until they
/// have done: tries for half a second.
template <typename Action>
bool succeeds(const Action& action)
{
    for (int attempt = 0;; ++attempt)
    {
        if (action()) return true;
        const DWORD error = ::GetLastError();
        const bool may_pass = error == ERROR_ACCESS_DENIED || error == ERROR_SHARING_VIOLATION ||
                              error == ERROR_DELETE_PENDING;
        if (!may_pass || attempt >= 25) return false;
        ::Sleep(20);
    }
}

int open_file(const std::string& path, DWORD access, DWORD how)
{
    const HANDLE handle = ::CreateFileW(wide(path).c_str(), access, shared, nullptr, how,
                                        FILE_ATTRIBUTE_NORMAL, nullptr);
    if (handle == INVALID_HANDLE_VALUE)
    {
        set_errno();
        return -1;
    }
    const int file = ::_open_osfhandle(reinterpret_cast<std::intptr_t>(handle), _O_BINARY);
    if (file < 0) ::CloseHandle(handle);
    return file;
}

/// Locks of Windows keep others from the bytes that are locked. This byte is behind all files.
OVERLAPPED lock_place()
{
    OVERLAPPED place = {};
    place.OffsetHigh = 0x7FFFFFFF;
    return place;
}

bool lock_handle(HANDLE handle, bool is_shared)
{
    OVERLAPPED place = lock_place();
    const DWORD how = LOCKFILE_FAIL_IMMEDIATELY | (is_shared ? 0U : LOCKFILE_EXCLUSIVE_LOCK);
    return ::LockFileEx(handle, how, 0, 1, 0, &place) != 0;
}

bool has_room(HANDLE handle, std::uint64_t bytes)
{
    std::array<wchar_t, 4096> path{};
    const DWORD length =
        ::GetFinalPathNameByHandleW(handle, path.data(), static_cast<DWORD>(path.size()), 0);
    if (length == 0 || length >= path.size()) return true;
    const std::wstring folder = std::filesystem::path(path.data()).parent_path().native() + L"\\";
    ULARGE_INTEGER left = {};
    return ::GetDiskFreeSpaceExW(folder.c_str(), &left, nullptr, nullptr) == 0 ||
           left.QuadPart >= bytes;
}

} // namespace

int make_file(const std::string& path)
{
    return open_file(path, GENERIC_WRITE, CREATE_NEW);
}

int open_lock_file(const std::string& path)
{
    int file = -1;
    (void)succeeds(
        [&]
        {
            file = open_file(path, GENERIC_READ | GENERIC_WRITE, OPEN_ALWAYS);
            return file >= 0;
        });
    return file;
}

bool reserve_file(int file, std::uint64_t bytes)
{
    const HANDLE handle = handle_of(file);
    if (!has_room(handle, bytes))
    {
        errno = ENOSPC;
        return false;
    }
    FILE_END_OF_FILE_INFO end = {};
    end.EndOfFile.QuadPart = static_cast<LONGLONG>(bytes);
    if (::SetFileInformationByHandle(handle, FileEndOfFileInfo, &end, sizeof end) != 0) return true;
    set_errno();
    return false;
}

std::int64_t write_file_at(int file, std::uint64_t offset, const void* data, std::size_t bytes)
{
    OVERLAPPED place = {};
    place.Offset = static_cast<DWORD>(offset & 0xFFFFFFFFU);
    place.OffsetHigh = static_cast<DWORD>(offset >> 32);
    const auto most = static_cast<DWORD>(std::min<std::size_t>(bytes, std::size_t{1} << 30));
    DWORD written = 0;
    if (::WriteFile(handle_of(file), data, most, &written, &place) != 0) return written;
    set_errno();
    return -1;
}

bool close_file(int file)
{
    return ::_close(file) == 0;
}

bool replace_file(const std::string& from, const std::string& to)
{
    const std::wstring old_name = wide(from);
    const std::wstring new_name = wide(to);
    if (succeeds(
            [&] {
                return ::MoveFileExW(old_name.c_str(), new_name.c_str(),
                                     MOVEFILE_REPLACE_EXISTING) != 0;
            }))
        return true;
    set_errno();
    return false;
}

bool remove_file(const char* path) noexcept
{
    // Without memory of its own: a program that ran out of it removes its files, too.
    std::array<wchar_t, 4096> name{};
    if (::MultiByteToWideChar(CP_UTF8, 0, path, -1, name.data(), static_cast<int>(name.size())) !=
            0 &&
        ::DeleteFileW(name.data()) != 0)
        return true;
    set_errno();
    return false;
}

bool is_disk_full(int error)
{
    return error == ENOSPC;
}

bool lock_file(int file, bool is_shared)
{
    if (lock_handle(handle_of(file), is_shared)) return true;
    set_errno();
    return false;
}

bool write_locked_file(int file, const std::string& text)
{
    FILE_END_OF_FILE_INFO end = {};
    if (::SetFileInformationByHandle(handle_of(file), FileEndOfFileInfo, &end, sizeof end) == 0)
    {
        set_errno();
        return false;
    }
    return write_file_at(file, 0, text.data(), text.size()) ==
           static_cast<std::int64_t>(text.size());
}

std::string first_line_of_locked_file(const std::string& path)
{
    const HANDLE handle = ::CreateFileW(wide(path).c_str(), GENERIC_READ, shared, nullptr,
                                        OPEN_EXISTING, FILE_ATTRIBUTE_NORMAL, nullptr);
    if (handle == INVALID_HANDLE_VALUE) return {};
    std::array<char, 512> text{};
    DWORD got = 0;
    (void)::ReadFile(handle, text.data(), static_cast<DWORD>(text.size()), &got, nullptr);
    ::CloseHandle(handle);
    const std::string all(text.data(), got);
    return all.substr(0, all.find('\n'));
}

bool has_name(int file, const std::string& path)
{
    const HANDLE there = ::CreateFileW(wide(path).c_str(), 0, shared, nullptr, OPEN_EXISTING,
                                       FILE_ATTRIBUTE_NORMAL, nullptr);
    if (there == INVALID_HANDLE_VALUE) return false;
    BY_HANDLE_FILE_INFORMATION a = {};
    BY_HANDLE_FILE_INFORMATION b = {};
    const bool is_same = ::GetFileInformationByHandle(handle_of(file), &a) != 0 &&
                         ::GetFileInformationByHandle(there, &b) != 0 &&
                         a.dwVolumeSerialNumber == b.dwVolumeSerialNumber &&
                         a.nFileIndexHigh == b.nFileIndexHigh && a.nFileIndexLow == b.nFileIndexLow;
    ::CloseHandle(there);
    return is_same;
}

bool is_locked(const std::string& path)
{
    const HANDLE handle = ::CreateFileW(wide(path).c_str(), GENERIC_READ, shared, nullptr,
                                        OPEN_EXISTING, FILE_ATTRIBUTE_NORMAL, nullptr);
    if (handle == INVALID_HANDLE_VALUE) return true;
    const bool is_held = !lock_handle(handle, false) && ::GetLastError() == ERROR_LOCK_VIOLATION;
    ::CloseHandle(handle);
    return is_held;
}

std::string_view folder_ends()
{
    return "/\\:";
}

std::string with_line_ends(std::string text)
{
    std::string out;
    for (const char c : text) out.append(c == '\n' ? "\r\n" : std::string(1, c));
    return out;
}

std::string make_scratch_folder()
{
    const std::filesystem::path folder = std::filesystem::temp_directory_path();
    for (int attempt = 0; attempt < 100; ++attempt)
    {
        const std::filesystem::path made =
            folder / fmt::format("fppg-new-{}-{}", process_id(), attempt);
        std::error_code failed;
        if (std::filesystem::create_directory(made, failed)) return made.string();
    }
    throw IoError("cannot make a folder in " + folder.string());
}

} // namespace fppg
