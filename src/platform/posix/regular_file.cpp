#include "platform/regular_file.h"

#include "fppg/error.h"

#include <sys/stat.h>

namespace fppg
{

void expect_regular_file(const std::string& path)
{
    struct stat info = {};
    if (::stat(path.c_str(), &info) != 0) return;
    const char* what = S_ISFIFO(info.st_mode)   ? "a pipe"
                       : S_ISCHR(info.st_mode)  ? "a device"
                       : S_ISBLK(info.st_mode)  ? "a device"
                       : S_ISSOCK(info.st_mode) ? "a socket"
                                                : nullptr;
    if (what != nullptr) throw IoError(path + ": is " + what + ", expected a regular file");
}

} // namespace fppg
