#include "batch/folder_lock.h"

#include "fppg/error.h"

#include <fmt/format.h>

#include <cstdio>
#include <filesystem>

namespace fppg
{

FolderLock::FolderLock(const std::string& folder, bool is_shared)
    : lock_((std::filesystem::path(folder) / ".batch.lock").string(),
            {.is_shared = is_shared, .wait = std::chrono::milliseconds(0)})
{
    if (!lock_.why().empty())
        fmt::print(stderr,
                   "{}: this file system has no locks ({}); take care that no other batch works in "
                   "this folder\n",
                   lock_.path(), lock_.why());
    else if (!lock_.is_held())
        throw IoError(
            fmt::format("{}: another batch is at work in this folder ({}); wait for it or "
                        "stop it, or name another folder by --out",
                        folder, lock_.owner()));
}

} // namespace fppg
