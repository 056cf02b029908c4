#include "report/scene.h"
#include "report/result_look.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace fppg
{

using testing::HasSubstr;
using testing::Not;

TEST(SceneSet, HoldsPositionsOf16BitsInItsBox)
{
    const SceneSet set{"A", 0.5, {{"mk 1", "#ff0000", {{0, 0, 0}, {1, 2, 4}}}}};
    const auto json = nlohmann::json::parse(to_json(set));
    EXPECT_EQ(json.at("box"), nlohmann::json({0.0, 0.0, 0.0, 1.0, 2.0, 4.0}));
    EXPECT_EQ(json.at("parts").at(0).at("count"), 2);
    // Six zero bytes, six of 255.
    EXPECT_EQ(json.at("positions"), "AAAAAAAA////////");
}

TEST(SceneSet, OfParticlesInAPlaneHasNoNumberThatIsNone)
{
    const SceneSet set{"A", 0.5, {{"mk 1", "#ff0000", {{0, 1, 0}, {1, 1, 0}}}}};
    EXPECT_EQ(nlohmann::json::parse(to_json(set)).at("positions"), "AAAAAAAA//8AAAAA");
}

TEST(SceneSet, HoldsWhereItsPartsAreOverTime)
{
    Transform moved;
    moved.offset = {0.5, 0, 0};
    SceneSet set{"A", 0.5, {{"mk 1", "#ff0000", {{0, 0, 0}}, 1, {{}, moved}}}};
    set.end = 2;
    const auto json = nlohmann::json::parse(to_json(set));
    EXPECT_EQ(json.at("end"), 2.0);
    const auto& frames = json.at("parts").at(0).at("frames");
    ASSERT_EQ(frames.size(), 2u);
    EXPECT_EQ(frames.at(1),
              nlohmann::json({1.0, 0.0, 0.0, 0.5, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0}));
}

TEST(SceneSet, HoldsWhatIsMarkedInWhichFrame)
{
    SceneSet set{"A", 0.5, {{"mk 1", "#ff0000", {{0, 0, 0}, {1, 2, 2}}}}};
    EXPECT_TRUE(nlohmann::json::parse(to_json(set)).at("marks").is_null());
    set.mark_label = "gaps below 3 dp";
    set.frames = 4;
    set.marks = {{2, {1.0 / 3, 0, 1}, "a and b: 1.2 dp"}};
    set.start_marks = {{0, 2, 0}};
    const auto marks = nlohmann::json::parse(to_json(set)).at("marks");
    EXPECT_EQ(marks.at("frames"), 4);
    EXPECT_EQ(marks.at("places").at(0).at("frame"), 2);
    EXPECT_EQ(marks.at("places").at(0).at("at"), nlohmann::json({0.333333, 0.0, 1.0}));
    EXPECT_EQ(marks.at("places").at(0).at("text"), "a and b: 1.2 dp");
    EXPECT_EQ(marks.at("start"), nlohmann::json::array({{0.0, 2.0, 0.0}}));
}

TEST(SceneSet, DoesNotEndTheScriptThatItStandsIn)
{
    const SceneSet set{"</script><b>", 1, {}};
    EXPECT_THAT(to_json(set), Not(HasSubstr("</")));
    EXPECT_EQ(nlohmann::json::parse(to_json(set)).at("name"), "</script><b>");
}

TEST(SceneHtml, SaysInWordsThatThereIsNoView)
{
    EXPECT_THAT(scene_html({}, {}), HasSubstr("no particles for a 3-D view"));
    const std::string html = scene_html({to_json(SceneSet{})}, {{"all", {0}}});
    EXPECT_THAT(html, HasSubstr(viewer_script().empty() ? "no 3-D view" : "id=\"fppg-scene\""));
}

TEST(ViewerScript, StaysInsideItsElement)
{
    EXPECT_EQ(viewer_script().find("</script"), std::string_view::npos);
}

TEST(ResultLook, IsTheSameWhenReadBack)
{
    ResultLook look;
    look.set = "{\"name\":\"A\"}";
    look.details = "<p>\"x\"</p>";
    const ResultLook again = read_look(to_json(look));
    EXPECT_EQ(again.set, look.set);
    EXPECT_EQ(again.details, look.details);
    EXPECT_TRUE(read_look("no json").set.empty());
}

TEST(PicturesHtml, LeadToTheViewOfTheirResult)
{
    ResultLook a{"a", "", "png", "{}", ""};
    ResultLook failed{"b", "", "", "", ""};
    ResultLook c{"c", "", "png", "{}", ""};
    const std::string html = pictures_html({a, failed, c});
    EXPECT_THAT(html, HasSubstr("data-view=\"0\""));
    EXPECT_THAT(html, HasSubstr("data-view=\"1\""));
    EXPECT_THAT(html, Not(HasSubstr("data-view=\"2\"")));
}

} // namespace fppg
