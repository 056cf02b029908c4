#include "platform/regular_file.h"

#include "fppg/error.h"
#include "platform/windows/errors.h"

namespace fppg
{

void expect_regular_file(const std::string& path)
{
    const HANDLE handle =
        ::CreateFileW(wide(path).c_str(), 0, FILE_SHARE_READ | FILE_SHARE_WRITE | FILE_SHARE_DELETE,
                      nullptr, OPEN_EXISTING, FILE_FLAG_BACKUP_SEMANTICS, nullptr);
    if (handle == INVALID_HANDLE_VALUE) return;
    const DWORD type = ::GetFileType(handle);
    ::CloseHandle(handle);
    const char* what = type == FILE_TYPE_PIPE   ? "a pipe"
                       : type == FILE_TYPE_CHAR ? "a device"
                                                : nullptr;
    if (what != nullptr) throw IoError(path + ": is " + what + ", expected a regular file");
}

} // namespace fppg
