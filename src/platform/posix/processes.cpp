#include "platform/processes.h"

#include "fppg/error.h"

#include <fmt/format.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <filesystem>

namespace fppg
{

int process_id()
{
    return ::getpid();
}

bool is_process_gone(int id)
{
    return ::kill(id, 0) != 0 && errno == ESRCH;
}

std::string machine_name()
{
    std::array<char, 256> name{};
    return ::gethostname(name.data(), name.size() - 1) == 0 ? name.data() : "this machine";
}

std::string program_path()
{
    std::error_code error;
    const std::filesystem::path path = std::filesystem::read_symlink("/proc/self/exe", error);
    if (error)
        throw IoError(fmt::format("cannot find the path of this program: {}", error.message()));
    return path.string();
}

bool has_shell()
{
    return true;
}

int run_script(const std::string& quoted_path)
{
    const int status = std::system(quoted_path.c_str());
    return WIFEXITED(status) ? WEXITSTATUS(status) : status;
}

} // namespace fppg
