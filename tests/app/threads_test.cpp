#include "platform/processors.h"

#include <gtest/gtest.h>

#include <fstream>

namespace fppg
{

namespace
{

/// A folder as the system mounts control groups.
class Groups
{
public:
    Groups() : root_(std::filesystem::path(testing::TempDir()) / "control_groups")
    {
        std::filesystem::remove_all(root_);
    }
    ~Groups() { std::filesystem::remove_all(root_); }

    void write(const std::string& file, const std::string& text) const
    {
        std::filesystem::create_directories((root_ / file).parent_path());
        std::ofstream(root_ / file) << text;
    }
    std::optional<int> processors(const std::string& groups) const
    {
        return processors_of_group(groups, root_);
    }

private:
    std::filesystem::path root_;
};

} // namespace

TEST(Threads, AreThoseThatAControlGroupAllows)
{
    const Groups groups;
    groups.write("job/cpu.max", "150000 100000\n");
    EXPECT_EQ(groups.processors("0::/job\n"), 2);
    EXPECT_EQ(groups.processors("0::/job/step\n"), 2);
    groups.write("job/step/cpu.max", "50000 100000\n");
    EXPECT_EQ(groups.processors("0::/job/step\n"), 1);
}

TEST(Threads, AreThoseOfGroupsOfVersionOne)
{
    const Groups groups;
    groups.write("cpu,cpuacct/job/cpu.cfs_quota_us", "400000\n");
    groups.write("cpu,cpuacct/job/cpu.cfs_period_us", "100000\n");
    EXPECT_EQ(groups.processors("7:memory:/job\n4:cpu,cpuacct:/job\n"), 4);
}

TEST(Threads, AreNotLimitedWithoutAQuota)
{
    const Groups groups;
    groups.write("cpu.max", "max 100000\n");
    groups.write("cpu,cpuacct/cpu.cfs_quota_us", "-1\n");
    groups.write("cpu,cpuacct/cpu.cfs_period_us", "100000\n");
    EXPECT_EQ(groups.processors("0::/\n"), std::nullopt);
    EXPECT_EQ(groups.processors("4:cpu,cpuacct:/\n"), std::nullopt);
    EXPECT_EQ(groups.processors(""), std::nullopt);
}

} // namespace fppg
