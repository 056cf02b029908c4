// Bodies with place="inside" in whole cases: flexible ones and their clamps, initials, cuts and
// Booleans; FPPG_PROGRAM is the program's path.

#include "fppg/element.h"
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
#include <string>
#include <utility>
#include <vector>

namespace
{

using fppg::ParticleCloud;
using fppg::Vec3;
using namespace fppg::test;

constexpr double dp = 0.02;
constexpr const char* inside = R"(<fppg><bodyfitted place="inside" /></fppg>)";

std::string box(const std::string& low, const std::string& size)
{
    return box_command(low, size, "solid");
}

/// A clamp, mkbound 0, and a plate of 3 dp beside it, mkbound 1.
CaseText flexible(const std::string& motion)
{
    CaseText out;
    out.dp = fmt::format("{}", dp);
    out.mainlist = R"(<setdrawmode mode="full" /><setmkbound mk="0" />)" +
                   box(R"(x="-0.1" y="0.003" z="0.007")", R"(x="0.1" y="0.2" z="0.06")") +
                   R"(<setmkbound mk="1" />)" +
                   box(R"(x="0" y="0.003" z="0.007")", R"(x="0.4" y="0.2" z="0.06")");
    out.after_geometry =
        "<motion>" + motion +
        R"(<objreal ref="1"><begin mov="1" start="0" /><mvnull id="1" /></objreal></motion>)" +
        inside;
    out.execution =
        R"(<special><flexstrucs><flexstrucbody mkbound="1" mkclamp="0"><density value="1000" />
<youngmod value="1e6" /><poissratio value="0.3" /><constitmodel value="3" /><hgfactor value="0.1" /></flexstrucbody>
</flexstrucs></special><parameters><parameter key="TimeMax" value="1" /></parameters>)";
    return out;
}

std::vector<Vec3> particles_of(const TemporaryFolder& folder, const CaseText& text)
{
    write_text(folder / "Case_Def.xml", text.text());
    const RunResult result = run(folder, {"Case_Def", "Case"});
    EXPECT_EQ(result.code, 0) << result.output;
    return fppg::read_particles(folder / "Case", false, 1).positions;
}

std::string case_xml(const TemporaryFolder& folder)
{
    return read_text(folder / "Case.xml");
}

class FlexibleBody : public testing::TestWithParam<const char*>
{
};

TEST_P(FlexibleBody, HasTheParticlesOfItsVolumeWhetherItsClampIsFixedOrMoves)
{
    const TemporaryFolder folder;
    const std::vector<Vec3> all = particles_of(folder, flexible(GetParam()));
    std::size_t plate = 0;
    for (const Vec3& p : all)
    {
        EXPECT_GT(std::min(p.z - 0.007, 0.067 - p.z), 0.499 * dp);
        plate += p.x > 0 ? 1 : 0;
    }
    EXPECT_NEAR(static_cast<double>(plate) * std::pow(dp, 3) / (0.4 * 0.2 * 0.06), 1, 0.001);
    EXPECT_NEAR(static_cast<double>(all.size() - plate) * std::pow(dp, 3) / (0.1 * 0.2 * 0.06), 1,
                0.005);
    const std::string xml = case_xml(folder);
    EXPECT_TRUE(contains(xml, fmt::format(R"(<moving mkbound="1" )")));
    EXPECT_TRUE(contains(xml, "flexstrucbody"));
    const bool is_fixed = *GetParam() == 0;
    EXPECT_TRUE(contains(xml, is_fixed ? R"(<fixed mkbound="0" )" : R"(<moving mkbound="0" )"));
}

INSTANTIATE_TEST_SUITE_P(
    Clamp, FlexibleBody,
    testing::Values("",
                    R"(<objreal ref="0"><begin mov="1" start="0" /><mvnull id="1" /></objreal>)"));

/// The solver counts each particle of a flexible body for dp^3.
TEST(FlexibleBodies, ThatWeighMoreThanTheirShapesAreWarnedOf)
{
    const std::string said = "flexible mkbound 1: DualSPHysics counts each of its ";
    for (const bool is_inside : {false, true})
    {
        const TemporaryFolder folder;
        CaseText text = flexible("");
        if (!is_inside)
            text.after_geometry.replace(text.after_geometry.find(R"( place="inside")"), 15, "");
        write_text(folder / "Case_Def.xml", text.text());
        const RunResult result = run(folder, {"Case_Def", "Case"});
        ASSERT_EQ(result.code, 0) << result.output;
        EXPECT_EQ(contains(result.output, said), !is_inside) << result.output;
    }
}

TEST(InsideCase, InitialsMoveAllItsParticlesAlike)
{
    const TemporaryFolder still, moved;
    CaseText text;
    text.dp = fmt::format("{}", dp);
    text.mainlist = R"(<setdrawmode mode="full" /><setmkbound mk="0" />)" +
                    box(R"(x="0.013" y="0.003" z="0.007")", R"(x="0.3" y="0.2" z="0.1")");
    text.after_geometry = inside;
    const std::vector<Vec3> before = particles_of(still, text);
    text.after_geometry += R"(<initials><move mkbound="0" x="0.05" y="0" z="0.011" /></initials>)";
    const std::vector<Vec3> after = particles_of(moved, text);
    ASSERT_EQ(before.size(), after.size());
    for (std::size_t i = 0; i < before.size(); ++i)
        EXPECT_LT(norm(after[i] - before[i] - Vec3{0.05, 0, 0.011}), 1e-6 * dp);
}

TEST(InsideCase, VoidCutsTakeWhatTheyCoverAndNoMore)
{
    // Wherever the cut is between the nodes: what is inserted along the walls does not flow into
    // it.
    for (const double cut : {0.253, 0.246, 0.259, 0.237})
    {
        const TemporaryFolder folder;
        CaseText text;
        text.dp = fmt::format("{}", dp);
        text.mainlist =
            R"(<setdrawmode mode="full" /><setmkbound mk="0" />)" +
            box(R"(x="0.013" y="0.003" z="0.007")", R"(x="0.4" y="0.2" z="0.2")") +
            "<setmkvoid />" +
            box(fmt::format(R"(x="{}" y="-0.1" z="-0.1")", cut), R"(x="1" y="1" z="1")");
        text.after_geometry = inside;
        const std::vector<Vec3> all = particles_of(folder, text);
        for (const Vec3& p : all) EXPECT_LT(p.x, cut);
        const double length = cut - 0.013;
        const double number = length * 0.2 * 0.2 / std::pow(dp, 3);
        EXPECT_NEAR(static_cast<double>(all.size()), number, number * dp / length); // one layer
    }
}

TEST(InsideCase, ABoreInAPlateIsFreeAndTheNumberIsThatOfWhatIsLeft)
{
    for (const bool is_2d : {false, true})
    {
        const TemporaryFolder folder;
        CaseText text;
        text.dp = fmt::format("{}", dp);
        const double y = is_2d ? 0.5 : 0.2;
        if (is_2d)
        {
            text.pointmin = R"(<pointmin x="-0.5" y="0" z="-0.5" />)";
            text.pointmax = R"(<pointmax x="1.5" y="0" z="1.5" />)";
        }
        const double radius = 0.07;
        text.mainlist =
            R"(<setdrawmode mode="full" /><setmkbound mk="0" />)" +
            box(fmt::format(R"(x="0.013" y="{}" z="0.007")", -y / 2),
                fmt::format(R"(x="0.4" y="{}" z="0.3")", y)) +
            R"(<setmkbound mk="1" /><drawcylinder radius="0.07"><point x="0.2" y="-1" z="0.15" /><point x="0.2" y="1" z="0.15" /></drawcylinder>)";
        text.after_geometry =
            R"(<fppg><bodyfitted place="inside" /><boolean op="difference"><part mkbound="0" /><part mkbound="1" /></boolean></fppg>)";
        const std::vector<Vec3> all = particles_of(folder, text);
        const double area = 0.4 * 0.3 - std::numbers::pi * radius * radius;
        const double number = is_2d ? area / (dp * dp) : area * y / std::pow(dp, 3);
        EXPECT_NEAR(static_cast<double>(all.size()) / number, 1, is_2d ? 0.01 : 0.003);
        for (const Vec3& p : all) EXPECT_GT(std::hypot(p.x - 0.2, p.z - 0.15) - radius, 0.49 * dp);
    }
}

/// A plate, 0.6 m long and 0.3 m wide, whose first half is so many dp thick and its other half
/// more.
std::string step_plate(int thin, int thick)
{
    const std::array<std::array<double, 2>, 7> profile{{{0, 0},
                                                        {0.3, 0},
                                                        {0.6, 0},
                                                        {0.6, thick * dp},
                                                        {0.3, thick * dp},
                                                        {0.3, thin * dp},
                                                        {0, thin * dp}}};
    std::string out = "solid step\n";
    const auto corner = [&](std::size_t k, double y)
    { return fmt::format("vertex {} {} {}\n", profile[k][0], y, profile[k][1]); };
    const auto facet = [&](const std::string& a, const std::string& b, const std::string& c)
    { out += "facet normal 0 0 0\nouter loop\n" + a + b + c + "endloop\nendfacet\n"; };
    using Triangle = std::array<std::size_t, 3>;
    for (const Triangle& t : {Triangle{0, 1, 5}, {0, 5, 6}, {1, 2, 3}, {1, 3, 5}, {5, 3, 4}})
    {
        facet(corner(t[0], 0), corner(t[1], 0), corner(t[2], 0));
        facet(corner(t[0], 0.3), corner(t[2], 0.3), corner(t[1], 0.3));
    }
    for (std::size_t i = 0; i < profile.size(); ++i)
    {
        const std::size_t j = (i + 1) % profile.size();
        facet(corner(i, 0), corner(i, 0.3), corner(j, 0.3));
        facet(corner(i, 0), corner(j, 0.3), corner(j, 0));
    }
    return out + "endsolid step\n";
}

CaseText step_case(const TemporaryFolder& folder, int thin, int thick, const std::string& more)
{
    write_text(folder / "step.stl", step_plate(thin, thick));
    CaseText text;
    text.dp = fmt::format("{}", dp);
    text.mainlist =
        R"(<setdrawmode mode="full" /><setmkbound mk="0" /><drawfilestl file="step.stl" autofill="true" />)";
    text.after_geometry = R"(<fppg><bodyfitted place="inside" )" + more + " /></fppg>";
    return text;
}

TEST(InsideCase, APlateOfTwoThicknessesHasWholeSheetsInEachHalf)
{
    for (const auto& [thin, thick] : {std::pair{1, 3}, std::pair{2, 4}})
    {
        const TemporaryFolder folder;
        const std::vector<Vec3> all = particles_of(folder, step_case(folder, thin, thick, ""));
        EXPECT_NEAR(static_cast<double>(all.size()), 0.3 * 0.3 * (thin + thick) / (dp * dp), 1);
        for (const auto& [sheets, low] : {std::pair{thin, 0.06}, std::pair{thick, 0.36}})
        {
            std::vector<int> count(static_cast<std::size_t>(sheets), 0);
            for (const Vec3& p : all)
            {
                if (p.x < low || p.x > low + 0.18 || p.y < 0.06 || p.y > 0.24) continue;
                const double at = p.z / dp - 0.5;
                EXPECT_NEAR(at, std::round(at), 0.3);
                ++count[static_cast<std::size_t>(
                    std::clamp(std::lround(at), 0L, static_cast<long>(sheets - 1)))];
            }
            for (const int n : count) EXPECT_NEAR(n, 81, 18); // two rows may be beyond the borders
        }
    }
}

TEST(InsideCase, SheetsAskedForInAPlateOfTwoThicknessesAreWarnedOf)
{
    const TemporaryFolder folder;
    write_text(folder / "Case_Def.xml", step_case(folder, 1, 3, R"(across="1")").text());
    const RunResult result = run(folder, {"Case_Def", "Case"});
    EXPECT_EQ(result.code, 0) << result.output;
    EXPECT_TRUE(contains(result.output, "the sheets are those of a thickness of 0.02 m"))
        << result.output;
}

} // namespace
