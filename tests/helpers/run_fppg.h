#pragma once

#include <chrono>
#include <functional>
#include <map>
#include <string>
#include <thread>
#include <vector>

#include "helpers/run_program.h"

namespace fppg::test
{

using Arguments = std::vector<std::string>;

/// Runs the program in a folder, by default that of this build; its files carry the date of one day
/// after the epoch.
inline RunResult run(const TemporaryFolder& folder, const Arguments& arguments,
                     const std::string& program = FPPG_PROGRAM)
{
    return Process(program, arguments, folder.path().string(), {{"SOURCE_DATE_EPOCH", "86400"}})
        .wait();
}

inline bool contains(const std::string& text, const std::string& part)
{
    return text.find(part) != std::string::npos;
}

/// All files of a folder but Case.out, which tells times and threads.
inline std::map<std::string, std::string> results(const std::filesystem::path& folder)
{
    auto out = contents(folder);
    std::erase_if(out, [](const auto& file) { return file.first.ends_with(".out"); });
    return out;
}

/// Returns as soon as is_time says so, or after a minute.
inline void wait_until(const std::function<bool()>& is_time)
{
    const auto begin = std::chrono::steady_clock::now();
    while (!is_time() && std::chrono::steady_clock::now() - begin < std::chrono::seconds(60))
        std::this_thread::sleep_for(std::chrono::microseconds(200));
}

} // namespace fppg::test
