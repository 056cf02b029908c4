#include "fppg/new_case.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <regex>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/transforms.h"
#include "newcase/gearbox_parts.h"

namespace fppg
{

using test::add_facet;
using test::add_quad;
using test::box;
using test::fault_of;
using test::GearboxParts;
using test::proposal;
using test::TemporaryFolder;
using test::write_stl;
using ::testing::HasSubstr;

namespace
{

/// A tank, and in it a block of 0.3 x 0.2 x 0.1 m, turned about (1, 2, 3) by some degrees.
class TankWithABlock
{
public:
    explicit TankWithABlock(double degrees)
        : turn(around(middle, rotation({1, 2, 3}, radians(degrees))))
    {
        write_stl(folder / "tank.stl", test::housing({-1, -1, -1}, {1, 1, 1}, 0.05));
        TriangleSoup block = box(middle - Vec3{0.15, 0.1, 0.05}, middle + Vec3{0.15, 0.1, 0.05});
        for (Vec3& v : block.vertices) v = turn(v);
        write_stl(folder / "block.stl", block);
        options.inputs = {folder.path().string()};
        options.output = folder / "Case_Def.xml";
        options.unit = "m";
        options.fill = "water=20%@tank";
        options.dp = 0.02;
        options.duration = 1;
    }

    static constexpr Vec3 middle{0.1, -0.2, 0.3};
    Transform turn;
    TemporaryFolder folder;
    NewCaseOptions options;
};

std::string direction_text(const Vec3& v)
{
    return fmt::format("{:.9g},{:.9g},{:.9g}", v.x, v.y, v.z);
}

Vec3 vector_in(const std::string& xml, const std::string& name)
{
    const std::regex form("<" + name + " x=\"([^\"]*)\" y=\"([^\"]*)\" z=\"([^\"]*)\"");
    std::smatch found;
    if (!std::regex_search(xml, found, form)) throw std::runtime_error("no " + name);
    return {std::stod(found[1]), std::stod(found[2]), std::stod(found[3])};
}

/// The points of a box and the way of its fluid, as the solver v5.4 makes them
/// (JSphInOutPoints::Create3d_Box).
struct ZonePoints
{
    std::vector<Vec3> points;
    Vec3 direction;
};

ZonePoints zone_points(const std::string& definition, double dp)
{
    const std::string xml = definition.substr(definition.find("<zone3d>"));
    const Vec3 from = vector_in(xml, "point"), size = vector_in(xml, "size");
    ZonePoints out;
    out.direction = vector_in(xml, "direction");
    std::array<int, 3> n{};
    for (int axis = 0; axis < 3; ++axis)
        n[static_cast<std::size_t>(axis)] = static_cast<int>(size[axis] / dp) + 1;
    for (int x = 0; x < n[0]; ++x)
        for (int y = 0; y < n[1]; ++y)
            for (int z = 0; z < n[2]; ++z)
                out.points.push_back(from + dp * Vec3{1.0 * x, 1.0 * y, 1.0 * z});
    std::smatch found;
    if (!std::regex_search(xml, found, std::regex("<rotateaxis angle=\"([^\"]*)\""))) return out;
    const Vec3 one = vector_in(xml, "point1"), two = vector_in(xml, "point2");
    // Clockwise seen from point2.
    const Transform turn = around(one, rotation(two - one, -radians(std::stod(found[1]))));
    const Vec3 start = turn({});
    for (Vec3& p : out.points) p = turn(p);
    out.direction = turn(out.direction) - start;
    return out;
}

} // namespace

TEST(NewCase, LetsFluidInThroughARoundFace)
{
    const GearboxParts parts;
    TriangleSoup nozzle;
    const Vec3 below{0.02, 0.02, 0.01}, above{0.02, 0.02, 0.014};
    constexpr int sides = 64;
    for (int i = 0; i < sides; ++i)
    {
        const auto rim = [](int k, const Vec3& middle) -> Vec3
        {
            const double angle = 2 * std::numbers::pi * k / sides;
            return middle + Vec3{0.003 * std::cos(angle), 0.003 * std::sin(angle), 0};
        };
        add_facet(nozzle, below, rim(i + 1, below), rim(i, below));
        add_facet(nozzle, above, rim(i, above), rim(i + 1, above));
        add_quad(nozzle, rim(i, below), rim(i + 1, below), rim(i + 1, above), rim(i, above));
    }
    write_stl(parts.folder / "nozzle.stl", nozzle, 1000);
    NewCaseOptions options = parts.options;
    options.inlets = {"nozzle:-z=2m/s"};
    const NewCase made = propose_case(options);
    EXPECT_THAT(made.xml, HasSubstr("<direction x=\"0\" y=\"0\" z=\"-1\" />"));
    EXPECT_THAT(made.xml, HasSubstr("<velocity v=\"2\""));
    // pi (3 mm)^2 times 2 m/s.
    EXPECT_THAT(proposal(made, "inlet nozzle:-z").reason, HasSubstr("3.38"));
    options.inlets = {"wheel:z=2m/s"};
    EXPECT_THAT(fault_of(options), HasSubstr("is no disc and no rectangle"));
    options.inlets = {"pinion=2m/s"};
    EXPECT_THAT(fault_of(options), HasSubstr("is no flat sheet"));
}

TEST(NewCaseInlet, IsARectangleOfAnyTilt)
{
    for (const double degrees : {0.0, 20.0, 90.0, 137.0, 180.0})
        for (const Vec3& side : {Vec3{0, 0, 1}, Vec3{0, 0, -1}, Vec3{1, 0, 0}, Vec3{0, -1, 0}})
        {
            TankWithABlock parts(degrees);
            const Vec3 start = parts.turn({});
            const Vec3 way = parts.turn(side) - start;
            parts.options.inlets = {"block:" + direction_text(way) + "=0.5m/s"};
            const double dp = parts.options.dp;
            const ZonePoints zone = zone_points(propose_case(parts.options).xml, dp);
            EXPECT_LT(norm(zone.direction - way), 1e-6) << degrees;
            // In the places of the block: five dp before its face, within the rim by a quarter to
            // three quarters of dp, as many as the face has dp^2.
            const Vec3 half{0.15, 0.1, 0.05};
            double area = 1;
            for (int axis = 0; axis < 3; ++axis)
            {
                if (side[axis] != 0) continue;
                area *= 2 * half[axis];
                const Vec3 edge = parts.turn(axis == 0   ? Vec3{1, 0, 0}
                                             : axis == 1 ? Vec3{0, 1, 0}
                                                         : Vec3{0, 0, 1}) -
                                  start;
                double farthest = 0;
                for (const Vec3& p : zone.points)
                    farthest = std::max(farthest, std::abs(dot(p - parts.middle, edge)));
                EXPECT_NEAR(half[axis] - farthest, dp / 2, dp / 4 + 1e-6) << degrees;
            }
            EXPECT_NEAR(static_cast<double>(zone.points.size()) * dp * dp / area, 1, 0.05);
            for (const Vec3& p : zone.points)
                EXPECT_NEAR(dot(p - parts.middle, way), std::abs(dot(half, side)) + 5 * dp, 1e-5);
        }
}

TEST(NewCaseInlet, KeepsAFlowToTheLitre)
{
    TankWithABlock parts(0);
    parts.options.inlets = {"block:x=120l/min"};
    const NewCase made = propose_case(parts.options);
    EXPECT_THAT(made.xml, HasSubstr("<velocity v=\"2\" units_comment=\"l/s\""));
    EXPECT_THAT(made.xml, HasSubstr("<flowvelocity active=\"true\" ratio=\"1\" units=\"l/s\""));
    // Through 0.2 x 0.1 m.
    EXPECT_THAT(proposal(made, "inlet block:x").value, HasSubstr("0.1 m/s along (1,0,0)"));
}

TEST(NewCaseInlet, OfASheetLooksIntoTheVesselWhicheverWayItsFacetsLook)
{
    for (const bool is_turned : {false, true})
    {
        TankWithABlock parts(0);
        TriangleSoup sheet;
        const std::array<Vec3, 4> c{Vec3{-0.95, -0.1, 0}, Vec3{-0.95, 0.1, 0},
                                    Vec3{-0.95, 0.1, 0.2}, Vec3{-0.95, -0.1, 0.2}};
        if (is_turned)
            add_quad(sheet, c[3], c[2], c[1], c[0]);
        else
            add_quad(sheet, c[0], c[1], c[2], c[3]);
        write_stl(parts.folder / "inlet.stl", sheet);
        // What is called an inlet and is a sheet is none of the walls.
        EXPECT_THAT(fault_of(parts.options), HasSubstr("--inlet inlet=2m/s is missing"));
        parts.options.ask = [](const std::string& question, const std::string&)
        {
            EXPECT_THAT(question, HasSubstr("come in through inlet"));
            return std::string("0.4m/s");
        };
        const NewCase made = propose_case(parts.options);
        EXPECT_LT(norm(zone_points(made.xml, parts.options.dp).direction - Vec3{1, 0, 0}), 1e-9);
        EXPECT_EQ(made.xml.find("inlet.stl"), std::string::npos);
    }
}

/// In the middle of the wall, which is 2.5 dp thick: the last of its rows must be in the tank.
TEST(NewCaseInlet, OfASheetInTheWallStandsBeforeTheWall)
{
    TankWithABlock parts(0);
    TriangleSoup sheet;
    add_quad(sheet, {-0.975, -0.1, 0}, {-0.975, 0.1, 0}, {-0.975, 0.1, 0.2}, {-0.975, -0.1, 0.2});
    write_stl(parts.folder / "inlet.stl", sheet);
    parts.options.inlets = {"inlet=0.4m/s"};
    parts.options.dp = 0.01;
    const ZonePoints zone = zone_points(propose_case(parts.options).xml, parts.options.dp);
    EXPECT_GT(zone.points.front().x - 3 * parts.options.dp, -0.95 + 0.2 * parts.options.dp);
    EXPECT_LT(zone.points.front().x, -0.95 + 5 * parts.options.dp);
}

/// The block is 0.05 m over the floor of the tank, 4 dp.
TEST(NewCaseInlet, WithoutRoomForItsZoneIsAFault)
{
    TankWithABlock parts(0);
    write_stl(parts.folder / "block.stl", box({-0.1, -0.1, -0.9}, {0.1, 0.1, -0.7}));
    parts.options.inlets = {"block:-z=1m/s"};
    parts.options.dp = 0.0125;
    const std::string fault = fault_of(parts.options);
    EXPECT_THAT(fault, HasSubstr("there is no room for the zone before its face"));
    EXPECT_THAT(fault, HasSubstr("tank.stl is in the way"));
    std::smatch found;
    ASSERT_TRUE(std::regex_search(fault, found, std::regex("a dp of ([0-9.]+) m or less")));
    parts.options.dp = std::stod(found[1]);
    const ZonePoints zone = zone_points(propose_case(parts.options).xml, parts.options.dp);
    EXPECT_GT(zone.points.front().z, -0.95);
}

TEST(NewCaseInlet, NamesTheFacesThatItCouldBe)
{
    TankWithABlock parts(20);
    parts.options.inlets = {"block:0,0,1=1m/s"};
    const std::string fault = fault_of(parts.options);
    EXPECT_THAT(fault, HasSubstr("block.stl: no flat face of the part looks along 0,0,1"));
    const Vec3 up = parts.turn({0, 0, 1}) - parts.turn({});
    EXPECT_THAT(fault, HasSubstr(fmt::format("{:.5g},{:.5g},{:.5g} (6", up.x, up.y, up.z)));
}

TEST(NewCaseInlet, AsksWhichOfTwoFacesSideBySide)
{
    TankWithABlock parts(0);
    TriangleSoup two = box({-0.5, 0, 0.5}, {-0.4, 0.1, 0.6});
    const TriangleSoup other = box({0.4, 0, 0.5}, {0.5, 0.1, 0.6});
    two.vertices.insert(two.vertices.end(), other.vertices.begin(), other.vertices.end());
    write_stl(parts.folder / "jets.stl", two);
    parts.options.inlets = {"jets:-z=1m/s"};
    EXPECT_THAT(fault_of(parts.options), HasSubstr("side by side"));
    parts.options.inlets = {"jets:-z@0.45,0.05,0.5=1m/s"};
    const ZonePoints zone = zone_points(propose_case(parts.options).xml, parts.options.dp);
    EXPECT_GT(zone.points.front().x, 0.4);
}

} // namespace fppg
