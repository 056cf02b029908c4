#include "platform/child_process.h"

#include "fppg/error.h"
#include "platform/processes.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstring>

namespace fppg
{
namespace
{

double now()
{
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch())
        .count();
}

/// The exit code for what goes wrong between fork and the program, as shells have it.
constexpr int cannot_start = 127;

/// A process id, which the header keeps in an integer of any system.
pid_t process_of(std::intptr_t id)
{
    return static_cast<pid_t>(id);
}

} // namespace

ChildProcess::ChildProcess(const std::vector<std::string>& arguments, const std::string& folder,
                           const std::string& log)
    : start_(now())
{
    const std::string program = program_path();
    std::vector<char*> words{const_cast<char*>(program.c_str())};
    for (const std::string& a : arguments) words.push_back(const_cast<char*>(a.c_str()));
    words.push_back(nullptr);
    const int file = ::open(log.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
    if (file < 0) throw IoError(fmt::format("cannot write '{}': {}", log, std::strerror(errno)));
    const pid_t parent = ::getpid();
    id_ = ::fork();
    if (id_ == 0)
    {
        ::setpgid(0, 0);
        ::prctl(PR_SET_PDEATHSIG, SIGKILL);
        // The parent may have ended before the line above.
        if (::getppid() != parent) ::_exit(cannot_start);
        ::dup2(file, STDOUT_FILENO);
        ::dup2(file, STDERR_FILENO);
        const int nothing = ::open("/dev/null", O_RDONLY);
        if (nothing >= 0) ::dup2(nothing, STDIN_FILENO);
        if (::chdir(folder.c_str()) != 0) ::_exit(cannot_start);
        ::execv(program.c_str(), words.data());
        ::_exit(cannot_start);
    }
    const int error = errno;
    ::close(file);
    if (id_ < 0) throw IoError(fmt::format("cannot start a process: {}", std::strerror(error)));
    ::setpgid(process_of(id_), process_of(id_));
}

ChildProcess::~ChildProcess()
{
    if (has_ended_) return;
    ::kill(process_of(id_), SIGKILL);
    ::waitpid(process_of(id_), nullptr, 0);
}

bool ChildProcess::has_ended()
{
    if (has_ended_) return true;
    int status = 0;
    rusage usage{};
    if (::wait4(process_of(id_), &status, WNOHANG, &usage) != id_) return false;
    has_ended_ = true;
    exit_code_ = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
    seconds_ = now() - start_;
    peak_bytes_ = static_cast<std::uint64_t>(usage.ru_maxrss) * 1024;
    return true;
}

void ChildProcess::stop()
{
    if (!has_ended_) ::kill(process_of(id_), SIGTERM);
}

} // namespace fppg
