// The element <boolean> of <fppg>, from the case to the nodes and particles.
#include "fppg/case_def.h"
#include "fppg/error.h"
#include "fppg/lattice.h"
#include "fppg/scene.h"

#include "helpers/case_text.h"

#include <gmock/gmock.h>

#include <cmath>
#include <map>

namespace fppg
{
namespace
{

using test::CaseText;
using testing::HasSubstr;

constexpr const char* parts = R"(<setmkbound mk="1" />
<drawbox fppg:name="block"><boxfill>solid</boxfill><point x="0.2" y="0.2" z="0.2" /><size x="0.4" y="0.4" z="0.4" /></drawbox>
<setmkbound mk="2" />
<drawsphere radius="0.2" fppg:name="ball"><point x="0.6" y="0.6" z="0.6" /></drawsphere>
<setmkvoid />
<drawcylinder radius="0.1" fppg:name="drill"><point x="0.4" y="0.4" z="0" /><point x="0.4" y="0.4" z="1" /></drawcylinder>)";

constexpr const char* cube = R"(<pointmin x="0" y="0" z="0" /><pointmax x="1" y="1" z="1" />)";

CaseDef read(const std::string& block, const std::string& draws = parts,
             const std::string& limits = cube)
{
    const test::TemporaryFolder folder;
    const std::string text =
        R"(<?xml version="1.0" encoding="UTF-8" ?><case><casedef><constantsdef>
<lattice bound="1" fluid="1" /><gravity x="0" y="0" z="-9.81" /><rhop0 value="1000" />
<hswl value="0" auto="true" /><gamma value="7" /><coefsound value="20" /><coefh value="1" />
<cflnumber value="0.2" /></constantsdef><mkconfig boundcount="240" fluidcount="9" />
<geometry><definition dp="0.04">)" +
        limits + "</definition><commands><mainlist>" + draws +
        "</mainlist></commands></geometry><fppg>" + block +
        "</fppg></casedef><execution><parameters><parameter key=\"TimeMax\" value=\"1\" />"
        "</parameters></execution></case>";
    test::write_text(folder / "Case_Def.xml", text);
    return read_case(folder / "Case_Def.xml", {});
}

std::string error_of(const std::string& block)
{
    try
    {
        read(block);
    }
    catch (const CaseError& e)
    {
        return e.what();
    }
    return "none";
}

RunField run(const CaseDef& def)
{
    LatticeReport report;
    return draw_scene(make_scene(def), 2, {}, report);
}

/// Nodes by mk, without those of the zone of a wall.
std::map<int, std::size_t> count(const RunField& field)
{
    std::map<int, std::size_t> out;
    for (const auto& slab : field.slabs)
        for (const Run& r : slab)
            if (!r.is_covered) out[r.mk] += r.z_end - r.z_begin;
    return out;
}

constexpr const char* drilled =
    R"(<boolean name="all" op="difference"><boolean op="union"><part ref="block" /><part ref="ball" /></boolean><part ref="drill" /></boolean>)";

TEST(BooleanCase, TakesNodesByIntervalOperationsOnTheLattice)
{
    const RunField whole = run(read(""));
    const RunField field = run(read(drilled));
    // Drawn one after the other, the ball paints over the block and the void drill over both: the
    // same nodes, but what both have belongs to the first.
    std::size_t of_whole = 0, of_field = 0;
    for (const auto& [mk, n] : count(whole)) of_whole += n;
    for (const auto& [mk, n] : count(field)) of_field += n;
    EXPECT_EQ(of_whole, of_field);
    EXPECT_GT(count(field).at(11), count(whole).at(11));
    EXPECT_LT(count(field).at(12), count(whole).at(12));
}

TEST(BooleanCase, FitsTheResultAsOneBody)
{
    const RunField field = run(read(std::string("<bodyfitted />") + drilled));
    ASSERT_EQ(field.walls.bodies.size(), 1U);
    EXPECT_TRUE(field.walls.bodies[0].report.is_watertight);
    std::map<int, std::size_t> of_mk;
    for (const std::uint16_t mk : field.walls.particles.mk) ++of_mk[mk];
    EXPECT_EQ(of_mk.size(), 2U);
    EXPECT_GT(of_mk[11], 600U);
    EXPECT_GT(of_mk[12], 150U);
    EXPECT_EQ(count(field).size(), 2U);
}

TEST(BooleanCase, OneMkForAllWhereItIsGiven)
{
    const RunField field = run(read(
        R"(<bodyfitted /><boolean op="union" mkbound="7"><part mkbound="1" /><part ref="ball" /></boolean>)"));
    for (const std::uint16_t mk : field.walls.particles.mk) ASSERT_EQ(mk, 17);
    EXPECT_EQ(count(field).size(), 1U);
}

TEST(BooleanCase, ItsOwnMkMayBeFitted)
{
    const CaseDef def = read(
        R"(<bodyfitted mkbound="7" /><boolean op="union" mkbound="7"><part ref="block" /><part ref="ball" /></boolean>)");
    for (const std::string& w : def.warnings) EXPECT_THAT(w, testing::Not(HasSubstr("bodyfitted")));
    EXPECT_EQ(run(def).walls.bodies.size(), 1U);
}

TEST(BooleanCase, CutsTheSectionOfTwoCylindersInTwoDimensions)
{
    const RunField field = run(read(
        R"(<bodyfitted /><boolean op="union"><part ref="left" /><part ref="right" /></boolean>)",
        R"(<setdrawmode mode="full" /><setmkbound mk="1" />
<drawcylinder radius="0.2" fppg:name="left"><point x="0.4" y="0.3" z="0.5" /><point x="0.4" y="0.7" z="0.5" /></drawcylinder>
<setmkbound mk="2" />
<drawcylinder radius="0.2" fppg:name="right"><point x="0.6" y="0.3" z="0.5" /><point x="0.6" y="0.7" z="0.5" /></drawcylinder>)",
        R"(<pointmin x="0" y="0.5" z="0" /><pointmax x="1" y="0.5" z="1" />)"));
    const double dp = 0.04;
    const auto& walls = field.walls.particles;
    std::size_t seam = 0;
    for (std::size_t i = 0; i < walls.size(); ++i)
    {
        const Vec3& p = walls.positions[i];
        EXPECT_EQ(p.y, 0.5);
        const double left = std::hypot(p.x - 0.4, p.z - 0.5) - 0.2;
        const double right = std::hypot(p.x - 0.6, p.z - 0.5) - 0.2;
        // On one circle, to the facets that stand for it, and inside none.
        EXPECT_NEAR(std::min(left, right), 0, 0.0051 * dp);
        if (std::abs(left - right) < 0.0051 * dp)
            ++seam;
        else
            EXPECT_EQ(walls.mk[i], left < right ? 11 : 12);
    }
    EXPECT_EQ(seam, 2U);
    // Two thirds of two circles.
    EXPECT_NEAR(static_cast<double>(walls.size()), 4.0 / 3 * 2 * 3.14159265 * 0.2 / dp, 2);
    // Particles inside and half of those around stand for the area of the section.
    double nodes = 0;
    for (const auto& [mk, n] : count(field)) nodes += static_cast<double>(n);
    const double area = 3.14159265 * 0.04 * 4 / 3 + std::sqrt(3.0) / 2 * 0.04;
    EXPECT_NEAR((nodes + 0.5 * static_cast<double>(walls.size())) * dp * dp, area, 0.03 * area);
}

TEST(BooleanCase, NestsByName)
{
    const std::string block =
        R"(<bodyfitted /><boolean name="both" op="union" draw="false"><part ref="block" /><part ref="ball" /></boolean>
<boolean op="difference"><part ref="both" /><part ref="drill" /></boolean>)";
    const RunField named = run(read(block));
    const RunField inside = run(read(std::string("<bodyfitted />") + drilled));
    EXPECT_EQ(named.walls.particles.positions, inside.walls.particles.positions);
}

TEST(BooleanCase, NamesWhatIsWrong)
{
    EXPECT_THAT(error_of(R"(<boolean op="union"><part ref="block" /><part ref="bal" /></boolean>)"),
                HasSubstr("ref=\"bal\" is the fppg:name of no draw and the name of no boolean "
                          "before this one; there are: ball, block, drill"));
    EXPECT_THAT(error_of(R"(<boolean op="xor"><part ref="block" /><part ref="ball" /></boolean>)"),
                HasSubstr("expected union, intersection or difference"));
    EXPECT_THAT(error_of(R"(<boolean op="union"><part ref="block" /></boolean>)"),
                HasSubstr("has 1 operands, expected two or more"));
    EXPECT_THAT(
        error_of(R"(<boolean op="union"><part ref="block" /><part ref="drill" /></boolean>)"),
        HasSubstr("is drawn as void, expected a bound or a fluid"));
}

} // namespace
} // namespace fppg
