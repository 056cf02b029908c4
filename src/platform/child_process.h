#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace fppg
{

/// This program as a child process with other arguments, in a process group of its own, so that
/// Ctrl-C reaches the parent alone, which decides. It is ended with its parent.
class ChildProcess
{
public:
    /// folder  in which it runs
    /// log     the file that its output goes to
    /// throws  IoError if no process can be made
    ChildProcess(const std::vector<std::string>& arguments, const std::string& folder,
                 const std::string& log);
    /// Kills it if it still runs.
    ~ChildProcess();
    ChildProcess(const ChildProcess&) = delete;
    ChildProcess& operator=(const ChildProcess&) = delete;

    /// Whether it has ended; does not wait.
    bool has_ended();
    /// Asks it to end (SIGTERM).
    void stop();

    // Once it has ended.
    int exit_code() const { return exit_code_; } ///< 128 + n after signal n
    double seconds() const { return seconds_; }
    std::uint64_t peak_bytes() const { return peak_bytes_; } ///< resident memory

private:
    std::intptr_t id_ = -1; ///< of the process; on Windows its handle
    bool has_ended_ = false;
    int exit_code_ = 0;
    double start_ = 0;
    double seconds_ = 0;
    std::uint64_t peak_bytes_ = 0;
};

} // namespace fppg
