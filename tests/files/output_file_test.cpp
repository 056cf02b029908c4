#include "files/helpers.h"
#include "fppg/error.h"
#include "platform/temporary_files.h"

#include <sys/resource.h>
#include <sys/stat.h>
#include <csignal>

namespace fppg
{

namespace
{

std::string text_of_io_error(const std::function<void()>& action)
{
    try
    {
        action();
    }
    catch (const IoError& error)
    {
        return error.what();
    }
    return "no error";
}

TEST(OutputFile, LeavesAnOlderFileWhenItIsNotCommitted)
{
    const TestFolder folder;
    std::ofstream(folder / "a") << "old";
    {
        OutputFile file(folder / "a");
        file.append("new and longer");
    }
    EXPECT_EQ(read_whole(folder / "a"), "old");
    EXPECT_EQ(folder.names().size(), 1U);
}

TEST(OutputFile, ReplacesAnOlderFileOnCommit)
{
    const TestFolder folder;
    std::ofstream(folder / "a") << "old and longer";
    OutputFile file(folder / "a");
    file.append("n");
    file.append("ew");
    EXPECT_EQ(read_whole(folder / "a"), "old and longer");
    file.commit();
    EXPECT_EQ(read_whole(folder / "a"), "new");
    EXPECT_EQ(folder.names().size(), 1U);
}

TEST(OutputFile, IsZeroWhereItIsReservedAndNotWritten)
{
    const std::string bytes = written(
        [](OutputFile& file)
        {
            file.reserve(10);
            file.write_at(8, "ab", 2);
            file.write_at(0, "cd", 2);
        });
    EXPECT_EQ(bytes, std::string("cd\0\0\0\0\0\0ab", 10));
}

TEST(OutputFile, NamesThePlaceAndTheCauseWhenTheFolderIsMissing)
{
    EXPECT_EQ(text_of_io_error([] { OutputFile file("/nowhere at all/a.bi4"); }),
              "cannot write '/nowhere at all/a.bi4': No such file or directory");
}

TEST(OutputFile, RefusesAFolderThatCannotBeWritten)
{
    if (::geteuid() == 0) GTEST_SKIP() << "the superuser may write everywhere";
    const TestFolder folder;
    ::chmod(folder.path().c_str(), 0500);
    EXPECT_EQ(text_of_io_error([&] { OutputFile file(folder / "a"); }),
              "cannot write '" + (folder / "a") + "': Permission denied");
    ::chmod(folder.path().c_str(), 0700);
}

TEST(OutputFile, RefusesAPathThatIsAFolder)
{
    const TestFolder folder;
    EXPECT_EQ(text_of_io_error([&] { OutputFile file(folder.path().string()); }),
              "cannot write '" + folder.path().string() + "': Is a directory");
}

TEST(OutputFile, TakesANameOfTheGreatestLength)
{
    const TestFolder folder;
    const std::string path = folder / std::string(255, 'n');
    OutputFile file(path);
    file.append("x");
    file.commit();
    EXPECT_EQ(read_whole(path), "x");
}

TEST(OutputFile, MayBeOpenTwiceForOneName)
{
    const TestFolder folder;
    OutputFile first(folder / "a");
    OutputFile second(folder / "a");
    first.append("1");
    second.append("2");
    first.commit();
    second.commit();
    EXPECT_EQ(read_whole(folder / "a"), "2");
    EXPECT_EQ(folder.names().size(), 1U);
}

TEST(OutputFile, KeepsItsFileWhenMoved)
{
    const TestFolder folder;
    OutputFile file(folder / "a");
    file.append("1");
    OutputFile moved(std::move(file));
    moved.append("2");
    OutputFile assigned(folder / "b");
    assigned = std::move(moved);
    assigned.append("3");
    assigned.commit();
    EXPECT_EQ(read_whole(folder / "a"), "123");
    EXPECT_EQ(folder.names().size(), 1U);
}

/// Sets the greatest size of a file, so that a write fails as on a full disk.
class FileSizeLimit
{
public:
    explicit FileSizeLimit(rlim_t bytes)
    {
        old_handler_ = std::signal(SIGXFSZ, SIG_IGN);
        ::getrlimit(RLIMIT_FSIZE, &old_);
        const rlimit limit{bytes, old_.rlim_max};
        ::setrlimit(RLIMIT_FSIZE, &limit);
    }
    ~FileSizeLimit()
    {
        ::setrlimit(RLIMIT_FSIZE, &old_);
        std::signal(SIGXFSZ, old_handler_);
    }

private:
    rlimit old_{};
    void (*old_handler_)(int) = nullptr;
};

TEST(OutputFile, LeavesNothingBehindWhenTheDiskTakesOnlyAPart)
{
    const TestFolder folder;
    const std::string data(100000, 'x');
    const auto write_too_much = [&]
    {
        const FileSizeLimit limit(65536);
        OutputFile file(folder / "a");
        file.append(data);
    };
    EXPECT_EQ(text_of_io_error(write_too_much),
              "cannot write '" + (folder / "a") + "': File too large");
    EXPECT_TRUE(folder.names().empty());
}

TEST(OutputFile, NoticesBeforeTheWorkThatTheDiskIsTooSmall)
{
    const TestFolder folder;
    const auto reserve_too_much = [&]
    {
        OutputFile file(folder / "a");
        file.reserve(std::uint64_t{1} << 55);
    };
    const std::string text = text_of_io_error(reserve_too_much);
    if (text == "no error") GTEST_SKIP() << "the file system of the test folder cannot reserve";
    EXPECT_NE(text.find("cannot write '" + (folder / "a")), std::string::npos) << text;
    EXPECT_TRUE(folder.names().empty());
}

TEST(RemoveTemporaryFiles, RemovesThoseOfLivingFilesOnly)
{
    const TestFolder folder;
    OutputFile done(folder / "done");
    OutputFile open(folder / "open");
    done.commit();
    EXPECT_EQ(folder.names().size(), 2U);
    remove_temporary_files();
    EXPECT_EQ(folder.names(), std::vector<std::string>{"done"});
}

} // namespace

} // namespace fppg
