#include "fppg/compare.h"

#include "compare/helpers.h"

#include <gmock/gmock.h>

namespace fppg
{

namespace
{

using testing::HasSubstr;
using testing::Not;

Comparison of_a_moved_particle()
{
    std::vector<TestParticle> changed = box_of(6, 5, 4);
    changed[30].position.x += 0.3;
    Comparison found = compare_sets(box_of(6, 5, 4), changed);
    found.files[0].path = "a<b>&\"c\".vtk";
    return found;
}

} // namespace

TEST(ToText, ListsTheLargestDifferenceFirst)
{
    std::vector<TestParticle> changed = box_of(6, 5, 4);
    changed[30].position.x += 0.3;
    for (std::size_t i : {40U, 41U, 42U}) changed[i].density = 990;
    const std::string text = to_text(compare_sets(box_of(6, 5, 4), changed));
    EXPECT_LT(text.find("differ in density"), text.find("1 moved")) << text;
}

TEST(ToJson, HoldsTheNumbersOfEveryMk)
{
    const std::string json = to_json(of_a_moved_particle());
    for (const char* part : {"\"is_equal\": false", "\"same_place\": 59", "\"moved\": 1",
                             "\"category\": \"moved\"", "\"shepard\"", "\"histogram\""})
        EXPECT_THAT(json, HasSubstr(part));
}

TEST(ToHtml, NeedsNoOtherFile)
{
    const std::string html =
        to_html(of_a_moved_particle(), {{"a picture", {{"#ff0000", "red"}}, "\x01\x02\x03\x04"}});
    EXPECT_THAT(html, HasSubstr("src=\"data:image/png;base64,AQIDBA==\""));
    EXPECT_THAT(html, HasSubstr("<svg"));
    EXPECT_THAT(html, HasSubstr("moved by, dp"));
    for (const char* part : {"http://", "https://", "<script", "<link"})
        EXPECT_THAT(html, Not(HasSubstr(part)));
}

TEST(ToHtml, ShowsNamesOfFilesAsTheyAre)
{
    EXPECT_THAT(to_html(of_a_moved_particle(), {}), HasSubstr("a&lt;b&gt;&amp;&quot;c&quot;.vtk"));
}

TEST(ToHtml, ClosesEveryElementThatItOpens)
{
    const std::string html = to_html(of_a_moved_particle(), {{"p", {{"#ff0000", "red"}}, "png"}});
    for (const std::string name : {"table", "tr", "div", "svg", "g", "figure", "figcaption", "h2"})
    {
        std::size_t opened = 0;
        std::size_t closed = 0;
        for (std::size_t at = 0; (at = html.find("<" + name, at)) != std::string::npos; ++at)
            if (html[at + name.size() + 1] == '>' || html[at + name.size() + 1] == ' ') ++opened;
        for (std::size_t at = 0; (at = html.find("</" + name + ">", at)) != std::string::npos; ++at)
            ++closed;
        EXPECT_EQ(opened, closed) << name;
        EXPECT_GT(opened, 0U) << name;
    }
}

} // namespace fppg
