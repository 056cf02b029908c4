// Which side of a wall the particles of its layers look to; FPPG_PROGRAM is the program's path.

#include "fppg/read_particles.h"

#include "helpers/bi4_array.h"
#include "helpers/case_text.h"
#include "helpers/run_fppg.h"

#include <gtest/gtest.h>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace
{

using fppg::ParticleCloud;
using fppg::Vec3;
using namespace fppg::test;

constexpr double dp = 0.05;
constexpr std::uint16_t body_mk = 10;
constexpr std::uint16_t tank_mk = 11;

std::string solid(const Vec3& low, const Vec3& high)
{
    return fmt::format(
        R"(<drawbox><boxfill>solid</boxfill><point x="{}" y="{}" z="{}" /><size x="{}" y="{}" z="{}" /></drawbox>)",
        low.x, low.y, low.z, high.x - low.x, high.y - low.y, high.z - low.z);
}

/// A tank with walls of 4 dp and water up to z = 0.3, and a body in it.
CaseText body_in_tank(const std::string& body, bool is_2d, const std::string& more = "")
{
    CaseText text;
    text.dp = fmt::format("{}", dp);
    text.pointmin = fmt::format(R"(<pointmin x="-1.5" y="{}" z="-0.5" />)", is_2d ? 0 : -1);
    text.pointmax = fmt::format(R"(<pointmax x="1.5" y="{}" z="1.5" />)", is_2d ? 0 : 1);
    text.mainlist = R"(<setdrawmode mode="full" /><setmkbound mk="0" />)" + body +
                    R"(<setmkbound mk="1" />)" + solid({-1, -0.6, -0.2}, {1, 0.6, 0}) +
                    solid({-1.2, -0.6, -0.2}, {-1, 0.6, 0.9}) +
                    solid({1, -0.6, -0.2}, {1.2, 0.6, 0.9});
    if (!is_2d)
        text.mainlist +=
            solid({-1.2, -0.8, -0.2}, {1.2, -0.6, 0.9}) + solid({-1.2, 0.6, -0.2}, {1.2, 0.8, 0.9});
    text.mainlist +=
        R"(<setmkfluid mk="0" /><fillbox x="0" y="0" z="0.1"><modefill>void</modefill><point x="-1.1" y="-0.7" z="-0.1" /><size x="2.2" y="1.4" z="0.4" /></fillbox>)";
    text.after_geometry = R"(<fppg><bodyfitted mkbound="0-1" boundary="mdbc" /></fppg>)" + more;
    text.execution =
        R"(<parameters><parameter key="Boundary" value="2" /><parameter key="SlipMode" value="2" /><parameter key="NoPenetration" value="1" /></parameters>)";
    return text;
}

/// The particles with the normals that the solver reads.
ParticleCloud make(const CaseText& text)
{
    const TemporaryFolder folder;
    write_text(folder / "Case_Def.xml", text.text());
    const RunResult result = run(folder, {"Case_Def", "out/Case", "-save:all"});
    EXPECT_EQ(result.code, 0) << result.output;
    ParticleCloud cloud = fppg::read_particles(folder / "out/Case", true, 1);
    const std::vector<float> normals =
        bi4_array<float>(read_text(folder / "out/Case.bi4"), "BoundNor");
    for (std::size_t i = 0; i < cloud.normals.size(); ++i)
        for (std::size_t k = 0; k < 3; ++k)
            cloud.normals[i][k] = 3 * i + k < normals.size() ? normals[3 * i + k] : 0;
    return cloud;
}

/// Calls visit(place, layer, normal in dp) for the particles in layers of an mk; how many they are.
template <typename Visit>
std::size_t for_each_in_layers(const ParticleCloud& cloud, std::uint16_t mk, const Visit& visit)
{
    std::size_t count = 0;
    for (std::size_t i = 0; i < cloud.positions.size(); ++i)
    {
        if (cloud.mk[i] != mk || cloud.layer[i] == 0) continue;
        ++count;
        const std::array<float, 3>& n = cloud.normals[i];
        visit(cloud.positions[i], int{cloud.layer[i]}, Vec3{n[0], n[1], n[2]} / dp);
    }
    return count;
}

/// The solver (v5.4) leaves the velocity of walls without normals undefined with SlipMode 2 and 3.
TEST(WallsWithoutNormals, AreNamedWhereTheSolverLeavesTheirVelocityUndefined)
{
    for (const auto& [fitted, slip] : {std::pair{"0", "2"}, {"0", "1"}, {"0-1", "2"}})
    {
        CaseText text = body_in_tank(solid({-0.6, -0.4, 0.35}, {0.6, 0.4, 0.55}), true);
        text.after_geometry =
            fmt::format(R"(<fppg><bodyfitted mkbound="{}" boundary="mdbc" /></fppg>)", fitted);
        text.execution = fmt::format(
            R"(<parameters><parameter key="Boundary" value="2" /><parameter key="SlipMode" value="{}" /></parameters>)",
            slip);
        const TemporaryFolder folder;
        write_text(folder / "Case_Def.xml", text.text());
        const RunResult result = run(folder, {"Case_Def", "out/Case"});
        EXPECT_EQ(result.code, 0) << result.output;
        EXPECT_EQ(contains(result.output, "mkbound 1 has no normals. With SlipMode 2"),
                  fitted == std::string("0") && slip == std::string("2"))
            << result.output;
    }
}

/// A gate between water and air, unless it turns over and both of its sides come to the water.
TEST(GateOfTwoLayers, LooksToTheWaterWithBoth)
{
    const auto gate = [](const std::string& motion)
    {
        CaseText text = body_in_tank("", true);
        text.mainlist = R"(<setdrawmode mode="full" /><setmkbound mk="0" />)" +
                        solid({-1.2, -1, -0.2}, {1.2, 1, 0}) + solid({-1.2, -1, 0}, {-1, 1, 1.4}) +
                        solid({1, -1, 0}, {1.2, 1, 1.4}) + R"(<setmkbound mk="1" />)" +
                        solid({0, -1, 0}, {2 * dp, 1, 1.2}) + R"(<setmkfluid mk="0" />)" +
                        solid({-1, -1, 0}, {0, 1, 0.6});
        text.after_geometry = R"(<motion><objreal ref="1"><begin mov="1" start="0.1" />)" + motion +
                              R"(</objreal></motion><fppg><bodyfitted boundary="mdbc" /></fppg>)";
        return make(text);
    };
    const auto looking_away = [](const ParticleCloud& cloud)
    {
        std::size_t away = 0;
        std::size_t count = 0;
        for (std::size_t i = 0; i < cloud.positions.size(); ++i)
        {
            const double z = cloud.positions[i].z;
            if (cloud.mk[i] != tank_mk || z < 0.1 || z > 0.5) continue;
            ++count;
            away += cloud.normals[i][0] < 0 ? 0 : 1;
        }
        EXPECT_EQ(count, 2 * 8u);
        return away;
    };
    EXPECT_EQ(
        looking_away(gate(R"(<mvrect id="1" duration="1"><vel x="0" y="0" z="0.2" /></mvrect>)")),
        0u);
    EXPECT_EQ(
        looking_away(gate(
            R"(<mvrot id="1" duration="1" anglesunits="degrees"><vel ang="360" /><axisp1 x="0" y="0" z="0.6" /><axisp2 x="0" y="1" z="0.6" /></mvrot>)")),
        8u);
}

/// Five blocks, each with an mk of its own: what one covers of another is cut off along its border.
TEST(BlocksThatMakeUpATank, LookToTheNearestPlaceOfItsCavity)
{
    constexpr Vec3 low{-1, -0.6, 0};
    constexpr Vec3 high{1, 0.6, 0.9};
    CaseText text = body_in_tank("", false);
    text.mainlist = R"(<setdrawmode mode="full" />)";
    const auto block = [&](int mk, const Vec3& from, const Vec3& to)
    { text.mainlist += fmt::format(R"(<setmkbound mk="{}" />)", mk) + solid(from, to); };
    block(0, {-1.2, -0.8, -0.2}, {1.2, 0.8, 0});
    block(1, {-1.2, -0.8, 0}, {-1, 0.8, 0.9});
    block(2, {1, -0.8, 0}, {1.2, 0.8, 0.9});
    block(3, {-1, -0.8, 0}, {1, -0.6, 0.9});
    block(4, {-1, 0.6, 0}, {1, 0.8, 0.9});
    text.mainlist +=
        R"(<setmkfluid mk="0" /><fillbox x="0" y="0" z="0.1"><modefill>void</modefill><point x="-1.1" y="-0.7" z="-0.1" /><size x="2.2" y="1.4" z="0.4" /></fillbox>)";
    text.after_geometry = R"(<fppg><bodyfitted boundary="mdbc" /></fppg>)";
    const ParticleCloud cloud = make(text);
    std::size_t count = 0;
    for (std::size_t i = 0; i < cloud.positions.size(); ++i)
    {
        const Vec3& p = cloud.positions[i];
        if (cloud.mk[i] < body_mk || p.z > 0.6) continue;
        Vec3 nearest;
        for (int axis = 0; axis < 3; ++axis)
            nearest[axis] = std::clamp(p[axis], low[axis], high[axis]);
        if (norm(nearest - p) > 3.4 * dp) continue; // out of reach of the fluid
        ++count;
        const std::array<float, 3>& n = cloud.normals[i];
        EXPECT_LT(norm(Vec3{n[0], n[1], n[2]} - (nearest - p)), 2e-3 * dp)
            << p.x << ' ' << p.y << ' ' << p.z;
    }
    EXPECT_GT(count, 8000u);
}

/// Water comes to the upper face of a plate of 4 dp over the water in waves, or when it goes down.
class PlateOverWater : public testing::TestWithParam<std::tuple<bool, bool>>
{
};

TEST_P(PlateOverWater, LooksUpAndDown)
{
    const auto& [is_2d, is_moving] = GetParam();
    const ParticleCloud cloud = make(body_in_tank(
        solid({-0.6, -0.4, 0.35}, {0.6, 0.4, 0.55}), is_2d,
        is_moving
            ? R"(<motion><objreal ref="0"><begin mov="1" start="0" /><mvrect id="1" duration="1"><vel x="0" y="0" z="-0.1" /></mvrect></objreal></motion>)"
            : ""));
    std::size_t up = 0;
    for_each_in_layers(cloud, body_mk,
                       [&](const Vec3& p, int layer, const Vec3& n)
                       {
                           if (layer == 1)
                           {
                               EXPECT_NEAR(norm(n), 0.5, 1e-3) << p.x << ' ' << p.z;
                           }
                           if (std::abs(p.x) > 0.3 || std::abs(p.y) > 0.15 || layer > 2) return;
                           EXPECT_EQ(n.z > 0, p.z > 0.45) << p.z;
                           up += n.z > 0 ? 1 : 0;
                       });
    EXPECT_GT(up, 20u);
}

/// What a wall that parts a tank stands on has the outside of the tank behind it, and fluid beside
/// the wall within reach.
TEST(FloorUnderAWallInATank, LooksToTheWater)
{
    const ParticleCloud cloud =
        make(body_in_tank(solid({0.3, -0.7, -0.1}, {0.5, 0.7, 0.8}), false));
    const auto is_near_fluid = [&](const Vec3& p)
    {
        for (std::size_t i = 0; i < cloud.positions.size(); ++i)
            if (cloud.mk[i] < body_mk && norm(cloud.positions[i] - p) < 3.5 * dp) return true;
        return false;
    };
    std::size_t count = 0;
    for_each_in_layers(cloud, tank_mk,
                       [&](const Vec3& p, int, const Vec3& n)
                       {
                           if (std::abs(p.x) > 0.6 || !is_near_fluid(p)) return;
                           const Vec3 to = p + dp * n;
                           EXPECT_GT(to.z, -0.19) << p.x << ' ' << p.y << ' ' << p.z;
                           EXPECT_LT(std::abs(to.y), 0.79) << p.x << ' ' << p.y << ' ' << p.z;
                           ++count;
                       });
    EXPECT_GT(count, 500u);
}

/// Water that came to the outside of a tank would run away.
TEST_P(PlateOverWater, IsInATankWhoseWallsLookInside)
{
    const auto& [is_2d, is_moving] = GetParam();
    const ParticleCloud cloud = make(body_in_tank(
        solid({-0.6, -0.4, 0.35}, {0.6, 0.4, 0.55}), is_2d,
        is_moving
            ? R"(<motion><objreal ref="1"><begin mov="1" start="0" /><mvrect id="1" duration="1"><vel x="0.1" y="0" z="0" /></mvrect></objreal></motion>)"
            : ""));
    std::size_t count = 0;
    for_each_in_layers(cloud, tank_mk,
                       [&](const Vec3& p, int layer, const Vec3& n)
                       {
                           if (p.x < 1 || std::abs(p.y) > 0.3 || p.z < 0.2 || p.z > 0.6) return;
                           EXPECT_LT(n.x, -0.49) << p.x << ' ' << p.z << " layer " << layer;
                           ++count;
                       });
    EXPECT_GT(count, 20u);
}

INSTANTIATE_TEST_SUITE_P(Cases, PlateOverWater, testing::Combine(testing::Bool(), testing::Bool()),
                         [](const auto& test)
                         {
                             return std::string(std::get<0>(test.param) ? "In2D" : "In3D") +
                                    (std::get<1>(test.param) ? "Moving" : "Fixed");
                         });

/// The surface of a shape in 2D goes on across the plane of the case, where no fluid comes.
TEST(BlockOverWaterIn2D, LooksOutEverywhere)
{
    const ParticleCloud cloud = make(body_in_tank(solid({-0.5, -0.4, 0.5}, {0.5, 0.4, 1.1}), true));
    const std::size_t count = for_each_in_layers(cloud, body_mk,
                                                 [](const Vec3& p, int layer, const Vec3& n)
                                                 {
                                                     if (layer != 1) return;
                                                     EXPECT_NEAR(norm(n), 0.5, 1e-3)
                                                         << p.x << ' ' << p.z;
                                                 });
    EXPECT_GT(count, 100u);
}

/// The way of the fluid is looked for in coarse cells where there are very many nodes.
TEST(LayerNormals, AreTheSameInADomainThatIsMostlyEmpty)
{
    const std::string plate = solid({-0.6, -0.4, 0.15}, {0.6, 0.4, 0.25});
    CaseText text = body_in_tank(plate, false);
    const ParticleCloud small = make(text);
    text.pointmax = R"(<pointmax x="60" y="40" z="45" />)";
    const ParticleCloud large = make(text);
    EXPECT_EQ(small.positions, large.positions);
    EXPECT_EQ(small.normals, large.normals);
}

} // namespace
