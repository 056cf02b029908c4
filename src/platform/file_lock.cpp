#include "platform/file_lock.h"

#include "fppg/error.h"
#include "platform/files.h"
#include "platform/processes.h"
#include "platform/signals_blocked.h"
#include "platform/temporary_files.h"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <thread>
#include <utility>

namespace fppg
{

namespace
{

using namespace std::chrono_literals;

/// For the child of a process that was killed while it started it: the child gives the lock back
/// as soon as it runs its program.
constexpr auto wait_for_gone = 10s;

/// Whether a process of this machine is gone.
bool is_gone(const std::string& owner)
{
    int process = 0;
    int read = 0;
    if (std::sscanf(owner.c_str(), "process %d on %n", &process, &read) != 1 || read == 0)
        return false;
    return owner.substr(static_cast<std::size_t>(read)) == machine_name() &&
           is_process_gone(process);
}

} // namespace

FileLock::FileLock(std::string path, const FileLockWish& wish) : path_(std::move(path)), wish_(wish)
{
    const auto start = std::chrono::steady_clock::now();
    while (!is_taken() && why_.empty())
    {
        owner_ = first_line_of_locked_file(path_);
        const auto waited = std::chrono::steady_clock::now() - start;
        if (waited > (is_gone(owner_)
                          ? std::max<std::chrono::milliseconds>(wish_.wait, wait_for_gone)
                          : wish_.wait))
        {
            if (owner_.empty()) owner_ = "an unknown process";
            return;
        }
        std::this_thread::sleep_for(20ms);
    }
    owner_.clear();
}

/// Tries once. The file that was opened may have gone with the lock of its owner meanwhile: then
/// another one is made.
bool FileLock::is_taken()
{
    // A stop between the lock and its entry among the temporary files would leave the file.
    const SignalsBlocked blocked;
    file_ = open_lock_file(path_);
    if (file_ < 0)
        throw IoError(fmt::format("{}: cannot be made: {}", path_, std::strerror(errno)));
    if (!lock_file(file_, wish_.is_shared))
    {
        if (errno != EWOULDBLOCK) why_ = std::strerror(errno);
        close_file();
        return false;
    }
    if (wish_.is_removed && !has_name(file_, path_))
    {
        close_file();
        return false;
    }
    tell_owner();
    if (wish_.is_removed) slot_ = register_temporary(path_);
    return true;
}

void FileLock::tell_owner()
{
    const std::string text = fmt::format("process {} on {}\n", process_id(), machine_name());
    if (write_locked_file(file_, text)) return;
    const std::string cause = std::strerror(errno);
    if (wish_.is_removed) remove_file(path_.c_str());
    close_file();
    throw IoError(fmt::format("{}: cannot be written: {}", path_, cause));
}

void FileLock::close_file()
{
    fppg::close_file(std::exchange(file_, -1));
}

FileLock::~FileLock()
{
    if (file_ < 0) return;
    if (wish_.is_removed) remove_file(path_.c_str());
    unregister_temporary(std::exchange(slot_, -1));
    close_file();
}

} // namespace fppg
