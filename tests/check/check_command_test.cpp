// The cases of these tests are made by the program itself, FPPG_PROGRAM; FPPG_RECORDED_FIELDS holds
// definitions whose particles and normals were compared with GenCase's.

#include "core/json.h"
#include "files/particle_source.h"
#include "fppg/check.h"
#include "helpers/run_fppg.h"

#include <gtest/gtest.h>

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <set>

namespace
{

using namespace fppg;
using namespace fppg::test;

/// A tank whose floor and sides are three layers on the lattice, half a dp behind the surface, with
/// the normals of <norgeometry>, and water in it.
CaseText layered_tank()
{
    const std::string sides =
        R"(<boxfill>bottom|left|right|front|back</boxfill><point x="0" y="0" z="0"/><size x="1" y="0.6" z="0.6"/>)";
    CaseText out;
    out.dp = "0.05";
    out.pointmin =
        R"(<pointref x="0.025" y="0.025" z="0.025" /><pointmin x="-0.5" y="-0.5" z="-0.5" />)";
    out.mainlist =
        R"(<setshapemode>actual | bound</setshapemode><setmkbound mk="0"/><setdrawmode mode="face"/><setnormalinvert invert="true"/><setactive drawpoints="false" drawshapes="true" /><drawbox>)" +
        sides +
        R"(</drawbox><shapeout file="hdp"/><setactive drawpoints="true" drawshapes="false" /><drawbox>)" +
        sides +
        R"(<layers vdp="0.5,1.5,2.5"/></drawbox><setdrawmode mode="full"/><setmkfluid mk="0"/>)" +
        box_command(R"(x="0.025" y="0.025" z="0.025")", R"(x="0.95" y="0.55" z="0.35")");
    out.after_geometry =
        R"(<normals><norgeometry><geometryfile file="[CaseName]_hdp_Actual.vtk" /><distanceh v="2" /></norgeometry></normals>)";
    out.execution =
        R"(<parameters><parameter key="Boundary" value="2" /><parameter key="SlipMode" value="2" /><parameter key="NoPenetration" value="1" /></parameters>)";
    return out;
}

class CheckCommand : public testing::Test
{
protected:
    TemporaryFolder folder_;

    void generate(const CaseText& text)
    {
        write_text(folder_ / "Case_Def.xml", text.text());
        const RunResult made = run(folder_, {"Case_Def", "Case"});
        ASSERT_EQ(made.code, 0) << made.output;
    }
};

void replace(std::string& text, const std::string& what, const std::string& by)
{
    const std::size_t at = text.find(what);
    ASSERT_NE(at, std::string::npos) << what;
    text.replace(at, what.size(), by);
}

} // namespace

TEST_F(CheckCommand, FindsNothingInALatticeTankOfLayers)
{
    generate(layered_tank());
    const RunResult result = run(folder_, {"check", "Case", "--strict"});
    EXPECT_EQ(result.code, 0) << result.output;
    EXPECT_TRUE(contains(result.output, "mDBC, SlipMode 2, NoPenetration")) << result.output;
    EXPECT_TRUE(contains(result.output, "Nothing was found.")) << result.output;
    EXPECT_TRUE(contains(result.output, "100 %")) << result.output;
}

/// Behind a floor in layers the sides of a sheet that stands through it are out of the fluid's
/// reach: particles of its layers there look to the part above the floor.
TEST_F(CheckCommand, FindsNoGhostInAFloorInLayersThatASheetStandsThrough)
{
    CaseText text = layered_tank();
    text.mainlist =
        R"(<setdrawmode mode="face"/><setmkbound mk="0"/><drawbox><boxfill>bottom|left|right|front|back</boxfill><point x="0" y="0" z="0"/><size x="1" y="0.8" z="0.6"/></drawbox><setmkbound mk="1"/><drawbox><boxfill>all^bottom</boxfill><point x="0.4" y="0.3" z="-0.1"/><size x="0.2" y="0.2" z="0.27"/></drawbox><setmkfluid mk="0"/><fillbox x="0.2" y="0.2" z="0.2"><modefill>void</modefill><point x="0" y="0" z="0"/><size x="1" y="0.8" z="0.4"/></fillbox>)";
    text.after_geometry =
        R"(<fppg><bodyfitted mkbound="0" side="front"/><bodyfitted mkbound="1" side="behind"/></fppg>)";
    generate(text);
    const RunResult checked = run(folder_, {"check", "Case", "--json", "c.json"});
    EXPECT_EQ(checked.code, 0) << checked.output;
    const Json json = Json::parse(read_text(folder_ / "c.json"));
    for (const Json& mk : json.at("mks").items())
        for (const char* fault : {"no_normal", "ghost_in_wall", "through_wall", "looks_away"})
            EXPECT_EQ(mk.at("faults").at(fault).get<int>(), 0) << fault;
}

TEST_F(CheckCommand, MakesFindingsErrorsWhereItIsAskedTo)
{
    CaseText text = layered_tank();
    replace(
        text.execution, "</parameters>",
        R"(<simulationdomain><posmin x="0" y="default" z="default" /></simulationdomain></parameters>)");
    generate(text);
    const RunResult plain = run(folder_, {"check", "Case", "--json", "c.json", "--vtk", "c.vtk"});
    EXPECT_EQ(plain.code, 0) << plain.output;
    EXPECT_TRUE(contains(plain.output, "particles lie outside the domain")) << plain.output;
    for (const char* option : {"--strict", "-strict"})
        EXPECT_EQ(run(folder_, {"check", "Case", option}).code, 3);

    const Json json = Json::parse(read_text(folder_ / "c.json"));
    EXPECT_FALSE(json.at("is_clean").get<bool>());
    std::uint64_t outside = 0;
    for (const Json& mk : json.at("mks").items())
        outside += mk.at("faults").at("outside_domain").get<std::uint64_t>();
    // Three layers of 18 x 16 particles at x < 0.
    EXPECT_EQ(outside, 3U * 18 * 16);
    const std::string vtk = read_text(folder_ / "c.vtk");
    EXPECT_TRUE(contains(vtk, "SCALARS Fault int"));
    const std::size_t faulty = check_case(folder_ / "Case", 1).faulty.size();
    EXPECT_TRUE(contains(vtk, "POINTS " + std::to_string(faulty) + " float")) << faulty;
}

TEST_F(CheckCommand, KnowsTheDomainOfTheSolver)
{
    CaseText text = layered_tank();
    replace(
        text.execution, "</parameters>",
        R"(<simulationdomain><posmin x="default" y="default - 10%" z="-0.06" /><posmax x="1" y="default" z="default + 1" /></simulationdomain></parameters>)");
    generate(text);
    const CheckReport report = check_case(folder_ / "Case", 1);
    const CheckSetup& setup = report.setup;
    const double border = 0.05 * setup.h;
    EXPECT_NEAR(setup.domain.min.x, -0.125 - border, 1e-9);
    EXPECT_NEAR(setup.domain.min.y, -0.125 - border - 0.1 * (0.85 + 2 * border), 1e-6);
    EXPECT_NEAR(setup.domain.min.z, -0.06, 1e-12);
    EXPECT_NEAR(setup.domain.max.x, 1, 1e-12);
    EXPECT_NEAR(setup.domain.max.z, 0.6 + 0.025 + border + 1, 0.06);
    // Layers two and three of the floor, and all three at x = 1.
    EXPECT_GT(report.total(Fault::OutsideDomain), 1000U);
    EXPECT_FALSE(report.is_clean());
}

TEST_F(CheckCommand, RefusesWhatIsNoCase)
{
    EXPECT_EQ(run(folder_, {"check", "nothing"}).code, 4);
    EXPECT_EQ(run(folder_, {"check"}).code, 2);
    generate(layered_tank());
    std::string xml = read_text(folder_ / "Case.xml");
    replace(xml, "<h value", "<hh value");
    write_text(folder_ / "Case.xml", xml);
    const RunResult result = run(folder_, {"check", "Case"});
    EXPECT_EQ(result.code, 3);
    EXPECT_TRUE(contains(result.output, "<constants><h>")) << result.output;
}

TEST_F(CheckCommand, IsASectionOfTheReport)
{
    generate(layered_tank());
    const RunResult result = run(folder_, {"report", "Case", "-o", "page.html"});
    ASSERT_EQ(result.code, 0) << result.output;
    const std::string page = read_text(folder_ / "page.html");
    EXPECT_TRUE(contains(page, "Check"));
    EXPECT_TRUE(contains(page, "Nothing was found."));
}

TEST_F(CheckCommand, FindsTheParticlesOfALatticeSphereThatStandBeforeItsSurface)
{
    const std::string name = "nor_sphere";
    std::filesystem::copy(FPPG_RECORDED_FIELDS "/" + name, folder_.path(),
                          std::filesystem::copy_options::recursive);
    ASSERT_EQ(run(folder_, {name + "_Def", name}).code, 0);
    const CheckReport report = check_case(folder_ / name, 2);
    ASSERT_TRUE(report.judges_normals);
    // Nodes beside the sphere (radius 0.31) that GenCase rounds to it: their normals lead into it.
    std::set<std::uint32_t> faulty;
    for (const FaultyParticle& p : report.faulty) faulty.insert(p.id);
    const ParticleSource source(folder_ / name);
    std::size_t turned = 0, found = 0;
    for (std::size_t i = 0; i < source.size(); ++i)
    {
        const auto n = source.normal(i);
        const Vec3 normal{n[0], n[1], n[2]};
        if (dot(source.position(i) - Vec3{0.5, 0.51, 0.52}, normal) >= 0 || norm(normal) < 0.0125)
            continue;
        ++turned;
        found += faulty.contains(source.id(i)) ? 1 : 0;
    }
    EXPECT_GT(turned, 50U);
    // Not all: where the surface is a third of a dp away, the ghost node is hardly in the wall.
    EXPECT_GT(10 * found, 8 * turned) << found << " of " << turned;
    // The others are those whose ghost nodes these stand in the way of.
    EXPECT_LT(faulty.size(), 4 * turned);
}

TEST_F(CheckCommand, TakesAPeriodicChannelAsEndless)
{
    CaseText text = layered_tank();
    for (int k = 0; k < 2; ++k)
        replace(text.mainlist, "bottom|left|right|front|back", "bottom|front|back");
    replace(text.execution, "</parameters>",
            R"(<parameter key="XPeriodicIncZ" value="0" /></parameters>)");
    generate(text);
    const CheckReport report = check_case(folder_ / "Case", 2);
    EXPECT_TRUE(report.setup.is_periodic[0]);
    EXPECT_NEAR(norm(report.setup.periodic[0] - Vec3{1, 0, 0}), 0, 1e-9);
    EXPECT_TRUE(report.is_clean()) << to_text(report);
    EXPECT_EQ(report.total(Fault::IllConditioned), 0U);
}

TEST_F(CheckCommand, GoesOnWithTheReportOfACaseThatItCannotJudge)
{
    generate(layered_tank());
    std::string xml = read_text(folder_ / "Case.xml");
    replace(xml, "<massfluid value", "<massfluids value");
    write_text(folder_ / "Case.xml", xml);
    ASSERT_EQ(run(folder_, {"report", "Case", "-o", "page.html"}).code, 0);
    EXPECT_TRUE(contains(read_text(folder_ / "page.html"), "Not checked: "));
}

TEST_F(CheckCommand, SaysWhatStopsTheSolverInBufferZones)
{
    std::filesystem::copy(FPPG_TEMPLATES "/VRes_Def.xml", folder_.path());
    ASSERT_EQ(run(folder_, {"VRes_Def", "VRes"}).code, 0);
    for (const char* zone : {"VRes_vres00", "VRes_vres01", "VRes_vres02"})
    {
        const CheckReport report = check_case(folder_ / zone, 1);
        EXPECT_FALSE(report.setup.buffers.empty()) << zone;
        EXPECT_EQ(report.total(Fault::InBufferZone), 0U) << to_text(report);
    }
}

/// A plate that turns about z above the water, one dp below another one.
CaseText turning_plate(double degrees_per_second)
{
    CaseText out = tank();
    out.dp = "0.05";
    out.mainlist += R"(<setdrawmode mode="full" /><setmkbound mk="1" />)" +
                    box_command(R"(x="0.4" y="0.3" z="0.7")", R"(x="0.2" y="0.4" z="0.05")") +
                    R"(<setmkbound mk="2" />)" +
                    box_command(R"(x="0.4" y="0.3" z="0.8")", R"(x="0.2" y="0.4" z="0.05")");
    out.after_geometry = fmt::format(
        R"(<motion><objreal ref="1"><begin mov="1" start="0.5" /><mvrot id="1" duration="0.1" anglesunits="degrees"><vel ang="{}" />)"
        R"(<axisp1 x="0.5" y="0.5" z="0" /><axisp2 x="0.5" y="0.5" z="1" /></mvrot></objreal></motion>)",
        degrees_per_second);
    return out;
}

bool has_note(const CheckReport& report, const std::string& words)
{
    return std::any_of(report.setup.notes.begin(), report.setup.notes.end(),
                       [&](const std::string& note) { return contains(note, words); });
}

/// The corners of the plate are 0.2236 m from its axis; the speed of sound is 48.5 m/s.
TEST_F(CheckCommand, SaysWhereMovingPartsAreTooFastOrTooNear)
{
    generate(turning_plate(7200));
    const CheckReport fast = check_case(folder_ / "Case", 2);
    EXPECT_TRUE(has_note(fast, "mk 11: its fastest particle has 28.1 m/s at 0.501 s"))
        << to_text(fast);
    EXPECT_TRUE(has_note(fast, "Expected a speed of sound of 281 m/s")) << to_text(fast);
    EXPECT_TRUE(has_note(fast, "mk 11 and mk 12 move against each other 1 dp apart"))
        << to_text(fast);
    EXPECT_FALSE(has_note(fast, "mk 11 and mk 10")) << to_text(fast);
    generate(turning_plate(720));
    EXPECT_FALSE(has_note(check_case(folder_ / "Case", 2), "fastest"));
}

/// Its particles are a dp farther from the floor than the gate is.
TEST_F(CheckCommand, SaysWhereAGateInLayersLeavesAGap)
{
    const auto gate = [](const std::string& bottom)
    {
        CaseText out;
        out.dp = "0.02";
        out.pointmin = R"(<pointmin x="-0.2" y="0" z="-0.2" />)";
        out.pointmax = R"(<pointmax x="1.2" y="0" z="0.8" />)";
        out.mainlist =
            R"(<setdrawmode mode="full" /><setmkbound mk="0" />)" +
            box_command(R"(x="-0.1" y="-1" z="-0.1")", R"(x="1.2" y="2" z="0.1")") +
            R"(<setmkbound mk="1" />)" +
            box_command(R"(x="0.5" y="-1" z=")" + bottom + "\"", R"(x="0.08" y="2" z="0.5")") +
            R"(<setmkfluid mk="0" />)" +
            box_command(R"(x="0" y="-1" z="0")", R"(x="0.48" y="2" z="0.3")");
        out.after_geometry =
            R"(<motion><objreal ref="1"><begin mov="1" start="0.3" /><mvrect id="1" duration="2"><vel x="0" y="0" z="0.1" /></mvrect></objreal></motion><fppg><bodyfitted /></fppg>)";
        out.execution =
            R"(<parameters><parameter key="Boundary" value="2" /><parameter key="SlipMode" value="2" /><parameter key="NoPenetration" value="1" /><parameter key="TimeMax" value="0.5" /></parameters>)";
        return out;
    };
    const std::string of_run = "mkbound 1 moves 1.5 dp from mkbound 0";
    write_text(folder_ / "Case_Def.xml", gate("0.03").text());
    const RunResult made = run(folder_, {"Case_Def", "Case"});
    EXPECT_TRUE(contains(made.output, of_run)) << made.output;
    const CheckReport open = check_case(folder_ / "Case", 2);
    EXPECT_TRUE(has_note(open, "mk 11 and mk 10 move against each other 1.5 dp apart"))
        << to_text(open);
    EXPECT_TRUE(has_note(open, "fluid goes through such a gap")) << to_text(open);
    // A row of particles closes the gap of 1 dp.
    for (const std::string bottom : {"0", "0.02", "0.06"})
    {
        generate(gate(bottom));
        EXPECT_FALSE(contains(run(folder_, {"Case_Def", "Case"}).output, "mkbound 1 moves"));
        const CheckReport none = check_case(folder_ / "Case", 2);
        EXPECT_FALSE(has_note(none, "move against each other")) << to_text(none);
    }
}

TEST_F(CheckCommand, SaysThatTheLeastStepIsTooLong)
{
    const auto warns = [&](const std::string& step)
    {
        CaseText text = layered_tank();
        replace(text.execution, "</parameters>",
                R"(<parameter key="DtMin" value=")" + step + R"(" /></parameters>)");
        generate(text);
        return has_note(check_case(folder_ / "Case", 1), "DtMin is ");
    };
    EXPECT_TRUE(warns("0.001")); // CFL h / speedsound is 0.2 * 0.087 m / 37 m/s
    EXPECT_FALSE(warns("0.0001"));
}
