#include "fppg/new_case.h"

#include <cmath>
#include <filesystem>
#include <numbers>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "helpers/run_fppg.h"
#include "meshes/test_shapes.h"
#include "newcase/gearbox_parts.h"

namespace fppg
{

using test::box;
using test::fault_of;
using test::gear_mesh;
using test::GearboxParts;
using test::GearShape;
using test::proposal;
using test::TemporaryFolder;
using test::write_stl;
using ::testing::HasSubstr;

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
    EXPECT_THAT(fault, HasSubstr("at (5e-05, 0, 0) m"));
    EXPECT_THAT(fault, HasSubstr("--unit wheel=m"));
}

TEST(NewCase, DoubtsAUnitThatMakesAGearboxOfAHundredMetres)
{
    const GearboxParts parts;
    NewCaseOptions options = parts.options;
    options.kind = "gearbox";
    options.unit = "m";
    options.fill = "oil=50%@housing";
    const NewCase made = propose_case(options);
    ASSERT_FALSE(made.warnings.empty());
    EXPECT_THAT(made.warnings[0], HasSubstr("122 m long; in mm they are 0.122 m long"));
    EXPECT_THAT(made.warnings[0], HasSubstr(".stl"));
    options.unit = "mm";
    EXPECT_EQ(proposal(propose_case(options), "unit").reason, "given");
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
    EXPECT_THAT(fault, HasSubstr(" m near ("));
    EXPECT_THAT(fault, HasSubstr("Add the lid or close the opening"));
    parts.options.fill = "oil=0.05l";
    EXPECT_EQ(fault_of(parts.options), "");
}

/// The fill started inside the float, so that the definition could not be run; and a part that
/// holds fluid was looked for in gearboxes and tanks only.
TEST(NewCase, FillsAVesselWithAFloatInIt)
{
    const TemporaryFolder folder;
    write_stl(folder / "cup.stl", test::housing({-0.1, -0.1, 0}, {0.1, 0.1, 0.2}, 0.02, true));
    write_stl(folder / "ball.stl", box({-0.04, -0.04, 0.06}, {0.04, 0.04, 0.14}));
    for (const bool is_named : {false, true})
    {
        std::vector<std::string> words{"new",          "cup.stl",     "ball.stl", "-o",
                                       "Case_Def.xml", "--float",     "ball=500", "--fill",
                                       "water=60%",    "--particles", "30k",      "--no-picture"};
        if (is_named) words.insert(words.end(), {"--housing", "cup"});
        const test::RunResult made = test::run(folder, words);
        ASSERT_EQ(made.code, 0) << made.output;
        const test::RunResult run = test::run(folder, {"Case_Def", "out/Case", "-save:none"});
        EXPECT_EQ(run.code, 0) << run.output;
    }
}

TEST(NewCase, TellsOfAHoleInTheWallOfAHousing)
{
    // Without the facets of both walls at x = -0.026 and -0.03: oil runs out there, from the lowest
    // place of the hole on.
    const auto without = [](const TriangleSoup& soup, const std::vector<double>& planes)
    {
        TriangleSoup out;
        for (std::size_t f = 0; f < soup.size(); ++f)
        {
            const Vec3* c = &soup.vertices[3 * f];
            bool is_hole = false;
            for (const double x : planes)
                is_hole |= c[0].x == x && c[1].x == x && c[2].x == x &&
                           std::max({c[0].y, c[1].y, c[2].y}) > 0 && c[0].z + c[1].z + c[2].z > 0;
            if (!is_hole) out.vertices.insert(out.vertices.end(), c, c + 3);
        }
        return out;
    };
    const GearboxParts parts;
    const TriangleSoup whole = test::housing({-0.03, -0.042, -0.02}, {0.092, 0.042, 0.02}, 0.004);
    write_stl(parts.folder / "housing.stl", without(whole, {-0.03, -0.03 + 0.004}), 1000);
    NewCaseOptions options = parts.options;
    options.fill = "oil=0.25l@housing";
    const std::string fault = fault_of(options);
    EXPECT_THAT(fault, HasSubstr("housing.stl: the part is open"));
    EXPECT_THAT(fault, HasSubstr(" m near (-0.0"));
    EXPECT_THAT(fault, HasSubstr("6 open edges, the first at ("));
    EXPECT_THAT(fault, HasSubstr("close the opening"));
    // Of the inner wall alone: it still holds the oil, which is told.
    write_stl(parts.folder / "housing.stl", without(whole, {-0.03 + 0.004}), 1000);
    options.fill = "oil=0.1l@housing";
    const NewCase made = propose_case(options);
    EXPECT_THAT(made.warnings, ::testing::Contains(::testing::AllOf(
                                   HasSubstr("housing.stl: the part is no closed solid"),
                                   HasSubstr("the first at ("), HasSubstr("Close it"))));
}

TEST(NewCase, WhatTurnsIsNoHousing)
{
    const TemporaryFolder folder;
    write_stl(folder / "gear.stl", gear_mesh({.teeth = 20}), 1000);
    NewCaseOptions options;
    options.inputs = {folder / "gear.stl"};
    options.output = folder / "Case_Def.xml";
    options.rotations = {"gear=60rpm"};
    options.water = 0;
    const NewCase made = propose_case(options);
    EXPECT_THAT(proposal(made, "gear").value, HasSubstr("turns at 360 deg/s"));
    EXPECT_THAT(proposal(made, "basin").reason, HasSubstr("no part holds the water"));
}

TEST(NewCase, RefusesGearsThatOverlap)
{
    const GearboxParts parts(0.048);
    const std::string fault = fault_of(parts.options);
    EXPECT_THAT(fault, HasSubstr("pinion.stl: the part overlaps"));
    EXPECT_THAT(fault, HasSubstr("wheel.stl"));
    EXPECT_THAT(fault, HasSubstr("turn it by part of a tooth"));
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
