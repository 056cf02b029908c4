#include "report/html.h"
#include "report/run_facts.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>

namespace fppg
{

using testing::HasSubstr;
using testing::Not;

TEST(EscapedHtml, LeavesNoMarkup)
{
    EXPECT_EQ(escaped_html("<a href=\"x\">&</a>"), "&lt;a href=&quot;x&quot;&gt;&amp;&lt;/a&gt;");
}

TEST(Base64, IsThatOfRfc4648)
{
    EXPECT_EQ(base64(""), "");
    EXPECT_EQ(base64("f"), "Zg==");
    EXPECT_EQ(base64("fo"), "Zm8=");
    EXPECT_EQ(base64("foobar"), "Zm9vYmFy");
}

TEST(GroupedDigits, StandInThrees)
{
    EXPECT_EQ(grouped_digits(0), "0");
    EXPECT_EQ(grouped_digits(1234567), "1,234,567");
}

TEST(HistogramSvg, DrawsABarForEveryBinThatHoldsSomething)
{
    const std::array<std::uint64_t, 4> a{1, 0, 3, 2};
    const std::string svg = histogram_svg("spacing", {{"a", a}}, 0, 1);
    std::size_t bars = 0;
    for (std::size_t at = svg.find("<rect"); at != std::string::npos;
         at = svg.find("<rect", at + 1))
        ++bars;
    EXPECT_EQ(bars, 3U);
    EXPECT_THAT(svg, HasSubstr("height=\"110.00\""));
}

TEST(ReadRunFacts, FindsTimesOfStagesAndWarnings)
{
    const RunFacts facts = read_run_facts(
        "[Draw]\n[Draw-End  time:1.250s]\n*** WARNING: a leak\nTime of execution: 3.500 sec. (2 "
        "threads)\n\nFinished execution (code=0).\n");
    ASSERT_EQ(facts.stages.size(), 1U);
    EXPECT_EQ(facts.stages[0], std::pair(std::string("Draw"), 1.25));
    EXPECT_EQ(facts.seconds, 3.5);
    EXPECT_EQ(facts.warnings, std::vector<std::string>{"a leak"});
}

} // namespace fppg
