// The cases are made by the program itself, FPPG_PROGRAM; the outputs of the solver are made up.

#include "leak/leak.h"

#include "files/particle_source.h"
#include "fppg/error.h"
#include "helpers/run_fppg.h"
#include "leak/part_writer.h"

#include <gmock/gmock.h>

#include <cmath>
#include <numbers>

namespace
{

using namespace fppg;
using namespace fppg::test;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::ThrowsMessage;

class CountLeaks : public testing::Test
{
protected:
    TemporaryFolder folder_;

    void generate(const CaseText& text)
    {
        write_text(folder_ / "Case_Def.xml", text.text());
        const RunResult result = run(folder_, {"Case_Def", "Case"});
        ASSERT_EQ(result.code, 0) << result.output;
    }

    /// The particles of the case, those of one mk turned about the axis y through (0.5, 0, 0.5), at
    /// 1 s.
    PartText part(std::uint16_t mk = 0, double angle = 0) const
    {
        const ParticleSource source(folder_ / "Case");
        PartText out;
        out.time = 1;
        out.step = 100;
        out.total = source.size();
        for (std::size_t i = 0; i < source.size(); ++i)
        {
            Vec3 p = source.position(i);
            if (source.mk(i) == mk)
            {
                const double x = p.x - 0.5;
                const double z = p.z - 0.5;
                p.x = 0.5 + std::cos(angle) * x + std::sin(angle) * z;
                p.z = 0.5 - std::sin(angle) * x + std::cos(angle) * z;
            }
            out.add(source.id(i), p);
        }
        return out;
    }

    LeakReport count(const PartText& text, int threads = 2)
    {
        write_text(folder_ / "Part_0001.bi4", text.bytes());
        LeakOptions options;
        options.threads = threads;
        return count_leaks(folder_ / "Case", {folder_ / "Part_0001.bi4"}, options);
    }

    /// Puts the last particle, which is of the fluid, somewhere else.
    static PartText with_last_at(PartText text, const Vec3& p)
    {
        text.positions.back() = p;
        return text;
    }
};

/// About the axis y through (0.5, 0, 0.5).
std::string rotation_of_mk(int mk)
{
    return R"(<motion><objreal ref=")" + std::to_string(mk) +
           R"("><begin mov="1" start="0" /><mvrot id="1" duration="10" anglesunits="degrees"><vel ang="90" /><axisp1 x="0.5" y="0" z="0.5" /><axisp2 x="0.5" y="1" z="0.5" /></mvrot></objreal></motion>)";
}

/// A flat bar of 0.6 x 0.6 x 0.2 m about the middle of a tank, which turns about y; water below.
CaseText turning_bar()
{
    CaseText out;
    out.dp = "0.05";
    out.mainlist =
        R"(<setdrawmode mode="full" /><setmkbound mk="0" />)" +
        box_command(R"(x="0" y="0" z="0")", R"(x="1" y="1" z="1")",
                    "bottom | left | right | front | back") +
        R"(<setmkbound mk="1" />)" +
        box_command(R"(x="0.2" y="0.2" z="0.4")", R"(x="0.6" y="0.6" z="0.2")") +
        R"(<setmkfluid mk="0" /><fillbox x="0.5" y="0.5" z="0.05"><modefill>void</modefill><point x="0" y="0" z="0" /><size x="1" y="1" z="0.1" /></fillbox>)";
    out.after_geometry = rotation_of_mk(1);
    return out;
}

/// A closed tank with water.
CaseText closed_tank()
{
    CaseText out = tank();
    out.dp = "0.05";
    const std::string sides = "bottom | left | right | front | back";
    out.mainlist.replace(out.mainlist.rfind(sides), sides.size(), "all");
    return out;
}

} // namespace

TEST_F(CountLeaks, FindsNothingInTheCaseItself)
{
    generate(turning_bar());
    const LeakReport report = count(part());
    EXPECT_TRUE(report.is_tight()) << to_text(report);
    ASSERT_EQ(report.instants.size(), 1U);
    EXPECT_EQ(report.instants[0].fluid, report.fluid);
    EXPECT_EQ(report.instants[0].step, 100U);
    EXPECT_EQ(report.instants[0].excluded, 0U);
    EXPECT_FALSE(report.instants[0].outside.has_value());
}

TEST_F(CountLeaks, FindsAParticleInATurnedBar)
{
    generate(turning_bar());
    const double quarter = std::numbers::pi / 2;
    const Vec3 above{0.5, 0.5, 0.75}; // the end of the bar once it stands upright
    const LeakReport still = count(with_last_at(part(11, 0), above));
    EXPECT_EQ(still.instants[0].inside, 0U);
    const LeakReport turned = count(with_last_at(part(11, quarter), above));
    EXPECT_EQ(turned.instants[0].inside, 1U);
    EXPECT_NEAR(turned.instants[0].deepest_dp, 1, 1e-4); // 0.05 m below its end
    EXPECT_EQ(turned.instants[0].deep, 1U);
    const LeakReport shallow = count(with_last_at(part(11, quarter), {0.5, 0.5, 0.79}));
    EXPECT_EQ(shallow.instants[0].inside, 1U);
    EXPECT_EQ(shallow.instants[0].deep, 0U);
    ASSERT_EQ(turned.bodies.size(), 1U);
    EXPECT_EQ(turned.bodies[0].mk, 11);
    EXPECT_EQ(turned.bodies[0].type, ParticleType::Moving);
    EXPECT_THAT(turned.instants[0].in_body, ElementsAre(1U));
    const Vec3 aside{0.25, 0.5, 0.5}; // in the bar as drawn
    EXPECT_EQ(count(with_last_at(part(11, 0), aside)).instants[0].inside, 1U);
    EXPECT_EQ(count(with_last_at(part(11, quarter), aside)).instants[0].inside, 0U);
}

TEST_F(CountLeaks, GivesTheSameForAnyNumberOfThreads)
{
    generate(turning_bar());
    const PartText text = with_last_at(part(11, 1), {0.5, 0.5, 0.5});
    EXPECT_EQ(to_json(count(text, 1)), to_json(count(text, 7)));
}

TEST_F(CountLeaks, DoesNotJudgeABodyThatBends)
{
    generate(turning_bar());
    PartText text = with_last_at(part(11, 0), {0.5, 0.5, 0.5});
    const ParticleSource source(folder_ / "Case");
    for (std::size_t i = 0; i < source.size(); ++i)
        if (source.mk(i) == 11 && source.position(i).x > 0.7) text.positions[i].z += 0.05;
    const LeakReport report = count(text);
    EXPECT_EQ(report.instants[0].inside, 0U);
    EXPECT_THAT(report.notes, testing::Contains(HasSubstr("mk 11 does not move as a rigid body")));
}

TEST_F(CountLeaks, FindsAParticleOutsideAClosedHousing)
{
    generate(closed_tank());
    const LeakReport within = count(with_last_at(part(), {0.5, 0.5, 0.9}));
    EXPECT_TRUE(within.has_housing);
    EXPECT_EQ(within.instants[0].outside, 0U);
    const LeakReport below = count(with_last_at(part(), {0.5, 0.5, -0.1}));
    EXPECT_EQ(below.instants[0].outside, 1U);
    EXPECT_EQ(count(with_last_at(part(), {0.5, 0.5, -40})).instants[0].outside, 1U);
    EXPECT_FALSE(below.is_tight());
}

TEST_F(CountLeaks, TakesAHousingWithTheWallsThatMove)
{
    CaseText text = closed_tank();
    text.after_geometry = rotation_of_mk(0);
    generate(text);
    const double eighth = std::numbers::pi / 4;
    // The tank stands on an edge, the other water is left where it was.
    const auto outside = [&](const Vec3& last)
    {
        const LeakReport report = count(with_last_at(part(10, eighth), last));
        EXPECT_TRUE(report.instants[0].outside.has_value());
        return report.instants[0].outside.value_or(0);
    };
    EXPECT_EQ(outside({0.1, 0.5, 0.1}), outside({0.5, 0.5, -0.05}) + 1);
}

TEST_F(CountLeaks, FollowsTheOneOfTwoWallsThatMoves)
{
    CaseText text = closed_tank();
    const std::string sides = "all";
    text.mainlist.replace(text.mainlist.rfind(sides), sides.size(),
                          "bottom | left | right | front | back");
    text.mainlist +=
        R"(<setmkbound mk="1" />)" + box_command(R"(x="0" y="0" z="1")", R"(x="1" y="1" z="0.1")");
    text.after_geometry = rotation_of_mk(1);
    generate(text);
    const PartText still = part();
    EXPECT_EQ(count(with_last_at(still, {0.5, 0.5, 1.3})).instants[0].outside, 1U);
    // The lid stands upright: the tank is open.
    const LeakReport open = count(with_last_at(part(11, std::numbers::pi / 2), {0.5, 0.5, 1.3}));
    EXPECT_EQ(open.instants[0].outside, std::nullopt);
    EXPECT_THAT(open.notes, testing::Contains(HasSubstr("The housing is open at 1 s")));
}

TEST_F(CountLeaks, HasNoHousingWhereTheTankIsOpen)
{
    generate(tank());
    const LeakReport report = count(with_last_at(part(), {0.5, 0.5, 1.8}));
    EXPECT_FALSE(report.has_housing);
    EXPECT_TRUE(report.is_tight());
    EXPECT_THAT(report.notes,
                testing::Contains(HasSubstr("Open surfaces have no inside: drawbox")));
}

TEST_F(CountLeaks, TakesWhatALaterVoidLeavesOutForEmpty)
{
    CaseText text = closed_tank();
    text.mainlist += R"(<setmkbound mk="1" />)" +
                     box_command(R"(x="0.2" y="0.2" z="0.7")", R"(x="0.6" y="0.6" z="0.2")") +
                     R"(<setmkvoid />)" +
                     box_command(R"(x="0.4" y="0.4" z="0.7")", R"(x="0.2" y="0.2" z="0.2")");
    generate(text);
    EXPECT_EQ(count(with_last_at(part(), {0.5, 0.5, 0.8})).instants[0].inside, 0U);
    EXPECT_EQ(count(with_last_at(part(), {0.3, 0.3, 0.8})).instants[0].inside, 1U);
}

TEST_F(CountLeaks, CountsWhatTheSolverHasTakenOut)
{
    generate(turning_bar());
    PartText text = part();
    text.ids.pop_back();
    text.positions.pop_back();
    const LeakReport report = count(text);
    EXPECT_EQ(report.instants[0].excluded, 1U);
    EXPECT_EQ(report.instants[0].fluid + 1, report.fluid);
}

TEST_F(CountLeaks, SortsTheOutputsOfAFolderByTime)
{
    generate(turning_bar());
    PartText text = part();
    std::filesystem::create_directory(folder_.path() / "data");
    for (const double time : {2.0, 0.5, 1.0})
    {
        text.time = time;
        write_text(
            folder_ / ("data/Part_000" + std::to_string(static_cast<int>(2 * time)) + ".bi4"),
            text.bytes());
    }
    const LeakReport report = count_leaks(folder_ / "Case", {folder_ / "data"}, {});
    ASSERT_EQ(report.instants.size(), 3U);
    EXPECT_EQ(report.instants[0].time, 0.5);
    EXPECT_EQ(report.instants[2].time, 2.0);
}

TEST_F(CountLeaks, NamesWhatIsNoOutputOfTheCase)
{
    generate(turning_bar());
    const auto message = [&](const std::string& part)
    { return ThrowsMessage<Error>(HasSubstr(part)); };
    PartText text = part();
    text.has_time = false;
    EXPECT_THAT([&] { count(text); }, message("it does not say its time"));
    text = part();
    text.positions.back().x = std::nan("");
    EXPECT_THAT([&] { count(text); }, message("is at (nan"));
    const std::string whole = part().bytes();
    write_text(folder_ / "half.bi4", whole.substr(0, whole.size() / 2));
    EXPECT_THAT([&] { count_leaks(folder_ / "Case", {folder_ / "half.bi4"}, {}); },
                message("half.bi4"));
    EXPECT_THAT([&] { count_leaks(folder_ / "none", {folder_ / "half.bi4"}, {}); },
                message("none"));
    std::filesystem::create_directory(folder_.path() / "empty");
    EXPECT_THAT([&] { count_leaks(folder_ / "Case", {folder_ / "empty"}, {}); },
                message("holds no file Part_*.bi4"));
}

TEST_F(CountLeaks, IsASubcommandThatWritesATableJsonAndAPlot)
{
    generate(closed_tank());
    write_text(folder_ / "Part_0001.bi4", with_last_at(part(), {0.5, 0.5, -0.1}).bytes());
    const RunResult result = run(
        folder_, {"leak", "Case", "Part_0001.bi4", "--json", "leak.json", "--plot", "leak.svg"});
    EXPECT_EQ(result.code, 1) << result.output;
    EXPECT_THAT(result.output, HasSubstr("in a closed housing"));
    EXPECT_THAT(result.output, HasSubstr("Leaks: "));
    EXPECT_THAT(read_text(folder_ / "leak.json"), HasSubstr("\"outside\": 1"));
    EXPECT_THAT(read_text(folder_ / "leak.svg"), HasSubstr("outside the housing"));
    write_text(folder_ / "Part_0001.bi4", part().bytes());
    EXPECT_EQ(run(folder_, {"leak", "Case", "Part_0001.bi4"}).code, 0);
    EXPECT_EQ(run(folder_, {"leak", "Case"}).code, 2);
    EXPECT_EQ(run(folder_, {"leak", "Case", "Part_0001.bi4", "--plot", "leak.png"}).code, 2);
}
