#include "files/output_lock.h"

#include "fppg/error.h"
#include "platform/temporary_files.h"

#include <fmt/format.h>

#include <cstdio>
#include <filesystem>

namespace fppg
{

namespace
{

constexpr std::chrono::seconds patience(5);

} // namespace

OutputLock::OutputLock(const std::string& output)
    : lock_(output_lock_path(output), {.is_removed = true, .wait = patience})
{
    if (!lock_.why().empty())
        fmt::print(stderr,
                   "{}: this file system has no locks ({}); take care that no other run writes "
                   "this output\n",
                   lock_.path(), lock_.why());
    else if (!lock_.is_held())
        throw IoError(
            fmt::format("{}: another run writes this output ({}); wait for it or stop it, or name "
                        "another output",
                        output, lock_.owner()));
    const std::filesystem::path path(output);
    remove_dead_parts(path.parent_path().string(), path.filename().string(), true);
}

std::string output_lock_path(const std::string& output)
{
    const std::filesystem::path path(output);
    return (path.parent_path() / ("." + path.filename().string().substr(0, 200) + ".lock"))
        .string();
}

} // namespace fppg
