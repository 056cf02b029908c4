#include "fppg/case_def.h"
#include "fppg/error.h"
#include "fppg/lattice.h"
#include "fppg/scene.h"

#include "helpers/case_text.h"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <map>

namespace fppg
{
namespace
{

/// The field of a case (dp 0.1, first node at -0.5) that draws `commands` with mkbound 0 under
/// setfrdrawmode.
RunField field_of(const std::string& commands, int threads = 2)
{
    const test::TemporaryFolder folder;
    test::CaseText text;
    text.mainlist =
        "<setdrawmode mode=\"full\" /><setfrdrawmode auto=\"true\" />"
        "<setmkbound mk=\"0\" />" +
        commands;
    test::write_text(folder / "Case_Def.xml", text.text());
    LatticeReport report;
    return draw_scene(make_scene(read_case(folder / "Case_Def.xml", {})), threads, {}, report);
}

std::uint64_t node_particles(const RunField& field)
{
    std::uint64_t n = 0;
    for (const auto& slab : field.slabs)
        for (const Run& run : slab)
            if (!run.is_covered) n += run.z_end - run.z_begin;
    return n;
}

std::string point(double x)
{
    return "<drawpoint x=\"" + std::to_string(x) + "\" y=\"0.1\" z=\"0.1\" />";
}

// The numbers are those of GenCase v5.4.354.
TEST(OffLatticeDraw, KeepsTheTruePlaceOfAPoint)
{
    const RunField field = field_of(point(0.13));
    ASSERT_EQ(field.walls.volume.size(), 1u);
    EXPECT_DOUBLE_EQ(field.walls.volume.positions[0].x, 0.13);
    EXPECT_EQ(node_particles(field), 0u);
}

TEST(OffLatticeDraw, LeavesTheLastOfPointsThatAreTooNear)
{
    const RunField field = field_of(point(0.1) + point(0.16) + point(0.22));
    ASSERT_EQ(field.walls.volume.size(), 1u);
    EXPECT_DOUBLE_EQ(field.walls.volume.positions[0].x, 0.22);
}

TEST(OffLatticeDraw, GivesWayToALaterNodeOfAnotherMkOnly)
{
    const std::string lattice = "<setfrdrawmode auto=\"false\" />";
    const RunField other = field_of(point(0.13) + lattice + "<setmkbound mk=\"1\" />" + point(0.1));
    EXPECT_EQ(other.walls.volume.size(), 0u);
    EXPECT_EQ(node_particles(other), 1u);
    const RunField same = field_of(point(0.13) + lattice + point(0.1));
    EXPECT_EQ(same.walls.volume.size(), 1u);
    EXPECT_EQ(node_particles(same), 0u);
}

TEST(OffLatticeDraw, GivesWayToALaterParticleOfALowerMkAtItsNode)
{
    const std::string high = "<setmkbound mk=\"1\" />" + point(0.13);
    const std::string low = "<setmkbound mk=\"0\" />" + point(0.23);
    EXPECT_EQ(field_of(low + high).walls.volume.size(), 2u);
    const RunField field = field_of(high + low);
    ASSERT_EQ(field.walls.volume.size(), 1u);
    EXPECT_DOUBLE_EQ(field.walls.volume.positions[0].x, 0.23);
    EXPECT_EQ(node_particles(field), 0u);
}

TEST(OffLatticeDraw, DropsBothWallsWhoseSharedNodeIsPaintedOver)
{
    const RunField field =
        field_of(point(0.13) + "<setmkbound mk=\"1\" />" + point(0.23) +
                 "<setfrdrawmode auto=\"false\" /><setmkbound mk=\"2\" />" + point(0.2));
    EXPECT_EQ(field.walls.volume.size(), 0u);
    EXPECT_EQ(node_particles(field), 1u);
}

TEST(OffLatticeDraw, GivesEveryPartOfAPrismItsOwnMk)
{
    const RunField field = field_of(
        R"(<setmknextauto auto="true" /><drawprism><point x="0" y="0" z="0" />)"
        R"(<point x="0.44" y="0" z="0" /><point x="0" y="0.44" z="0" /><point x="0" y="0" z="0.53" />)"
        R"(<point x="0.44" y="0" z="0.53" /><point x="0" y="0.44" z="0.53" /></drawprism>)" +
        point(1.2));
    std::map<int, int> of_mk;
    for (const std::uint16_t mk : field.walls.volume.mk) ++of_mk[mk - 10];
    EXPECT_EQ(of_mk, (std::map<int, int>{{1, 3}, {2, 3}, {3, 21}, {4, 42}, {5, 42}, {6, 1}}));
    EXPECT_EQ(node_particles(field), 12u);
}

TEST(OffLatticeDraw, RefusesABoxWhoseParticlesWouldBeTooNear)
{
    EXPECT_THROW(field_of(R"(<drawbox><boxfill>solid</boxfill><point x="0" y="0" z="0" />)"
                          R"(<size x="0.21" y="0.1" z="0.1" /></drawbox>)"),
                 CaseError);
}

/// A trapezoid with its upper side from x = 0.1 to `end`.
std::string trapezoid(double end)
{
    return fmt::format(
        "<drawquadri><point x=\"0\" y=\"0\" z=\"0\" /><point x=\"1\" y=\"0\" "
        "z=\"0\" /><point x=\"{}\" y=\"0\" z=\"0.6\" />"
        "<point x=\"0.1\" y=\"0\" z=\"0.6\" /></drawquadri>",
        end);
}

TEST(OffLatticeDraw, RefusesATrapezoidWhoseSecondLegIsLonger)
{
    // GenCase v5.4.354 takes legs of 0.6083 and 0.6132, and refuses 0.6133.
    EXPECT_NO_THROW(field_of(trapezoid(0.8732)));
    EXPECT_THROW(field_of(trapezoid(0.873)), CaseError);
}

/// The particles of `commands` off the lattice in a 2D case at y = 0.
std::vector<Vec3> drawn_in_plane(const std::string& commands)
{
    const test::TemporaryFolder folder;
    test::CaseText text;
    text.pointmin = R"(<pointmin x="-0.5" y="0" z="-0.5" />)";
    text.pointmax = R"(<pointmax x="1.5" y="0" z="1.5" />)";
    text.mainlist = "<setfrdrawmode auto=\"true\" /><setmkbound mk=\"0\" />" + commands;
    test::write_text(folder / "Case_Def.xml", text.text());
    LatticeReport report;
    return draw_scene(make_scene(read_case(folder / "Case_Def.xml", {})), 2, {}, report)
        .walls.volume.positions;
}

std::vector<Vec3> in_plane(const std::string& corners)
{
    return drawn_in_plane("<drawquadri>" + corners + "</drawquadri>");
}

// A kilobyte of text shall not cost gigabytes or minutes.
TEST(OffLatticeDraw, RefusesWhatLiesAlmostWhollyOutsideOfTheDomain)
{
    const auto is_refused = [](const std::string& command)
    {
        try
        {
            (void)field_of(command);
            return std::string("it was drawn");
        }
        catch (const CaseError& e)
        {
            return std::string(e.what());
        }
    };
    const std::string corner = R"(<point x="0.1" y="0.1" z="0.1" />)";
    for (const char* size : {"1e5", "4294967296", "1e150"})
        for (
            const char* command : {
                R"(<drawbox><boxfill>solid</boxfill>{0}<size x="{1}" y="1000" z="1000" /></drawbox>)",
                R"(<drawsphere radius="{1}">{0}</drawsphere>)",
                R"(<drawcylinder radius="1000">{0}<point x="{1}" y="0.1" z="0.1" /></drawcylinder>)",
                R"(<drawtriangle>{0}<point x="{1}" y="0.1" z="0.1" /><point x="0.1" y="5000" z="0.2" /></drawtriangle>)",
                R"(<drawpyramid>{0}<point x="{1}" y="0.1" z="0.1" /><point x="5" y="5000" z="0.2" /><point x="1" y="1" z="3000" /></drawpyramid>)",
            })
        {
            const std::string drawn = fmt::format(fmt::runtime(command), corner, size);
            EXPECT_THAT(is_refused(drawn),
                        testing::AnyOf(testing::HasSubstr("outside of the domain"),
                                       testing::HasSubstr("dp long")))
                << drawn;
        }
}

TEST(OffLatticeDraw, DrawsTheEndOfALongObliqueTriangle)
{
    // Its sides leave the domain at once; the box around it has 10^10 places of the square grid.
    const RunField field =
        field_of(R"(<drawtriangle><point x="0" y="0" z="0" /><point x="9000" y="9000" z="0" />)"
                 R"(<point x="9000" y="9000.4" z="0" /></drawtriangle>)");
    EXPECT_GT(field.walls.volume.size(), 0u);
    for (const Vec3& p : field.walls.volume.positions)
    {
        EXPECT_GE(p.y, p.x - 1e-9);
        EXPECT_LE(p.y, p.x * (1 + 0.4 / 9000) + 1e-9);
    }
}

TEST(OffLatticeDraw, DrawsASphereOfA2dCaseAsADisc)
{
    const auto count = [](const std::string& mode, double y)
    {
        return drawn_in_plane(fmt::format(R"(<setdrawmode mode="{}" /><drawsphere radius="0.35">)"
                                          R"(<point x="0.68" y="{}" z="0.62" /></drawsphere>)",
                                          mode, y))
            .size();
    };
    EXPECT_EQ(count("full", 0), 57U);
    EXPECT_EQ(count("face", 0), 57U);
    EXPECT_EQ(count("solid", 0), 0U);
    EXPECT_EQ(count("full", 0.4), 1U);
}

TEST(OffLatticeDraw, EmptiesWhatStandsAtAFilledCylinderOnly)
{
    const std::string cylinder = R"(<drawcylinder radius="0.3"><point x="0.5" y="0.5" z="0.2" />)"
                                 R"(<point x="0.5" y="0.5" z="0.8" /></drawcylinder>)";
    // On the node at a distance of 0.06 from the tube.
    const std::string beside = R"(<drawpoint x="0.8" y="0.7" z="0.5" />)";
    const auto count = [](const std::string& commands)
    { return field_of(commands).walls.volume.size(); };
    EXPECT_EQ(count(beside + cylinder), count(cylinder));
    const std::string face = "<setdrawmode mode=\"face\" />";
    EXPECT_EQ(count(face + "<drawpoint x=\"0.8\" y=\"0.8\" z=\"0.5\" />" + cylinder),
              count(face + cylinder) + 1);
}

TEST(OffLatticeDraw, DrawsAQuadThatCrossesThePlaneOfA2dCaseAsLines)
{
    EXPECT_EQ(in_plane(R"(<point x="0.2" y="-0.2" z="0.1" /><point x="1.13" y="0.3" z="0.4" />)"
                       R"(<point x="0.5" y="0.25" z="1.1" /><point x="0.1" y="-0.25" z="0.9" />)")
                  .size(),
              9u);
    // At right angles to x the two triangles keep a line each: four intervals of 0.47, not five.
    EXPECT_EQ(in_plane(R"(<point x="0.1" y="-0.3" z="0.1" /><point x="0.1" y="-0.3" z="0.57" />)"
                       R"(<point x="0.1" y="0.3" z="0.57" /><point x="0.1" y="0.3" z="0.1" />)")
                  .size(),
              5u);
}

TEST(OffLatticeDraw, IsTheSameWithOneAndEightThreads)
{
    const std::string sphere =
        R"(<drawsphere radius="0.37"><point x="0.31" y="0.52" z="0.47" /></drawsphere>)";
    const RunField one = field_of(sphere, 1);
    const RunField eight = field_of(sphere, 8);
    EXPECT_GT(one.walls.volume.size(), 200u);
    EXPECT_EQ(one.walls.volume.positions, eight.walls.volume.positions);
    EXPECT_EQ(one.slabs, eight.slabs);
}

} // namespace
} // namespace fppg
