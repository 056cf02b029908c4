#include "fppg/motion_gaps.h"

#include <array>
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "core/transforms.h"
#include "helpers/case_text.h"
#include "helpers/gears.h"
#include "meshes/surface_gap.h"
#include "meshes/test_shapes.h"
#include "particles/motion_path.h"

namespace fppg
{

namespace
{

using test::box;
using test::CaseText;
using test::GearShape;
using test::TemporaryFolder;

Transform turned(const Vec3& about, double degrees)
{
    return around(about, rotation({0, 0, 1}, radians(degrees)));
}

} // namespace

TEST(SurfaceGap, OfTwoBoxesIsThatOfTheirEdges)
{
    const GapTree one(box({0, 0, 0}, {1, 1, 1}));
    const GapTree other(box({0, 0, 0}, {1, 1, 1}));
    const SurfaceGap gap = one.gap_to(other, translation({1.3, 1.4, 0.2}));
    EXPECT_NEAR(gap.distance, 0.5, 1e-12);
    EXPECT_FALSE(gap.crosses);
    EXPECT_TRUE(one.gap_to(other, translation({0.9, 0.8, 0.1})).crosses);
    EXPECT_EQ(one.gap_to(other, translation({1, 0, 0})).distance, 0);
    EXPECT_TRUE(std::isinf(one.gap_to(other, translation({1.3, 1.4, 0}), 0.4).distance));
}

TEST(SurfaceGap, OfFacetsEqualsThatOfAllPairs)
{
    const TriangleSoup ball = test::sphere(2);
    const GapTree one(ball), other(ball);
    const Transform place = translation({2.5, 0.3, 0.2}) * rotation({1, 2, 3}, 0.7);
    double least = 1e9;
    for (std::size_t f = 0; f < ball.size(); ++f)
        for (std::size_t g = 0; g < ball.size(); ++g)
        {
            const auto single = [&](std::size_t k)
            {
                TriangleSoup soup;
                for (std::size_t c = 0; c < 3; ++c)
                    soup.vertices.push_back(ball.vertices[3 * k + c]);
                return GapTree(soup);
            };
            least = std::min(least, single(f).gap_to(single(g), place).distance);
        }
    EXPECT_NEAR(one.gap_to(other, place).distance, least, 1e-12);
}

TEST(SurfaceGap, OfTwoGearsIsTheirBacklashAtEveryAngle)
{
    // Teeth that are thinner on the pitch circle leave the same gap along the line of action at
    // every angle: half of the play on each side, times the cosine of the pressure angle.
    constexpr double dp = 0.0005, backlash = 0.0004;
    const GearShape a{.teeth = 20, .backlash = backlash, .steps = 60};
    const GearShape b{.teeth = 30, .backlash = backlash, .turned_deg = 6, .steps = 60};
    const Vec3 at_b{a.pitch_radius() + b.pitch_radius(), 0, 0};
    const GapTree one(gear_mesh(a)), other(gear_mesh(b, at_b));
    const double exact = backlash / 2 * std::cos(test::pressure_angle);
    for (int k = 0; k < 72; ++k)
    {
        const double angle = 360.0 * k / 72 / 20 * 1.5;
        const Transform place = turned({}, -angle) * turned(at_b, -angle * 20 / 30);
        EXPECT_NEAR(one.gap_to(other, place).distance / dp, exact / dp, 0.02) << angle;
    }
}

namespace
{

/// A wall at x = 1, and half a metre before it a box that moves; dp 0.1.
void write_moving_box(const TemporaryFolder& folder, const std::string& motion)
{
    CaseText text;
    text.mainlist = R"(<setdrawmode mode="full" /><setmkbound mk="0" />)" +
                    test::box_command(R"(x="1" y="0" z="0")", R"(x="0.2" y="1" z="1")") +
                    R"(<setmkbound mk="1" />)" +
                    test::box_command(R"(x="0.2" y="0.2" z="0.2")", R"(x="0.3" y="0.3" z="0.3")");
    text.after_geometry = "<motion><objreal ref=\"1\"><begin mov=\"1\" start=\"0\" />" + motion +
                          "</objreal></motion>";
    test::write_text(folder / "Case_Def.xml", text.text());
}

MotionGaps gaps_of(const TemporaryFolder& folder, const std::string& motion)
{
    write_moving_box(folder, motion);
    MotionGapOptions options;
    options.finds_passages = false;
    return measure_motion_gaps(folder / "Case_Def.xml", options);
}

} // namespace

TEST(MotionGaps, FollowABoxToAWall)
{
    const TemporaryFolder folder;
    const MotionGaps gaps = gaps_of(
        folder,
        R"(<mvrectsinu id="1" duration="10"><freq x="0.5" y="0" z="0" units_comment="1/s" />)"
        R"(<ampl x="0.37" y="0" z="0" /><phase x="0" y="0" z="0" /></mvrectsinu>)");
    ASSERT_EQ(gaps.pairs.size(), 1u);
    const MkGap& pair = gaps.pairs[0];
    EXPECT_TRUE(pair.moves);
    EXPECT_NEAR(pair.least_dp, (0.5 - 0.37) / 0.1, 0.001);
    EXPECT_NEAR(pair.time, 0.5, 0.02);
    EXPECT_EQ(pair.overlapping, 0);
}

TEST(MotionGaps, SayWhenPartsOverlapAndHowDeep)
{
    const TemporaryFolder folder;
    const MotionGaps gaps =
        gaps_of(folder, R"(<mvrect id="1" duration="1"><vel x="0.6" y="0" z="0" /></mvrect>)");
    const MkGap& pair = gaps.pairs[0];
    EXPECT_GT(pair.overlapping, 0);
    EXPECT_NEAR(pair.overlap_time, 0.5 / 0.6, 0.05);
    EXPECT_NEAR(pair.depth_dp, 1, 0.3);
    EXPECT_EQ(pair.least_dp, 0);
}

namespace
{

/// Pairs of blocks of a cubic metre in water, 1.5, 2.5 and 3.5 dp of 0.1 m apart, and a pair 1.5 dp
/// apart in a closed box, where water does not come.
CaseText pairs_in_water()
{
    CaseText text;
    text.pointmax = R"(<pointmax x="4.5" y="6.5" z="5.5" />)";
    text.mainlist = R"(<setdrawmode mode="full" /><setmkfluid mk="0" />)" +
                    test::box_command(R"(x="0" y="0" z="0")", R"(x="4" y="6" z="2")") +
                    R"(<setmkbound mk="0" />)" +
                    test::box_command(R"(x="0" y="0" z="2.5")", R"(x="4" y="2" z="2.5")",
                                      "bottom | top | left | right | front | back") +
                    R"(<setmkbound mk="1" />)" +
                    test::box_command(R"(x="0.5" y="0.5" z="3.25")", R"(x="1" y="1" z="1")") +
                    R"(<setmkbound mk="2" />)" +
                    test::box_command(R"(x="1.65" y="0.5" z="3.25")", R"(x="1" y="1" z="1")");
    const std::array<const char*, 3> seconds{"1.65", "1.75", "1.85"};
    for (std::size_t i = 0; i < seconds.size(); ++i)
    {
        const std::string y = std::to_string(0.5 + 2 * static_cast<double>(i));
        text.mainlist +=
            R"(<setmkbound mk="3" />)" +
            test::box_command(R"(x="0.5" y=")" + y + R"(" z="0.5")", R"(x="1" y="1" z="1")") +
            R"(<setmkbound mk="4" />)" +
            test::box_command(std::string("x=\"") + seconds[i] + R"(" y=")" + y + R"(" z="0.5")",
                              R"(x="1" y="1" z="1")");
    }
    return text;
}

} // namespace

TEST(Passages, AreFoundWhereFluidComesByTheirWidth)
{
    const TemporaryFolder folder;
    test::write_text(folder / "Case_Def.xml", pairs_in_water().text());
    MotionGaps gaps = measure_motion_gaps(folder / "Case_Def.xml", {});
    // Two faces of a square metre each, a place a dp^2; of the places at their rims some see past.
    EXPECT_NEAR(gaps.narrow_area[0], 2, 0.1);
    EXPECT_NEAR(gaps.narrow_area[1], 4, 0.2);
    EXPECT_NEAR(gaps.narrow_area[2], 6, 0.3);
    EXPECT_NEAR(gaps.narrowest_dp, 1.5, 1e-6);
    EXPECT_NEAR(gaps.resolving_dp, 0.15 / 4, 1e-6);
    for (const NarrowPlace& place : gaps.places)
    {
        EXPECT_LT(place.position.z, 2);
        EXPECT_TRUE(place.mkbound == 3 || place.mkbound == 4) << place.mkbound;
        // Of each pair by its y: 1.5, 2.5 and 3.5 dp.
        EXPECT_NEAR(place.gap_dp, 1.5 + std::floor(place.position.y / 2), 1e-5);
    }
    EXPECT_TRUE(to_vtk(gaps).find("POINTS " + std::to_string(gaps.places.size()) + " float") !=
                std::string::npos);
    // (0.1 / 0.0375)^3 times 1e4, and its square for walls of 1e3.
    gaps.volume_particles = 1e4;
    gaps.wall_particles = 1e3;
    EXPECT_TRUE(to_text(gaps).find("about 2e+05 particles, 1.9e+05 of fluid and floating bodies, "
                                   "7.1e+03 of walls; 1.1e+04 now") != std::string::npos)
        << to_text(gaps);
}

TEST(NearPlaces, FollowPartsThatMove)
{
    // A box that comes to a wall at 0.5 m in a second: 0.2 m, or two dp, are left.
    const TemporaryFolder folder;
    write_moving_box(folder,
                     R"(<mvrect id="1" duration="10"><vel x="0.3" y="0" z="0" /></mvrect>)");
    MotionGapOptions options;
    options.finds_passages = false;
    const NearPlaces found =
        find_near_places(folder / "Case_Def.xml", options, {0, 0.5, 0.75, 1}, 3);
    ASSERT_EQ(found.places.size(), 2u);
    EXPECT_EQ(found.places[0].look, 2u);
    EXPECT_NEAR(found.places[0].gap_dp, (0.5 - 0.225) / 0.1, 1e-6);
    EXPECT_EQ(found.places[1].look, 3u);
    EXPECT_NEAR(found.places[1].gap_dp, 2, 1e-6);
    EXPECT_NEAR(found.places[1].place.x, 0.9, 1e-9);
    EXPECT_EQ(found.mk_bound_first, 10);
}

TEST(MotionGaps, TurnAsTheSolverDoes)
{
    // The solver v5.4 turns clockwise seen from axisp2: about y, what is at +z goes to -x.
    const auto point = [](const char* name, const char* y)
    {
        Element e;
        e.name = name;
        e.attributes = {{"x", "0"}, {"y", y}, {"z", "0"}};
        return e;
    };
    Element speed, movement, begin, object;
    speed.name = "vel";
    speed.attributes = {{"ang", "90"}};
    movement.name = "mvrot";
    movement.attributes = {{"id", "1"}, {"duration", "10"}, {"anglesunits", "degrees"}};
    movement.children = {speed, point("axisp1", "0"), point("axisp2", "1")};
    begin.name = "begin";
    begin.attributes = {{"mov", "1"}, {"start", "0"}};
    object.name = "objreal";
    object.children = {begin, movement};
    const Vec3 now = (*place_at({&object}, 1))({0, 0, 1});
    EXPECT_NEAR(now.x, -1, 1e-12);
    EXPECT_NEAR(now.z, 0, 1e-12);
}

} // namespace fppg
