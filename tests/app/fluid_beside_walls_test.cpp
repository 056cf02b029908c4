// Fluid beside body-fitted walls, on the lattice, relaxed or balanced: where it stands and how it
// is numbered; FPPG_PROGRAM is the program's path.

#include "fppg/read_particles.h"

#include "helpers/case_text.h"
#include "helpers/run_fppg.h"

#include <gtest/gtest.h>

#include <fmt/format.h>

#include <algorithm>
#include <tuple>

namespace
{

using fppg::ParticleCloud;
using fppg::Vec3;
using namespace fppg::test;

constexpr double dp = 0.05;
constexpr double sphere_radius = 0.23;
const Vec3 sphere_center{0.51, 0.5, 0.45};
constexpr std::uint16_t bound_mk = 10; ///< of mkbound 0

struct Made
{
    std::string output;
    ParticleCloud cloud;
};

/// A tank with water and a solid sphere of mkbound 1 under it, with this in its <fppg> block.
Made make_sphere_in_tank(const std::string& fppg)
{
    const TemporaryFolder folder;
    CaseText text = tank();
    text.dp = fmt::format("{}", dp);
    text.mainlist += fmt::format(
        R"(<setdrawmode mode="full" /><setmkbound mk="1" /><drawsphere radius="{}"><point x="{}" y="{}" z="{}" /></drawsphere>)",
        sphere_radius, sphere_center.x, sphere_center.y, sphere_center.z);
    text.after_geometry = "<fppg>" + fppg + "</fppg>";
    write_text(folder / "Case_Def.xml", text.text());
    const RunResult result = run(folder, {"Case_Def", "out/Case", "-save:all"});
    EXPECT_EQ(result.code, 0) << result.output;
    return {result.output, fppg::read_particles(folder / "out/Case", false, 1)};
}

bool is_fluid(const ParticleCloud& cloud, std::size_t i)
{
    return cloud.mk[i] < bound_mk;
}

/// Least distance from the fluid to the sphere, dp.
double nearest_fluid_dp(const ParticleCloud& cloud)
{
    double nearest = 1e9;
    std::size_t count = 0;
    for (std::size_t i = 0; i < cloud.positions.size(); ++i)
    {
        if (!is_fluid(cloud, i)) continue;
        ++count;
        nearest =
            std::min(nearest, (norm(cloud.positions[i] - sphere_center) - sphere_radius) / dp);
    }
    EXPECT_GT(count, 1000u);
    return nearest;
}

/// Particles that do not come after the one before them in their block by x, then y, then z.
std::size_t unsorted(const ParticleCloud& cloud, bool counts_fluid)
{
    std::size_t count = 0;
    for (std::size_t i = 1; i < cloud.positions.size(); ++i)
    {
        const Vec3& a = cloud.positions[i - 1];
        const Vec3& b = cloud.positions[i];
        if (cloud.mk[i] != cloud.mk[i - 1] || (is_fluid(cloud, i) && !counts_fluid)) continue;
        count += std::tie(a.x, a.y, a.z) < std::tie(b.x, b.y, b.z) ? 0 : 1;
    }
    return count;
}

TEST(FluidBesideASphere, StandsHalfAStepAwayWhereItIsNotBalanced)
{
    for (const std::string band :
         {R"(<fluidband active="false" />)", R"(<fluidband balance="false" />)"})
        EXPECT_GE(nearest_fluid_dp(make_sphere_in_tank("<bodyfitted />" + band).cloud), 0.49)
            << band;
}

/// Pressures of walls hold it at a distance; the rule is the least one.
TEST(FluidBesideASphere, StandsAFifthOfAStepAwayWhereItIsBalanced)
{
    const Made made = make_sphere_in_tank(R"(<bodyfitted layers="3" />)");
    EXPECT_TRUE(contains(made.output, "Balanced fluid: ")) << made.output;
    EXPECT_GE(nearest_fluid_dp(made.cloud), 0.2 - 1e-6);
}

/// Fluid that is balanced keeps the ids that it had.
TEST(FluidBesideASphere, IsNumberedByXThenYThenZUnlessItIsBalanced)
{
    const std::string walls = R"(<bodyfitted layers="3" />)";
    const Made even = make_sphere_in_tank(walls + R"(<fluidband balance="false" />)");
    EXPECT_EQ(unsorted(even.cloud, true), 0u);
    const Made balanced = make_sphere_in_tank(walls + "<fluidband />");
    EXPECT_EQ(unsorted(balanced.cloud, false), 0u);
    EXPECT_EQ(balanced.cloud.mk, even.cloud.mk);
}

} // namespace
