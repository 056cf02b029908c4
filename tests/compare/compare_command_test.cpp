// The program as its callers start it; FPPG_PROGRAM is its path.

#include "helpers/case_text.h"
#include "helpers/run_fppg.h"

#include <gmock/gmock.h>

namespace
{

using namespace fppg::test;
using testing::HasSubstr;

/// A folder with the tank as Case and, with a lower fluid, as Other.
class CompareCommand : public testing::Test
{
protected:
    TemporaryFolder folder_;

    void SetUp() override
    {
        write_text(folder_ / "Case_Def.xml", tank().text());
        std::string text = tank().text();
        text.replace(text.find("z=\"0.6\""), 7, "z=\"0.5\"");
        write_text(folder_ / "Other_Def.xml", text);
        for (const char* name : {"Case", "Other"})
            ASSERT_EQ(run(folder_, {std::string(name) + "_Def", name, "-save:all"}).code, 0);
    }
};

} // namespace

TEST_F(CompareCommand, EndsWithZeroForEqualResults)
{
    const RunResult result = run(folder_, {"compare", "Case", "Case_All.vtk"});
    EXPECT_EQ(result.code, 0) << result.output;
    EXPECT_THAT(result.output, HasSubstr("\nEqual: "));
}

TEST_F(CompareCommand, EndsWithOneForDifferentResultsAndTellsThem)
{
    const RunResult result = run(folder_, {"compare", "Case", "Other"});
    EXPECT_EQ(result.code, 1) << result.output;
    EXPECT_THAT(result.output, HasSubstr("mk 1: 81 missing in B; id "));
    EXPECT_THAT(result.output, HasSubstr("casedef/geometry/commands/mainlist/drawbox/size@z: 0.6 "
                                         "in A, 0.5 in B"));
}

TEST_F(CompareCommand, EndsWithTwoWhereItCannotCompare)
{
    const std::string whole = read_text(folder_ / "Other.bi4");
    write_text(folder_ / "Other.bi4", whole.substr(0, whole.size() / 2));
    for (const Arguments& arguments :
         {Arguments{"compare", "Case", "Other"}, Arguments{"compare", "Case", "none"},
          Arguments{"compare", "Case"}, Arguments{"compare", "Case", "Case", "--tolerance", "9"},
          Arguments{"compare", "Case", "Case", "--stl", "none.stl"},
          Arguments{"compare", "Case", "Case", "--html", "no/folder.html"}})
    {
        const RunResult result = run(folder_, arguments);
        EXPECT_EQ(result.code, 2) << result.output;
        EXPECT_THAT(result.output, HasSubstr("*** Error: "));
    }
}

TEST_F(CompareCommand, SaysTheSameWithOneThreadAndEightAndWithLittleMemory)
{
    const RunResult result = run(folder_, {"compare", "Case", "Other", "--threads", "1"});
    EXPECT_EQ(run(folder_, {"compare", "Case", "Other", "--threads", "8"}).output, result.output);
    EXPECT_EQ(run(folder_, {"compare", "Case", "Other", "--memory", "1"}).output, result.output);
}

TEST_F(CompareCommand, WritesTheSamePageWithPicturesForAnyNumberOfThreads)
{
    for (const char* threads : {"1", "8"})
        run(folder_, {"compare", "Case", "Other", "--threads", threads, "--html",
                      std::string(threads) + ".html", "--json", std::string(threads) + ".json"});
    const std::string html = read_text(folder_ / "1.html");
    EXPECT_EQ(read_text(folder_ / "8.html"), html);
    EXPECT_EQ(read_text(folder_ / "8.json"), read_text(folder_ / "1.json"));
    std::size_t pictures = 0;
    for (std::size_t at = 0; (at = html.find("data:image/png", at)) != std::string::npos; ++at)
        ++pictures;
    EXPECT_EQ(pictures, 3U);
}

TEST_F(CompareCommand, TellsWhatBodyFittingMovedAndByHowMuch)
{
    const std::filesystem::path gear = std::filesystem::path(FPPG_CASES) / "gear";
    std::filesystem::copy(gear / "gear.stl", folder_.path() / "gear.stl");
    std::string text = read_text((gear / "CaseGear_Def.xml").string());
    text.replace(text.find("dp=\"0.006\""), 10, "dp=\"0.02\"");
    write_text(folder_ / "CaseGear_Def.xml", text);
    ASSERT_EQ(run(folder_, {"CaseGear_Def", "Fitted"}).code, 0);
    ASSERT_EQ(run(folder_, {"CaseGear_Def", "Lattice", "-fit:off"}).code, 0);
    const RunResult result =
        run(folder_, {"compare", "Lattice", "Fitted", "--stl", "gear.stl", "--examples", "1"});
    EXPECT_EQ(result.code, 1) << result.output;
    EXPECT_THAT(result.output, HasSubstr("A is on the lattice, B is body-fitted"));
    EXPECT_THAT(result.output,
                testing::ContainsRegex("11  moving +1412 +[0-9]+ +[+-][0-9.]+ % .* 0\\.[0-9]+ "));
    EXPECT_THAT(result.output, testing::Not(HasSubstr(" moved, by")));
    EXPECT_THAT(result.output, HasSubstr("distance A"));
}
