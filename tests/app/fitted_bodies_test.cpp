// Masses and counts of body-fitted bodies against their shapes, and the warnings about those that
// are off; FPPG_PROGRAM is the program's path.

#include "fppg/element.h"
#include "fppg/generate.h"
#include "fppg/particles.h"
#include "fppg/read_particles.h"

#include "casedef/xml_document.h"
#include "helpers/case_text.h"
#include "helpers/run_fppg.h"

#include <gtest/gtest.h>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <numeric>

namespace
{

using fppg::Element;
using fppg::ParticleCloud;
using namespace fppg::test;

constexpr double dp = 0.02;
constexpr double rhop_body = 500;

/// A floating body of mkbound 0 alone in the domain.
CaseText floating(const std::string& draw)
{
    CaseText out;
    out.dp = fmt::format("{}", dp);
    out.pointmin = R"(<pointmin x="-1" y="-1" z="-1" />)";
    out.pointmax = R"(<pointmax x="1.5" y="1.5" z="1.5" />)";
    out.mainlist = R"(<setdrawmode mode="full" /><setmkbound mk="0" />)" + draw;
    out.after_geometry = R"(<floatings><floating mkbound="0" rhopbody="500" /></floatings>)";
    return out;
}

RunResult run_case(const TemporaryFolder& folder, const CaseText& text, const Arguments& more)
{
    write_text(folder / "Case_Def.xml", text.text());
    Arguments words{"Case_Def", "Case"};
    words.insert(words.end(), more.begin(), more.end());
    return run(folder, words);
}

const Element& child(const Element& e, const std::string& name)
{
    const Element* found = e.find_child(name);
    if (found == nullptr) throw std::runtime_error("no element " + name);
    return *found;
}

double number(const Element& e, const std::string& name)
{
    return std::stod(*e.find_attribute(name));
}

Element floating_block(const TemporaryFolder& folder)
{
    const Element root = fppg::read_xml(folder / "Case.xml");
    return child(child(child(root, "execution"), "particles"), "floating");
}

double mass(const TemporaryFolder& folder)
{
    return number(child(floating_block(folder), "massbody"), "value");
}

/// Moments of inertia about the axes.
std::array<double, 3> inertia(const TemporaryFolder& folder)
{
    const Element block = floating_block(folder);
    const Element& e = child(block, "inertia");
    std::array<double, 3> out{};
    if (e.find_attribute("x") != nullptr) return {number(e, "x"), number(e, "y"), number(e, "z")};
    for (std::size_t i = 0; i < 3; ++i)
        out[i] = number(e.children.at(i), fmt::format("v{0}{0}", i + 1));
    return out;
}

std::size_t count(const TemporaryFolder& folder)
{
    return fppg::read_particles(folder / "Case", false, 1).positions.size();
}

std::string box(double x, double y, double z, const std::string& fill = "solid")
{
    return box_command(R"(x="0.013" y="0.007" z="0.003")",
                       fmt::format(R"(x="{}" y="{}" z="{}")", x, y, z), fill);
}

constexpr const char* mass_warning = "floating bodies have another mass than their shapes";

/// With the relaxation and without it.
class FloatingMass : public testing::TestWithParam<const char*>
{
protected:
    /// A wall's particles stand on its surface, so that thin rims weigh too much: inertia_within.
    void expect_box(double x, double y, double z, double inertia_within)
    {
        const RunResult result = run_case(folder_, floating(box(x, y, z)), {GetParam()});
        ASSERT_EQ(result.code, 0) << result.output;
        const double m = rhop_body * x * y * z;
        EXPECT_NEAR(mass(folder_) / m, 1, 0.005);
        const auto got = inertia(folder_);
        EXPECT_NEAR(got[0] / (m * (y * y + z * z) / 12), 1, inertia_within);
        EXPECT_NEAR(got[1] / (m * (x * x + z * z) / 12), 1, inertia_within);
        EXPECT_NEAR(got[2] / (m * (x * x + y * y) / 12), 1, inertia_within);
        EXPECT_FALSE(contains(result.output, mass_warning)) << result.output;
    }
    TemporaryFolder folder_;
};

TEST_P(FloatingMass, OfABoxIsThatOfItsVolume)
{
    expect_box(0.41, 0.33, 0.25, 0.05);
}

TEST_P(FloatingMass, OfAThinPlateToo)
{
    expect_box(0.51, 0.43, 0.031, 0.12); // 1.55 dp
    expect_box(0.51, 0.43, 0.013, 0.12); // 0.65 dp
    expect_box(0.51, 0.43, 0.006, 0.12); // 0.3 dp
}

TEST_P(FloatingMass, OfASphereIsThatOfItsVolume)
{
    const RunResult result = run_case(
        folder_,
        floating(R"(<drawsphere radius="0.21"><point x="0.1" y="0.2" z="0.3" /></drawsphere>)"),
        {GetParam()});
    ASSERT_EQ(result.code, 0) << result.output;
    const double m = rhop_body * 4 / 3 * std::numbers::pi * std::pow(0.21, 3);
    EXPECT_NEAR(mass(folder_) / m, 1, 0.005);
    for (const double i : inertia(folder_)) EXPECT_NEAR(i / (0.4 * m * 0.21 * 0.21), 1, 0.02);
    EXPECT_FALSE(contains(result.output, mass_warning)) << result.output;
}

INSTANTIATE_TEST_SUITE_P(FittedBodies, FloatingMass, testing::Values("-fit", "-fit:raw"),
                         [](const auto& mode)
                         { return std::string(mode.param) == "-fit" ? "Relaxed" : "Raw"; });

TEST(FloatingMassIn2D, IsThatOfTheSection)
{
    const TemporaryFolder folder;
    CaseText text =
        floating(box_command(R"(x="0.013" y="-0.1" z="0.003")", R"(x="0.41" y="0.2" z="0.25")"));
    text.pointmin = R"(<pointmin x="-1" y="0" z="-1" />)";
    text.pointmax = R"(<pointmax x="1" y="0" z="1" />)";
    const RunResult result = run_case(folder, text, {"-fit"});
    ASSERT_EQ(result.code, 0) << result.output;
    EXPECT_NEAR(mass(folder) / (rhop_body * 0.41 * 0.25), 1, 0.01);
    EXPECT_FALSE(contains(result.output, mass_warning)) << result.output;
}

TEST(FittedSolids, AndTheirParticlesAreInOneTable)
{
    const TemporaryFolder folder;
    CaseText text = floating(box(0.41, 0.33, 0.25));
    text.after_geometry += R"(<fppg><bodyfitted place="inside" /></fppg>)";
    const RunResult result = run_case(folder, text, {"-log-json"});
    ASSERT_EQ(result.code, 0) << result.output;
    const std::size_t at = result.output.find(R"("event":"body")");
    ASSERT_NE(at, std::string::npos) << result.output;
    const std::string line = result.output.substr(at, result.output.find('\n', at) - at);
    const auto value = [&](const std::string& of, const std::string& name)
    {
        const std::size_t from = line.find("\"" + name + "\":", line.find("\"" + of + "\":"));
        return std::stod(line.substr(from + name.size() + 3));
    };
    const double volume = 0.41 * 0.33 * 0.25;
    EXPECT_NEAR(value("shape", "volume"), volume, 1e-9);
    EXPECT_NEAR(value("shape", "mass"), rhop_body * volume, 1e-6);
    EXPECT_NEAR(value("particles", "volume"), volume, 1e-3 * volume);
    EXPECT_NEAR(static_cast<double>(count(folder)), volume / std::pow(dp, 3), 1);
}

TEST(FittedSolids, WithExactVolumesCountWhatOfThemIsInTheDomain)
{
    const TemporaryFolder folder;
    CaseText text;
    text.dp = "0.05";
    text.mainlist =
        R"(<setdrawmode mode="full" /><setmkbound mk="0" /><drawbox><boxfill>solid</boxfill>)"
        R"(<point x="1.2" y="0.1" z="0.1" /><size x="10" y="0.4" z="0.4" /></drawbox>)";
    text.after_geometry =
        R"(<fppg><bodyfitted mkbound="0" place="inside" volume="exact" /></fppg>)";
    write_text(folder / "Case_Def.xml", text.text());
    const fppg::GeneratedCase made = fppg::generate_case(folder / "Case_Def.xml", {.threads = 2});
    const std::vector<double>& volumes = made.particles().volumes;
    ASSERT_FALSE(volumes.empty());
    // The last nodes stand at 1.45, half a dp before the end of the domain.
    const double expected = (1.475 - 1.2) * 0.4 * 0.4;
    EXPECT_NEAR(std::accumulate(volumes.begin(), volumes.end(), 0.0), expected, 0.03 * expected);
}

TEST(FittedSolids, ThatHaveNoRoomAreToldWithADpThatWouldDo)
{
    const TemporaryFolder folder;
    const auto plate = []
    {
        CaseText text = floating(box(0.41, 0.33, 0.021));
        text.after_geometry += R"(<fppg><bodyfitted place="surface" /></fppg>)";
        return text;
    };
    const RunResult result = run_case(folder, plate(), {});
    ASSERT_EQ(result.code, 0) << result.output;
    const std::string words = "for which a dp of ";
    const std::size_t at = result.output.find(words);
    ASSERT_NE(at, std::string::npos) << result.output;
    CaseText finer = plate();
    finer.dp = fmt::format("{}", std::stod(result.output.substr(at + words.size())));
    const RunResult again = run_case(folder, finer, {});
    EXPECT_EQ(again.code, 0);
    EXPECT_FALSE(contains(again.output, words)) << again.output;
}

TEST(FloatingMass, ThatIsGivenStays)
{
    const TemporaryFolder folder;
    CaseText text = floating(box(0.41, 0.33, 0.25));
    text.after_geometry =
        R"(<floatings><floating mkbound="0"><massbody value="3.5" /></floating></floatings>)";
    const RunResult result = run_case(folder, text, {"-fit"});
    ASSERT_EQ(result.code, 0) << result.output;
    EXPECT_EQ(mass(folder), 3.5);
}

TEST(FloatingMass, OfAHollowBodyIsToldWithMkAndBothMasses)
{
    const TemporaryFolder folder;
    CaseText text = floating(box(0.41, 0.33, 0.25));
    text.mainlist.replace(text.mainlist.find("full"), 4, "face");
    const RunResult result = run_case(folder, text, {"-fit"});
    ASSERT_EQ(result.code, 0) << result.output;
    EXPECT_TRUE(contains(result.output, std::string("*** WARNING: Case_Def.xml: ") + mass_warning +
                                            ", as no draw fills them, mkbound 0: -"))
        << result.output;
    EXPECT_TRUE(contains(result.output, "has 0.03383 m^3 and 16.91 kg")) << result.output;
    // A shell of one particle a dp^2 weighs about dp of its surface.
    const double shell = 2 * (0.41 * 0.33 + 0.33 * 0.25 + 0.25 * 0.41) * dp * rhop_body;
    EXPECT_NEAR(mass(folder) / shell, 1, 0.1);
}

TEST(FloatingMass, OfABodyThatALaterDrawCutsIsTold)
{
    const TemporaryFolder folder;
    CaseText text = floating(box(0.41, 0.33, 0.25));
    text.mainlist +=
        R"(<setmkvoid /><clipplane><point x="5" y="0" z="0" /><vector x="1" y="0" z="0" /></clipplane>)" +
        box_command(R"(x="-0.1" y="-0.1" z="-0.1")", R"(x="0.3" y="0.6" z="0.6")");
    const RunResult result = run_case(folder, text, {"-fit"});
    ASSERT_EQ(result.code, 0) << result.output;
    EXPECT_TRUE(contains(result.output, "cut them, mkbound 0: -")) << result.output;
    EXPECT_LT(mass(folder), 0.6 * rhop_body * 0.41 * 0.33 * 0.25);
}

TEST(FloatingMass, OfABodyThatAVoidHollowsIsThatOfWhatIsLeft)
{
    const TemporaryFolder folder;
    CaseText text = floating(box(0.41, 0.33, 0.25));
    text.mainlist += "<setmkvoid />" +
                     box_command(R"(x="-0.1" y="-0.1" z="-0.1")", R"(x="0.3" y="0.6" z="0.6")");
    const RunResult result = run_case(folder, text, {"-fit"});
    ASSERT_EQ(result.code, 0) << result.output;
    EXPECT_FALSE(contains(result.output, mass_warning)) << result.output;
    EXPECT_NEAR(mass(folder) / (rhop_body * 0.223 * 0.33 * 0.25), 1, 0.02);
}

/// Two boxes that overlap, a void in the first that the second reaches into again, and fluid around
/// them. Each by itself, they lacked 5 % of their particles where they meet.
TEST(FloatingMass, OfOverlappingSolidsIsThatOfTheirUnion)
{
    const TemporaryFolder folder;
    CaseText text = floating(box_command(R"(x="0" y="0" z="0")", R"(x="0.3" y="0.3" z="0.1")"));
    text.mainlist += "<setmkvoid />" +
                     box_command(R"(x="0.05" y="0.05" z="0.06")", R"(x="0.2" y="0.2" z="0.1")") +
                     R"(<setmkbound mk="0" />)" +
                     box_command(R"(x="0.1" y="0.1" z="0.02")", R"(x="0.08" y="0.08" z="0.3")");
    const double volume = 0.3 * 0.3 * 0.1 - 0.2 * 0.2 * 0.04 + 0.08 * 0.08 * (0.04 + 0.22);
    const RunResult result = run_case(folder, text, {"-fit"});
    ASSERT_EQ(result.code, 0) << result.output;
    EXPECT_NEAR(static_cast<double>(count(folder)) * dp * dp * dp / volume, 1, 0.001);
    EXPECT_NEAR(mass(folder) / (rhop_body * volume), 1, 0.001);
    EXPECT_TRUE(contains(result.output, fmt::format("volume {:.5g} m^3", volume))) << result.output;
}

/// The third solid bridges the other two: the three are one.
TEST(FloatingMass, OfBridgedSolidsIsThatOfTheirUnion)
{
    const TemporaryFolder folder;
    const RunResult result = run_case(
        folder,
        floating(box_command(R"(x="0" y="0" z="0")", R"(x="0.1" y="0.2" z="0.1")") +
                 box_command(R"(x="0.3" y="0" z="0")", R"(x="0.1" y="0.2" z="0.1")") +
                 box_command(R"(x="0.05" y="0.05" z="0.02")", R"(x="0.3" y="0.1" z="0.06")")),
        {"-fit"});
    ASSERT_EQ(result.code, 0) << result.output;
    const double volume = 2 * 0.1 * 0.2 * 0.1 + 0.2 * 0.1 * 0.06;
    EXPECT_NEAR(mass(folder) / (rhop_body * volume), 1, 0.001);
    EXPECT_TRUE(contains(result.output, fmt::format("volume {:.5g} m^3", volume))) << result.output;
}

/// The mass of its first part was taken for that of a combination.
TEST(FloatingMass, OfACombinationIsExactToo)
{
    const TemporaryFolder folder;
    CaseText text =
        floating(box_command(R"(x="0" y="0" z="0")", R"(x="0.3" y="0.3" z="0.1")") +
                 R"(<setmkbound mk="1" />)" +
                 box_command(R"(x="0.1" y="0.1" z="-0.1")", R"(x="0.1" y="0.1" z="0.3")"));
    text.after_geometry +=
        R"(<fppg><bodyfitted place="surface" /><floatings exact="true" /><boolean op="difference" mkbound="0"><part mkbound="0" /><part mkbound="1" /></boolean></fppg>)";
    const RunResult result = run_case(folder, text, {});
    ASSERT_EQ(result.code, 0) << result.output;
    EXPECT_NEAR(mass(folder) / (rhop_body * 0.008), 1, 1e-6);
}

/// The inside of an open mesh is a guess: on the lattice it cuts nodes, as before.
TEST(FloatingMass, OfABodyThatAnOpenMeshIsDrawnIntoIsNoError)
{
    const TemporaryFolder folder;
    write_text(folder / "open.stl",
               "solid s\nfacet normal 0 0 1\nouter loop\nvertex 0.1 0.1 0.1\nvertex 0.3 0.1 0.1\n"
               "vertex 0.3 0.3 0.1\nendloop\nendfacet\nfacet normal 0 1 0\nouter loop\n"
               "vertex 0.1 0.1 0.1\nvertex 0.1 0.1 0.2\nvertex 0.3 0.1 0.1\nendloop\nendfacet\n"
               "endsolid s\n");
    CaseText text = floating(box(0.41, 0.33, 0.25));
    text.mainlist += R"(<setmkvoid /><drawfilestl file="open.stl" autofill="true" />)";
    const RunResult result = run_case(folder, text, {"-fit"});
    ASSERT_EQ(result.code, 0) << result.output;
    EXPECT_TRUE(contains(result.output, "open edges")) << result.output;
}

TEST(FloatingMass, OfBodiesThatTouchIsThatOfEach)
{
    const TemporaryFolder folder;
    CaseText text = floating(box(0.41, 0.33, 0.25));
    text.mainlist += R"(<setmkbound mk="1" />)" + box_command(R"(x="0.013" y="0.057" z="0.253")",
                                                              R"(x="0.41" y="0.2" z="0.25")");
    text.after_geometry = R"(<floatings><floating mkbound="0-1" rhopbody="500" /></floatings>)";
    const RunResult result = run_case(folder, text, {"-fit"});
    ASSERT_EQ(result.code, 0) << result.output;
    EXPECT_NEAR(mass(folder) / (rhop_body * 0.41 * 0.33 * 0.25), 1, 0.02);
    EXPECT_FALSE(contains(result.output, mass_warning)) << result.output;
}

// -- plates
// ------------------------------------------------------------------------------------------

TEST(FittedPlate, ThinnerThanADistanceOfParticlesHasOneSheetByDefault)
{
    const double area = 0.51 * 0.43;
    const auto particles_a_dp2 = [&](double thickness, const std::string& plates)
    {
        const TemporaryFolder folder;
        CaseText text = floating(box(0.51, 0.43, thickness));
        if (!plates.empty())
            text.after_geometry +=
                "<fppg><bodyfitted mkbound=\"0\" plates=\"" + plates + "\" /></fppg>";
        const RunResult result = run_case(folder, text, {"-fit"});
        EXPECT_EQ(result.code, 0) << result.output;
        return static_cast<double>(count(folder)) * dp * dp / area;
    };
    EXPECT_NEAR(particles_a_dp2(0.008, ""), 1, 0.12);
    EXPECT_NEAR(particles_a_dp2(0.008, "auto"), 1, 0.12);
    EXPECT_NEAR(particles_a_dp2(0.008, "both"), 2, 0.3);
    EXPECT_NEAR(particles_a_dp2(0.011, ""), 1, 0.12);
    EXPECT_NEAR(particles_a_dp2(0.012, ""), 2, 0.3);
    EXPECT_NEAR(particles_a_dp2(0.012, "one"), 1, 0.12);
}

/// A blade along y whose two sides meet at 8 degrees, as text of an STL file.
///
/// is_inwards  its facets face inwards
std::string blade(bool is_inwards = false)
{
    const std::array<std::array<double, 2>, 3> profile{{{0, 0.1}, {0.4, 0.072}, {0.4, 0.128}}};
    std::string text = "solid blade\n";
    const auto add = [&](const std::array<std::array<double, 3>, 3>& corners)
    {
        text += "facet normal 0 0 0\nouter loop\n";
        for (std::size_t n = 0; n < 3; ++n)
        {
            const auto& c = corners[is_inwards ? 2 - n : n];
            text += fmt::format("vertex {} {} {}\n", c[0], c[1], c[2]);
        }
        text += "endloop\nendfacet\n";
    };
    const auto at = [&](std::size_t i, double y) {
        return std::array<double, 3>{profile[i % 3][0], y, profile[i % 3][1]};
    };
    for (std::size_t i = 0; i < 3; ++i)
    {
        add({at(i, 0), at(i + 1, 0.4), at(i + 1, 0)});
        add({at(i, 0), at(i, 0.4), at(i + 1, 0.4)});
    }
    add({at(0, 0), at(1, 0), at(2, 0)});
    add({at(0, 0.4), at(2, 0.4), at(1, 0.4)});
    return text + "endsolid blade\n";
}

TEST(FittedPlate, KeepsParticlesApartWhereTheSidesOfABladeMeet)
{
    const TemporaryFolder folder;
    write_text(folder / "blade.stl", blade());
    const RunResult result =
        run_case(folder, floating(R"(<drawfilestl file="blade.stl" autofill="true" />)"), {"-fit"});
    ASSERT_EQ(result.code, 0) << result.output;
    const ParticleCloud cloud = fppg::read_particles(folder / "Case", false, 1);
    ASSERT_GT(cloud.positions.size(), 500u);
    double nearest = 1;
    for (std::size_t i = 0; i < cloud.positions.size(); ++i)
        for (std::size_t k = 0; k < i; ++k)
            nearest = std::min(nearest, norm(cloud.positions[i] - cloud.positions[k]));
    EXPECT_GT(nearest / dp, 0.599);
}

TEST(FillInside, FillsABodyAndItsReversedCopyAsOneSolidAndSaysSo)
{
    const std::string draw = R"(<drawfilestl file="blade.stl" fppg:fill="inside" />)";
    std::array<std::size_t, 2> particles{};
    for (const bool has_copy : {false, true})
    {
        const TemporaryFolder folder;
        write_text(folder / "blade.stl", has_copy ? blade() + blade(true) : blade());
        const RunResult result = run_case(folder, floating(draw), {});
        ASSERT_EQ(result.code, 0) << result.output;
        particles[has_copy ? 1 : 0] = count(folder);
        EXPECT_EQ(contains(result.output, "the inside on both"), has_copy) << result.output;
    }
    EXPECT_EQ(particles[0], particles[1]);
    EXPECT_GT(particles[0], 0u);
}

// -- warnings about counts and volumes
// ------------------------------------------------------------------------------------------

TEST(FitCheck, TellsAGivenClearanceWithMkLineAndVolumes)
{
    const TemporaryFolder folder;
    CaseText text = floating(box(0.21, 0.17, 0.19));
    text.after_geometry +=
        R"(<fppg><bodyfitted mkbound="0" clearance="1"><relax active="false" /></bodyfitted></fppg>)";
    const RunResult result = run_case(folder, text, {});
    ASSERT_EQ(result.code, 0) << result.output;
    EXPECT_TRUE(contains(result.output,
                         "*** WARNING: Case_Def.xml: fitted particles do not have the volume of "
                         "their solids, as clearance=\"1\" is given: mk 10: "))
        << result.output;
    EXPECT_TRUE(contains(result.output, "; its <drawbox> of line 7 has ")) << result.output;
    EXPECT_TRUE(contains(result.output, " of 0.006783 m^3.")) << result.output;
}

TEST(FitCheck, SaysInOneSentenceWhichBodiesAreOffAlike)
{
    const TemporaryFolder folder;
    CaseText text;
    text.dp = "0.1";
    text.mainlist = R"(<setdrawmode mode="full" />)";
    for (int mk = 0; mk < 3; ++mk)
        text.mainlist += fmt::format(R"(<setmkbound mk="{}" />)", mk) +
                         box_command(fmt::format(R"(x="{}" y="0" z="0")", 0.5 * mk - 0.3),
                                     fmt::format(R"(x="{}" y="0.13" z="0.17")", 0.11 + 0.1 * mk));
    const RunResult result = run_case(folder, text, {"-fit"});
    ASSERT_EQ(result.code, 0) << result.output;
    const std::string said =
        "particles on fitted surfaces are more or fewer than one per dp^2, as "
        "they are small against dp: mk 10-12: +";
    const std::size_t first = result.output.find("*** WARNING: Case_Def.xml: " + said);
    ASSERT_NE(first, std::string::npos) << result.output;
    EXPECT_EQ(result.output.find("*** WARNING: Case_Def.xml: " + said, first + 1),
              std::string::npos);
    EXPECT_TRUE(contains(result.output, "the most at mk ")) << result.output;
}

TEST(FitCheck, IsContentWithABoxOfManyParticles)
{
    for (const char* fit : {"-fit", "-fit:raw"})
    {
        const TemporaryFolder folder;
        const RunResult result = run_case(folder, floating(box(1.01, 0.83, 0.75)), {fit});
        ASSERT_EQ(result.code, 0) << result.output;
        EXPECT_FALSE(contains(result.output, "particles on fitted surfaces")) << result.output;
        EXPECT_FALSE(contains(result.output, "fitted particles do not")) << result.output;
        EXPECT_FALSE(contains(result.output, mass_warning)) << result.output;
    }
}

/// Closing holes leaves 2 to 5 % too many on it.
TEST(FitCheck, IsContentWithAFewParticlesTooManyOnABall)
{
    const TemporaryFolder folder;
    CaseText text;
    text.dp = "0.05";
    text.mainlist = R"(<setdrawmode mode="face" /><setmkbound mk="0" />)"
                    R"(<drawsphere radius="0.45"><point x="0.51" y="0.48" z="0.5" /></drawsphere>)";
    const RunResult result = run_case(folder, text, {"-fit"});
    ASSERT_EQ(result.code, 0) << result.output;
    const std::size_t at = result.output.find("% of one per dp^2");
    ASSERT_NE(at, std::string::npos) << result.output;
    const std::size_t sign = result.output.rfind('+', at);
    ASSERT_LT(at - sign, 10U) << "it has too few";
    EXPECT_GT(std::stod(result.output.substr(sign)), 2);
    EXPECT_FALSE(contains(result.output, "particles on fitted surfaces")) << result.output;
}

/// The public Dynamic_Crack_Branching: a plate one dp thick that a block drawn later takes half of.
TEST(FitCheck, NamesABodyThatGaveWayToAnother)
{
    const TemporaryFolder folder;
    CaseText text = floating("");
    text.after_geometry = {};
    text.mainlist = R"(<setdrawmode mode="full" /><setmkbound mk="0" />)" +
                    box_command(R"(x="0" y="0" z="0.006")", R"(x="0.4" y="0.4" z="0.02")") +
                    R"(<setmkbound mk="1" />)" +
                    box_command(R"(x="0" y="0" z="-0.294")", R"(x="0.4" y="0.4" z="0.3098")");
    const RunResult result = run_case(folder, text, {"-fit"});
    ASSERT_EQ(result.code, 0) << result.output;
    EXPECT_TRUE(contains(result.output,
                         "no particle is left on the surface of <drawbox> of line 7 "
                         "(mk 10): what other draws do not cover is nearer than 0.6 "
                         "dp to their particles"))
        << result.output;
    EXPECT_FALSE(contains(result.output, "(mk 11)")) << result.output;
}

TEST(FitCheck, WritesTheFiguresOfEveryBodyToTheLog)
{
    const TemporaryFolder folder;
    const RunResult result = run_case(folder, floating(box(0.41, 0.33, 0.25)), {"-fit"});
    ASSERT_EQ(result.code, 0) << result.output;
    EXPECT_TRUE(contains(result.output, "Fitted bodies against their shapes:")) << result.output;
    EXPECT_TRUE(contains(result.output, "  drawbox (xml row:7, mk:10): ")) << result.output;
    EXPECT_TRUE(contains(result.output, " of 0.03383 m^3 (")) << result.output;
}

} // namespace
