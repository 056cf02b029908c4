// Bodies with place="inside" in whole cases: flexible ones and their clamps, initials, cuts and
// Booleans; FPPG_PROGRAM is the program's path.

#include "fppg/element.h"
#include "fppg/particles.h"
#include "fppg/read_particles.h"

#include "casedef/xml_document.h"
#include "helpers/case_text.h"
#include "helpers/gears.h"
#include "helpers/run_fppg.h"
#include "meshes/crowded_points.h"

#include <gtest/gtest.h>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

namespace
{

using fppg::ParticleCloud;
using fppg::Vec3;
using nlohmann::json;
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

/// What the log with -log-json says of the body of a case and its particles; null if nothing.
json body_event(const RunResult& result)
{
    json body;
    std::istringstream lines(result.output);
    for (std::string line; std::getline(lines, line);)
        if (contains(line, R"("event":"body")")) body = json::parse(line);
    return body;
}

/// The facets of a box in ASCII STL, which look inwards or outwards.
std::string box_facets(const Vec3& low, const Vec3& size, bool look_inwards)
{
    std::string out;
    for (int axis = 0; axis < 3; ++axis)
        for (const int side : {0, 1})
        {
            const auto corner = [&](int u, int v)
            {
                Vec3 p = low;
                p[axis] += side * size[axis];
                p[(axis + 1) % 3] += u * size[(axis + 1) % 3];
                p[(axis + 2) % 3] += v * size[(axis + 2) % 3];
                return fmt::format("vertex {:.9g} {:.9g} {:.9g}\n", p.x, p.y, p.z);
            };
            const bool is_turned = (side == 0) != look_inwards;
            for (const bool first : {true, false})
            {
                const std::string a = first ? corner(1, 0) : corner(1, 1);
                const std::string b = first ? corner(1, 1) : corner(0, 1);
                out += "facet normal 0 0 0\nouter loop\n" + corner(0, 0) +
                       (is_turned ? b + a : a + b) + "endloop\nendfacet\n";
            }
        }
    return out;
}

/// A public car is such a file: its table had 34 % too little volume, and a negative inertia.
TEST(ExactShape, TakesPartsThatLookInwardsForTheirVolume)
{
    for (const bool is_fitted : {true, false})
    {
        const TemporaryFolder folder;
        write_text(folder / "parts.stl",
                   "solid parts\n" + box_facets({0.003, 0.003, 0.007}, {0.2, 0.2, 0.1}, false) +
                       box_facets({0.303, 0.003, 0.007}, {0.1, 0.2, 0.1}, true) +
                       "endsolid parts\n");
        CaseText text;
        text.dp = fmt::format("{}", dp);
        text.mainlist =
            R"(<setdrawmode mode="full" /><setmkbound mk="0" /><drawfilestl file="parts.stl" autofill="true" />)";
        text.after_geometry =
            R"(<floatings><floating mkbound="0" rhopbody="1000" /></floatings><fppg><floatings exact="true" /></fppg>)";
        write_text(folder / "Case_Def.xml", text.text());
        Arguments arguments{"Case_Def", "Case", "-log-json"};
        if (is_fitted) arguments.push_back("-fit");
        const RunResult result = run(folder, arguments);
        ASSERT_EQ(result.code, 0) << result.output;
        // 0.006 m3, of which a third is 0.25 m from the rest.
        const std::string written = read_text(folder / "Case.xml");
        const auto number = [&](const std::string& before)
        { return std::stod(written.substr(written.find(before) + before.size())); };
        EXPECT_NEAR(number("<massbody value=\""), 6, 1e-6) << is_fitted;
        EXPECT_NEAR(number("<center x=\""), 0.103 + 0.25 / 3, 1e-6) << is_fitted;
        if (!is_fitted) continue;
        const json body = body_event(result);
        ASSERT_FALSE(body.is_null()) << result.output;
        EXPECT_NEAR(body["shape"]["volume"].get<double>(), 0.006, 1e-9);
        EXPECT_NEAR(body["shape"]["centre"][0].get<double>(), 0.103 + 0.25 / 3, 1e-6);
        for (std::size_t axis = 0; axis < 3; ++axis)
            EXPECT_NEAR(body["particles"]["inertia"][axis].get<double>() /
                            body["shape"]["inertia"][axis].get<double>(),
                        1, 0.002);
    }
}

/// An impeller about z in ASCII STL, 20 dp across and 5 dp high times `size`: a hub with four
/// blades that turn by 40 degrees over its height, in eight rows of facets. Across the facets of a
/// row a blade turns by up to 36 degrees.
std::string impeller(double size)
{
    constexpr int rows = 8, blades = 4;
    const double radius = 10 * size * dp, hub = 2.333 * size * dp, height = 5 * size * dp;
    const double half = 0.5 * size * dp;        // of a blade's thickness
    std::vector<std::array<double, 2>> outline; // radius, angle
    for (int b = 0; b < blades; ++b)
    {
        const double middle = 2 * std::numbers::pi * b / blades;
        const double at_hub = std::asin(half / hub), at_tip = std::asin(half / radius);
        for (const auto& [r, a] : {std::pair{hub, -at_hub},
                                   {radius, -at_tip},
                                   {radius, 0.0},
                                   {radius, at_tip},
                                   {hub, at_hub}})
            outline.push_back({r, middle + a});
        const double rest = 2 * std::numbers::pi / blades - 2 * at_hub;
        for (int i = 1; i < 4; ++i) outline.push_back({hub, middle + at_hub + rest * i / 4});
    }
    const auto vertex = [&](int row, std::size_t i)
    {
        const auto& [r, a] = outline[i % outline.size()];
        const double turned = a + std::numbers::pi / 180 * 40 * (row / double{rows} - 0.5);
        return Vec3{r * std::cos(turned), r * std::sin(turned),
                    height * (row / double{rows} - 0.5)};
    };
    std::string out = "solid impeller\n";
    const auto facet = [&](const Vec3& a, const Vec3& b, const Vec3& c)
    {
        out += "facet normal 0 0 0\nouter loop\n";
        for (const Vec3& v : {a, b, c})
            out += fmt::format("vertex {:.9g} {:.9g} {:.9g}\n", v.x, v.y, v.z);
        out += "endloop\nendfacet\n";
    };
    for (std::size_t i = 0; i < outline.size(); ++i)
    {
        for (int row = 0; row < rows; ++row)
        {
            facet(vertex(row, i), vertex(row, i + 1), vertex(row + 1, i + 1));
            facet(vertex(row, i), vertex(row + 1, i + 1), vertex(row + 1, i));
        }
        facet({0, 0, -height / 2}, vertex(0, i + 1), vertex(0, i));
        facet({0, 0, height / 2}, vertex(rows, i), vertex(rows, i + 1));
    }
    return out + "endsolid impeller\n";
}

/// What was before: at 1 dp its blades had a third of their particles and its hub the rest, so
/// that its inertia was 12 % too small; 0.8 % at 2 dp, and 5.7 % too large at 3.
class ThinBlades : public testing::TestWithParam<int>
{
};

TEST_P(ThinBlades, HaveTheirParticlesAndNoMore)
{
    const TemporaryFolder folder;
    const int size = GetParam();
    write_text(folder / "impeller.stl", impeller(size));
    CaseText text;
    text.dp = fmt::format("{}", dp);
    text.pointmin = R"(<pointmin x="-0.8" y="-0.8" z="-0.3" />)";
    text.pointmax = R"(<pointmax x="0.8" y="0.8" z="0.3" />)";
    text.mainlist =
        R"(<setdrawmode mode="full" /><setmkbound mk="0" /><drawfilestl file="impeller.stl" autofill="true" />)";
    text.after_geometry = inside;
    write_text(folder / "Case_Def.xml", text.text());
    const RunResult result = run(folder, {"Case_Def", "Case", "-log-json"});
    ASSERT_EQ(result.code, 0) << result.output;
    const json body = body_event(result);
    ASSERT_FALSE(body.is_null()) << result.output;
    const json& shape = body["shape"];
    const json& own = body["particles"];
    const std::vector<Vec3> particles = fppg::read_particles(folder / "Case", false, 1).positions;
    EXPECT_NEAR(static_cast<double>(particles.size()),
                shape["volume"].get<double>() / std::pow(dp, 3), 1);
    for (std::size_t axis = 0; axis < 3; ++axis)
    {
        EXPECT_NEAR(own["centre"][axis].get<double>(), shape["centre"][axis].get<double>(),
                    0.01 * dp);
        EXPECT_NEAR(own["inertia"][axis].get<double>() / shape["inertia"][axis].get<double>(), 1,
                    0.002);
    }
    const std::vector<double> nearest = fppg::nearest_distances(particles, dp, 1);
    EXPECT_GT(*std::min_element(nearest.begin(), nearest.end()), 0.68 * dp);
    // Of the blades between hub and tips. Their facets cut some of their volume off.
    std::size_t outer = 0;
    for (const Vec3& p : particles)
    {
        const double r = std::hypot(p.x, p.y) / (size * dp);
        outer += r > 4 && r < 9 ? 1 : 0;
    }
    EXPECT_NEAR(static_cast<double>(outer) / std::pow(size, 3), 86, 9);
}

INSTANTIATE_TEST_SUITE_P(DpThick, ThinBlades, testing::Values(1, 2, 3));

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

/// Most of what is looked at of its surface are the flanks of its teeth. It was filled as a plate
/// as thin as these, so that the wheel behind them was hollow.
TEST(InsideCase, AWheelOfThinTeethIsFull)
{
    constexpr double tip = 10 * dp, root = 6.8 * dp, width = 7.8 * dp;
    const fppg::TriangleSoup wheel = toothed_wheel(16, tip, root, width);
    const TemporaryFolder folder;
    write_stl(folder / "wheel.stl", wheel);
    CaseText text;
    text.dp = fmt::format("{}", dp);
    text.pointmin = R"(<pointmin x="-0.4" y="-0.4" z="-0.4" />)";
    text.mainlist = R"(<setmkbound mk="0" /><drawfilestl file="wheel.stl" autofill="true" />)";
    text.after_geometry = inside;
    const std::vector<Vec3> all = particles_of(folder, text);
    double six = 0;
    for (std::size_t i = 0; i < wheel.vertices.size(); i += 3)
        six += dot(wheel.vertices[i], cross(wheel.vertices[i + 1], wheel.vertices[i + 2]));
    EXPECT_NEAR(static_cast<double>(all.size()), six / 6 / (dp * dp * dp), 1);
    // Of its middle as many as its volume.
    constexpr double radius = 4 * dp, half = 2 * dp;
    const auto in_middle = std::count_if(
        all.begin(), all.end(),
        [&](const Vec3& p) { return std::hypot(p.x, p.y) < radius && std::abs(p.z) < half; });
    EXPECT_NEAR(static_cast<double>(in_middle), std::numbers::pi * 16 * 4, 20);
}

/// Teeth of one thickness on a base of another; the base had one sheet, as the teeth have.
TEST(InsideCase, ACombHasAFullBase)
{
    const TemporaryFolder folder;
    CaseText text;
    text.dp = fmt::format("{}", dp);
    text.mainlist = R"(<setdrawmode mode="full" /><setmkbound mk="0" />)" +
                    box(R"(x="0.1" y="0.1" z="0.1")", R"(x="0.33" y="0.3" z="0.076")");
    for (int tooth = 0; tooth < 8; ++tooth)
        text.mainlist += box(fmt::format(R"(x="{}" y="0.1" z="0.15")", 0.1 + 0.044 * tooth),
                             R"(x="0.022" y="0.3" z="0.25")");
    text.after_geometry = inside;
    const std::vector<Vec3> all = particles_of(folder, text);
    const auto in_base =
        std::count_if(all.begin(), all.end(), [](const Vec3& p) { return p.z < 0.176; });
    constexpr double base = 0.33 * 0.3 * 0.076, teeth = 8 * 0.022 * 0.3 * 0.224;
    EXPECT_NEAR(static_cast<double>(all.size()), (base + teeth) / (dp * dp * dp), 1);
    EXPECT_NEAR(static_cast<double>(in_base), base / (dp * dp * dp), 60);
}

/// A float of few particles, which count as points.
TEST(InsideCase, AFloatThatTurnsMoreEasilyThanItsShapeIsWarnedOf)
{
    for (const bool is_exact : {false, true})
    {
        const TemporaryFolder folder;
        CaseText text;
        text.dp = fmt::format("{}", dp);
        text.mainlist = R"(<setdrawmode mode="full" /><setmkbound mk="1" />)" +
                        box(R"(x="0.1" y="0.1" z="0.1")", R"(x="0.3" y="0.04" z="0.04")");
        text.after_geometry =
            R"(<floatings><floating mkbound="1" rhopbody="500" /></floatings><fppg>)" +
            std::string(is_exact ? R"(<floatings exact="true" />)" : "") +
            R"(<bodyfitted place="inside" /></fppg>)";
        write_text(folder / "Case_Def.xml", text.text());
        const RunResult result = run(folder, {"Case_Def", "Case"});
        ASSERT_EQ(result.code, 0) << result.output;
        EXPECT_EQ(contains(result.output, "another inertia than their shapes"), !is_exact)
            << result.output;
    }
}

} // namespace
