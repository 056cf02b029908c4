#include "platform/windows/errors.h"

#include <array>
#include <cerrno>
#include <filesystem>

namespace fppg
{

namespace
{

/// From here on a folder, whose files have names of eight letters and three, is too long.
constexpr std::size_t short_path = 248;

} // namespace

void set_errno() noexcept
{
    switch (::GetLastError())
    {
        case ERROR_FILE_NOT_FOUND:
        case ERROR_PATH_NOT_FOUND:
        case ERROR_INVALID_NAME:
        case ERROR_BAD_PATHNAME:
        case ERROR_BAD_NETPATH:
            errno = ENOENT;
            break;
        case ERROR_ACCESS_DENIED:
        case ERROR_SHARING_VIOLATION:
        case ERROR_USER_MAPPED_FILE:
        case ERROR_WRITE_PROTECT:
            errno = EACCES;
            break;
        case ERROR_FILE_EXISTS:
        case ERROR_ALREADY_EXISTS:
            errno = EEXIST;
            break;
        case ERROR_DISK_FULL:
        case ERROR_HANDLE_DISK_FULL:
            errno = ENOSPC;
            break;
        case ERROR_LOCK_VIOLATION:
        case ERROR_IO_PENDING:
            errno = EWOULDBLOCK;
            break;
        case ERROR_INVALID_FUNCTION:
        case ERROR_NOT_SUPPORTED:
            errno = ENOTSUP;
            break;
        case ERROR_NOT_ENOUGH_MEMORY:
        case ERROR_OUTOFMEMORY:
            errno = ENOMEM;
            break;
        case ERROR_TOO_MANY_OPEN_FILES:
            errno = EMFILE;
            break;
        case ERROR_FILENAME_EXCED_RANGE:
            errno = ENAMETOOLONG;
            break;
        default:
            errno = EIO;
    }
}

std::string windows_text(DWORD error)
{
    std::array<wchar_t, 512> text{};
    const DWORD length =
        ::FormatMessageW(FORMAT_MESSAGE_FROM_SYSTEM | FORMAT_MESSAGE_IGNORE_INSERTS, nullptr, error,
                         0, text.data(), static_cast<DWORD>(text.size()), nullptr);
    std::wstring out(text.data(), length);
    while (!out.empty() && (out.back() == L'\n' || out.back() == L'\r' || out.back() == L'.'))
        out.pop_back();
    return out.empty() ? "error " + std::to_string(error) : utf8(out);
}

std::wstring wide_text(const std::string& text)
{
    const auto length = static_cast<int>(text.size());
    std::wstring out(text.size(), L'\0');
    const int made = ::MultiByteToWideChar(CP_UTF8, 0, text.data(), length, out.data(), length);
    out.resize(static_cast<std::size_t>(made));
    return out;
}

std::string utf8(const std::wstring& text)
{
    const auto length = static_cast<int>(text.size());
    std::string out(3 * text.size(), '\0');
    const int made = ::WideCharToMultiByte(CP_UTF8, 0, text.data(), length, out.data(),
                                           static_cast<int>(out.size()), nullptr, nullptr);
    out.resize(static_cast<std::size_t>(made));
    return out;
}

std::wstring wide(const std::string& path)
{
    std::wstring name = wide_text(path);
    if (name.size() < short_path || name.starts_with(LR"(\\)")) return name;
    std::error_code failed;
    const std::filesystem::path full = std::filesystem::absolute(name, failed).lexically_normal();
    return failed ? name : LR"(\\?\)" + std::filesystem::path(full).make_preferred().native();
}

} // namespace fppg
