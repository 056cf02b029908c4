#include "batch/folder_lock.h"

#include "fppg/error.h"

#include "helpers/case_text.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <sys/file.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <thread>

namespace fppg
{
namespace
{

/// The number of a process that has ended.
pid_t ended_process()
{
    const pid_t id = ::fork();
    if (id == 0) ::_exit(0);
    ::waitpid(id, nullptr, 0);
    return id;
}

TEST(FolderLock, IsRefusedWhileItsOwnerLives)
{
    const test::TemporaryFolder folder;
    const FolderLock first(folder.path().string(), false);
    EXPECT_THROW(FolderLock(folder.path().string(), false), IoError);
    EXPECT_THROW(FolderLock(folder.path().string(), true), IoError);
}

TEST(FolderLock, IsWaitedForWhereAKilledOwnerLeftItToAChild)
{
    const test::TemporaryFolder folder;
    std::array<char, 256> machine{};
    ASSERT_EQ(::gethostname(machine.data(), machine.size() - 1), 0);
    const std::string path = folder / ".batch.lock";
    test::write_text(path, fmt::format("process {} on {}\n", ended_process(), machine.data()));
    const int child = ::open(path.c_str(), O_RDWR | O_CLOEXEC);
    ASSERT_EQ(::flock(child, LOCK_EX | LOCK_NB), 0);
    std::thread end_of_child(
        [child]
        {
            std::this_thread::sleep_for(std::chrono::milliseconds(200));
            ::close(child);
        });
    EXPECT_NO_THROW(FolderLock(folder.path().string(), false));
    end_of_child.join();
}

} // namespace
} // namespace fppg
