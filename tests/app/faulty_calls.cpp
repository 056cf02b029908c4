// Preloaded before the program's own calls that write files. KILL_AT_RENAME=N kills the process as
// it makes its Nth rename(): what a power cut or an out-of-memory killer may do at the worst
// moment. FAIL_CALL=pwrite FAIL_AT=N FAIL_ERROR=E lets its Nth such call for a file of the output
// fail with the errno E, as a quota does, or a disk that breaks.

#include <dlfcn.h>
#include <sys/types.h>
#include <unistd.h>
#include <array>
#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <cstring>

namespace
{

int number(const char* name)
{
    const char* text = std::getenv(name);
    return text == nullptr ? 0 : std::atoi(text);
}

bool is_output(int file)
{
    std::array<char, 32> link{"/proc/self/fd/"};
    for (int digit = 1000000, at = 14; digit > 0; digit /= 10)
        if (file >= digit || digit == 1) link[at++] = static_cast<char>('0' + file / digit % 10);
    std::array<char, 4096> path{};
    return ::readlink(link.data(), path.data(), path.size() - 1) > 0 &&
           std::strstr(path.data(), ".part-") != nullptr;
}

bool fails(const char* call, int file)
{
    static std::atomic<int> count{0};
    const char* wanted = std::getenv("FAIL_CALL");
    if (wanted == nullptr || std::strcmp(wanted, call) != 0 || !is_output(file)) return false;
    if (++count != number("FAIL_AT")) return false;
    errno = number("FAIL_ERROR");
    return true;
}

template <class Function>
Function own(const char* name)
{
    return reinterpret_cast<Function>(::dlsym(RTLD_NEXT, name));
}

} // namespace

extern "C" int rename(const char* from, const char* to) noexcept
{
    static std::atomic<int> count{0};
    if (++count == number("KILL_AT_RENAME")) std::raise(SIGKILL);
    return own<int (*)(const char*, const char*)>("rename")(from, to);
}

extern "C" int fallocate(int file, int mode, off_t offset, off_t length)
{
    if (fails("fallocate", file)) return -1;
    return own<int (*)(int, int, off_t, off_t)>("fallocate")(file, mode, offset, length);
}

extern "C" ssize_t pwrite(int file, const void* data, std::size_t bytes, off_t offset)
{
    if (fails("pwrite", file)) return -1;
    return own<ssize_t (*)(int, const void*, std::size_t, off_t)>("pwrite")(file, data, bytes,
                                                                            offset);
}

extern "C" int close(int file)
{
    // The descriptor is closed all the same.
    const bool is_bad = fails("close", file);
    const int error = errno;
    const int result = own<int (*)(int)>("close")(file);
    if (!is_bad) return result;
    errno = error;
    return -1;
}
