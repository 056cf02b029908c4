#pragma once

#include <sys/wait.h>
#include <unistd.h>

#include <fcntl.h>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "helpers/case_text.h"

namespace fppg::test
{

/// What a program printed, and its exit code; 128 + n after signal n.
struct RunResult
{
    int code = 0;
    std::string output;
};

/// The program of another system that tests/platforms has set to be started in the place of that of
/// this one; null: none.
inline const char* other_program()
{
    return std::getenv("FPPG_PROGRAM_OF_OTHER_SYSTEM");
}

inline std::string program_to_start(const std::string& program)
{
    const char* const here = std::getenv("FPPG_PROGRAM_OF_THIS_ONE");
    return here && other_program() && program == here ? other_program() : program;
}

/// A program that runs in a folder, its output going to a file there.
class Process
{
public:
    Process(const std::string& program, const std::vector<std::string>& arguments,
            const std::string& folder, const std::map<std::string, std::string>& environment = {})
    {
        static int count = 0;
        output_ = (std::filesystem::temp_directory_path() /
                   ("fppg-output-" + std::to_string(::getpid()) + "-" + std::to_string(++count)))
                      .string();
        id_ = ::fork();
        if (id_ != 0) return;
        const int file = ::open(output_.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
        ::dup2(file, 1);
        ::dup2(file, 2);
        if (::chdir(folder.c_str()) != 0) ::_exit(127);
        for (const auto& [name, value] : environment) ::setenv(name.c_str(), value.c_str(), 1);
        std::vector<std::string> texts{program_to_start(program)};
        for (const std::string& a : arguments) texts.push_back(program_to_start(a));
        std::vector<char*> words;
        for (std::string& text : texts) words.push_back(text.data());
        words.push_back(nullptr);
        ::execv(words.front(), words.data());
        ::_exit(127);
    }

    void send(int signal) const { ::kill(id_, signal); }
    /// What it has printed up to now.
    std::string output_so_far() const
    {
        return std::filesystem::exists(output_) ? read_text(output_) : "";
    }

    RunResult wait()
    {
        int status = 0;
        ::waitpid(id_, &status, 0);
        RunResult result{WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status),
                         read_text(output_)};
        if (other_program()) std::erase(result.output, '\r'); // of the ends of lines on Windows
        std::filesystem::remove(output_);
        return result;
    }

private:
    std::string output_;
    pid_t id_ = -1;
};

/// The bytes of every file of a folder, by path inside it; those of other_program() without the \r
/// that end lines of text on Windows.
inline std::map<std::string, std::string> contents(const std::filesystem::path& folder)
{
    std::map<std::string, std::string> out;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder))
    {
        if (!entry.is_regular_file()) continue;
        const std::string name = std::filesystem::relative(entry.path(), folder).string();
        std::string& text = out[name] = read_text(entry.path().string());
        if (other_program() && (name.ends_with(".xml") || name.ends_with(".out")))
            std::erase(text, '\r');
    }
    return out;
}

} // namespace fppg::test
