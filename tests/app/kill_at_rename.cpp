// Preloaded before the program's own rename(): the process is killed as it makes its Nth one, N
// being KILL_AT_RENAME. What a power cut or an out-of-memory killer may do at the worst moment.

#include <dlfcn.h>
#include <csignal>
#include <cstdlib>

extern "C" int rename(const char* from, const char* to) noexcept
{
    static int count = 0;
    const char* at = std::getenv("KILL_AT_RENAME");
    if (at != nullptr && ++count == std::atoi(at)) std::raise(SIGKILL);
    using Rename = int (*)(const char*, const char*);
    return reinterpret_cast<Rename>(::dlsym(RTLD_NEXT, "rename"))(from, to);
}
