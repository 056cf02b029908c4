#include "fppg/new_case.h"

#include <cmath>
#include <filesystem>
#include <numbers>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "fppg/error.h"
#include "helpers/case_text.h"
#include "helpers/gears.h"
#include "helpers/run_fppg.h"
#include "meshes/test_shapes.h"

namespace fppg
{

namespace
{

using test::box;
using test::gear_mesh;
using test::GearShape;
using test::TemporaryFolder;
using test::write_stl;
using ::testing::HasSubstr;

/// A box with a cavity, and perhaps without its lid; metres.
TriangleSoup housing(const Vec3& low, const Vec3& high, double wall, bool is_open = false)
{
    TriangleSoup soup = box(low, high);
    const Vec3 by{wall, wall, wall};
    Vec3 top = high - by;
    if (is_open) top.z = high.z;
    TriangleSoup inner = box(low + by, top);
    for (std::size_t f = 0; f < inner.size(); ++f)
        std::swap(inner.vertices[3 * f + 1], inner.vertices[3 * f + 2]);
    if (is_open)
    {
        // A basin: the bottom and four sides of both boxes, and the rim between them.
        const auto without_top = [](const TriangleSoup& from, double z)
        {
            TriangleSoup out;
            for (std::size_t f = 0; f < from.size(); ++f)
            {
                const Vec3* c = &from.vertices[3 * f];
                if (c[0].z == z && c[1].z == z && c[2].z == z) continue;
                out.vertices.insert(out.vertices.end(), c, c + 3);
            }
            return out;
        };
        soup = without_top(soup, high.z);
        inner = without_top(inner, high.z);
        const Vec3 a = low + by;
        const std::array<Vec3, 4> outer{Vec3{low.x, low.y, high.z}, Vec3{high.x, low.y, high.z},
                                        Vec3{high.x, high.y, high.z}, Vec3{low.x, high.y, high.z}};
        const std::array<Vec3, 4> rim{Vec3{a.x, a.y, high.z}, Vec3{top.x, a.y, high.z},
                                      Vec3{top.x, top.y, high.z}, Vec3{a.x, top.y, high.z}};
        for (std::size_t i = 0; i < 4; ++i)
            test::add_quad(soup, outer[i], outer[(i + 1) % 4], rim[(i + 1) % 4], rim[i]);
    }
    soup.vertices.insert(soup.vertices.end(), inner.vertices.begin(), inner.vertices.end());
    return soup;
}

/// Two gears of 20 and 30 teeth that mesh, about z, in a housing; millimetres in the files.
class GearboxParts
{
public:
    explicit GearboxParts(double distance = 0.05, bool is_open = false)
    {
        const GearShape a{.teeth = 20, .backlash = 0.0004};
        const GearShape b{.teeth = 30, .backlash = 0.0004, .turned_deg = 6};
        write_stl(folder / "pinion.stl", gear_mesh(a), 1000);
        write_stl(folder / "wheel.stl", gear_mesh(b, {distance, 0, 0}), 1000);
        write_stl(folder / "housing.stl",
                  housing({-0.03, -0.042, -0.02}, {0.092, 0.042, 0.02}, 0.004, is_open), 1000);
        options.inputs = {folder.path().string()};
        options.output = folder / "Case_Def.xml";
        options.rotations = {"pinion=3000deg/s"};
        options.fill = "oil=0.1l@housing";
        options.particles = 40000;
    }

    TemporaryFolder folder;
    NewCaseOptions options;
};

const Proposal& proposal(const NewCase& made, const std::string& what)
{
    for (const Proposal& p : made.proposals)
        if (p.what == what) return p;
    throw std::runtime_error("no proposal of " + what);
}

std::string fault_of(const NewCaseOptions& options)
{
    try
    {
        (void)propose_case(options);
    }
    catch (const Error& error)
    {
        return error.what();
    }
    return "";
}

} // namespace

TEST(NewCase, FindsUnitsHousingAndWhatMeshes)
{
    const GearboxParts parts;
    const NewCase made = propose_case(parts.options);
    EXPECT_EQ(made.kind, "gearbox");
    EXPECT_EQ(proposal(made, "unit").value, "mm");
    EXPECT_THAT(proposal(made, "pinion").value, HasSubstr("3000 deg/s"));
    EXPECT_THAT(proposal(made, "pinion").value, HasSubstr("z through (0, 0, 0) m"));
    EXPECT_THAT(proposal(made, "wheel").value, HasSubstr("-2000 deg/s"));
    EXPECT_THAT(proposal(made, "wheel").value, HasSubstr("z through (0.05, 0, 0) m"));
    EXPECT_THAT(proposal(made, "wheel").reason, HasSubstr("20 teeth against 30"));
    EXPECT_THAT(proposal(made, "housing").value, HasSubstr("holds the fluid"));
    EXPECT_THAT(proposal(made, "backlash").value, HasSubstr("0.18"));
    // A tenth of a second and more of 3 m/s: the speed of sound is ten times that of the tips.
    EXPECT_THAT(proposal(made, "speed of sound").value, HasSubstr("12 m/s"));
}

TEST(NewCase, IsAcceptedByTheProgramWithItsLitres)
{
    const GearboxParts parts;
    const test::RunResult made =
        test::run(parts.folder, {"new", ".", "-o", "Case_Def.xml", "--rotate", "pinion=3000deg/s",
                                 "--fill", "oil=0.1l", "--particles", "40k", "--threads", "2"});
    ASSERT_EQ(made.code, 0) << made.output;
    EXPECT_TRUE(std::filesystem::exists(parts.folder / "Case.png"));
    const test::RunResult run = test::run(parts.folder, {"Case_Def", "out/Case", "-threads:2"});
    ASSERT_EQ(run.code, 0) << run.output;
    const test::RunResult again = test::run(
        parts.folder, {"new", ".", "-o", "Again_Def.xml", "--rotate", "pinion=3000deg/s", "--fill",
                       "oil=0.1l", "--particles", "40k", "--threads", "1", "--no-picture"});
    ASSERT_EQ(again.code, 0) << again.output;
    EXPECT_EQ(test::read_text(parts.folder / "Case_Def.xml"),
              test::read_text(parts.folder / "Again_Def.xml"));
}

TEST(NewCase, WheelsRollAndTheWaterComesFromTheFront)
{
    const TemporaryFolder folder;
    const auto drum = [](const Vec3& at)
    {
        TriangleSoup soup = gear_mesh({.module_m = 0.02, .teeth = 30, .width = 0.2});
        for (Vec3& v : soup.vertices) v = at + Vec3{v.x, -v.z, v.y};
        return soup;
    };
    write_stl(folder / "body.stl", box({-2, -0.7, 0.35}, {2, 0.7, 1.3}));
    write_stl(folder / "wheel_front.stl", drum({1.3, 0.85, 0.32}));
    write_stl(folder / "wheel_rear.stl", drum({-1.3, 0.85, 0.32}));
    NewCaseOptions options;
    options.inputs = {folder.path().string()};
    options.output = folder / "Case_Def.xml";
    options.water = 0.4;
    options.speed = 5;
    const NewCase made = propose_case(options);
    EXPECT_EQ(made.kind, "wading");
    EXPECT_EQ(proposal(made, "unit").value, "m");
    // 5 m/s over a radius of 0.32 m.
    EXPECT_THAT(proposal(made, "wheel_front").value, HasSubstr("turns at 89"));
    EXPECT_THAT(made.xml, HasSubstr("XPeriodicIncZ"));
    EXPECT_THAT(made.xml, HasSubstr("x=\"#-Speed\""));
}

TEST(NewCase, RefusesAPartInOtherUnits)
{
    const GearboxParts parts;
    write_stl(parts.folder / "wheel.stl", gear_mesh({.teeth = 30}, {0.05, 0, 0}));
    const std::string fault = fault_of(parts.options);
    EXPECT_THAT(fault, HasSubstr("wheel.stl"));
    EXPECT_THAT(fault, HasSubstr("--unit wheel=m"));
}

TEST(NewCase, RefusesAPartFarAway)
{
    const GearboxParts parts;
    write_stl(parts.folder / "wheel.stl", gear_mesh({.teeth = 30}, {2, 0, 0}), 1000);
    const std::string fault = fault_of(parts.options);
    EXPECT_THAT(fault, HasSubstr("wheel.stl"));
    EXPECT_THAT(fault, HasSubstr("(2, 0, 0) m"));
    EXPECT_THAT(fault, HasSubstr("--allow-far"));
}

TEST(NewCase, RefusesMoreThanAnOpenHousingHolds)
{
    GearboxParts parts(0.05, true);
    parts.options.fill = "oil=3l";
    const std::string fault = fault_of(parts.options);
    EXPECT_THAT(fault, HasSubstr("housing.stl"));
    EXPECT_THAT(fault, HasSubstr("runs out over z = 0.02"));
    parts.options.fill = "oil=0.05l";
    EXPECT_EQ(fault_of(parts.options), "");
}

TEST(NewCase, RefusesGearsThatOverlap)
{
    const GearboxParts parts(0.048);
    const std::string fault = fault_of(parts.options);
    EXPECT_THAT(fault, HasSubstr("overlaps"));
    EXPECT_THAT(fault, HasSubstr("deep at (0.0"));
    NewCaseOptions allowed = parts.options;
    allowed.allows_overlap = true;
    EXPECT_EQ(fault_of(allowed), "");
}

TEST(NewCase, NamesWhatIsMissingAndWhatIsMistyped)
{
    const GearboxParts parts;
    NewCaseOptions options = parts.options;
    options.fill = "";
    EXPECT_THAT(fault_of(options), HasSubstr("--fill is missing"));
    options.fill = "oil=0.1l@housin";
    EXPECT_THAT(fault_of(options), HasSubstr("did you mean housing?"));
    options.fill = "oil=0.1l";
    options.rotations = {"pinion=fast"};
    EXPECT_THAT(fault_of(options), HasSubstr("3000deg/s"));
    options.rotations = {"housing=3000deg/s@z"};
    EXPECT_THAT(fault_of(options), HasSubstr("holds the fluid"));
}

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
        test::add_facet(nozzle, below, rim(i + 1, below), rim(i, below));
        test::add_facet(nozzle, above, rim(i, above), rim(i + 1, above));
        test::add_quad(nozzle, rim(i, below), rim(i + 1, below), rim(i + 1, above), rim(i, above));
    }
    write_stl(parts.folder / "nozzle.stl", nozzle, 1000);
    NewCaseOptions options = parts.options;
    options.inlets = {"nozzle:-z=2m/s"};
    const NewCase made = propose_case(options);
    EXPECT_THAT(made.xml, HasSubstr("<direction x=\"0\" y=\"0\" z=\"-1\" />"));
    EXPECT_THAT(made.xml, HasSubstr("<velocity v=\"2\""));
    // pi (3 mm)^2 times 2 m/s.
    EXPECT_THAT(proposal(made, "inlet nozzle:-z").reason, HasSubstr("3.38"));
    options.inlets = {"housing:x=2m/s"};
    EXPECT_THAT(fault_of(options), HasSubstr("is no disc"));
    options.inlets = {"pinion=2m/s"};
    EXPECT_THAT(fault_of(options), HasSubstr("is no flat sheet"));
}

TEST(NewCase, AsksAtATerminalForWhatIsMissing)
{
    const GearboxParts parts;
    NewCaseOptions options = parts.options;
    options.fill = "";
    std::string asked;
    options.ask = [&](const std::string& question, const std::string&)
    {
        asked = question;
        return std::string("oil=0.12l");
    };
    EXPECT_THAT(propose_case(options).xml, HasSubstr("litres=\"0.12\""));
    EXPECT_THAT(asked, HasSubstr("How much fluid is in housing"));
}

} // namespace fppg
