// -save:none: all is made, nothing is written.

#include "core/byte_digest.h"
#include "helpers/case_text.h"
#include "helpers/run_fppg.h"

#include <gtest/gtest.h>

#include <string>

namespace
{

namespace fs = std::filesystem;
using namespace fppg;
using namespace fppg::test;

std::string digest_of(const std::string& bytes)
{
    return digest_text(byte_digest(0, bytes.data(), bytes.size()), bytes.size());
}

/// A tank with a ball in it, whose walls are fitted by -fit.
CaseText tank_with_ball()
{
    CaseText text = tank();
    text.mainlist += R"(<setmkbound mk="3" /><drawsphere radius="0.2">
<point x="0.5" y="0.5" z="0.5" /></drawsphere>)";
    return text;
}

TEST(FppgSaveNone, PrintsTheDigestsOfWhatItDoesNotWrite)
{
    const TemporaryFolder folder;
    write_text(folder / "Case_Def.xml", tank_with_ball().text());
    for (const char* fit : {"-fit:off", "-fit"})
        for (const char* threads : {"-threads:1", "-threads:2"})
        {
            const RunResult none =
                run(folder, {"Case_Def", "none/Case", fit, threads, "-save:none"});
            ASSERT_EQ(none.code, 0) << none.output;
            EXPECT_FALSE(fs::exists(folder / "none"));
            ASSERT_EQ(run(folder, {"Case_Def", "out/Case", fit}).code, 0);
            for (const char* name : {"out/Case.bi4", "out/Case.xml"})
                EXPECT_TRUE(contains(none.output, digest_of(read_text(folder / name))))
                    << fit << ' ' << name << '\n'
                    << none.output;
        }
}

TEST(FppgSaveNone, LeavesAnOlderResultAlone)
{
    const TemporaryFolder folder;
    write_text(folder / "Case_Def.xml", tank().text());
    ASSERT_EQ(run(folder, {"Case_Def", "Case"}).code, 0);
    const auto before = contents(folder.path());
    write_text(folder / "Case_Def.xml", tank_with_ball().text());
    const RunResult none = run(folder, {"Case_Def", "Case", "-save:none", "-save3vtk:1"});
    EXPECT_EQ(none.code, 0) << none.output;
    write_text(folder / "Case_Def.xml", tank().text());
    EXPECT_EQ(contents(folder.path()) == before, true);
}

TEST(FppgSaveNone, StandsAloneAndWithoutFilesOfOtherCodes)
{
    const TemporaryFolder folder;
    write_text(folder / "Case_Def.xml", tank().text());
    const RunResult together = run(folder, {"Case_Def", "Case", "-save:none,vtkall"});
    EXPECT_EQ(together.code, 2);
    EXPECT_TRUE(contains(together.output, "or none alone")) << together.output;
    const RunResult to = run(folder, {"Case_Def", "Case", "-save:none", "-to:vtu"});
    EXPECT_EQ(to.code, 2);
    EXPECT_TRUE(contains(to.output, "expected it without -save:none")) << to.output;
}

} // namespace
