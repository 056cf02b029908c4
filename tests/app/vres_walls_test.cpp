// Body-fitted walls in cases with regions of other resolution (<vres>); FPPG_PROGRAM is the
// program's path.

#include "fppg/read_particles.h"

#include "helpers/bi4_array.h"
#include "helpers/case_text.h"
#include "helpers/run_fppg.h"

#include <gtest/gtest.h>

#include <fmt/format.h>

#include <cmath>
#include <numbers>

namespace
{

using fppg::ParticleCloud;
using fppg::Vec3;
using namespace fppg::test;

constexpr double dp = 0.1;
/// Where zone 0 ends and zone 1 begins, along x: the width of a buffer is two smoothing lengths of
/// its zone, inside the border at x = 0 and outside of it.
const double buffer = 2 * std::sqrt(3.0) * dp;

/// A ball of radius 1, half in a region of half the dp.
CaseText ball_in_two_zones(const std::string& fitted, const std::string& after = "")
{
    CaseText text;
    text.dp = fmt::format("{}", dp);
    text.pointmin = R"(<pointmin x="-1.6" y="-2.4" z="-2.4" />)";
    text.pointmax = R"(<pointmax x="2.6" y="2.4" z="2.4" />)";
    text.mainlist =
        R"(<setdrawmode mode="full" /><setmkbound mk="0" /><drawsphere radius="1"><point x="0" y="0" z="0" /></drawsphere>)";
    text.after_geometry = fmt::format(
        R"({}<vres active="true"><buffsizeh v="2" /><bufferbox><point x="0" y="-1.5" z="-1.5" /><size x="1.8" y="3" z="3" /><dpratio v="2" />{}</bufferbox></vres>)",
        fitted, after);
    text.execution =
        R"(<parameters><parameter key="Boundary" value="2" /><parameter key="SlipMode" value="2" /><parameter key="NoPenetration" value="1" /></parameters>)";
    return text;
}

struct Zones
{
    RunResult result;
    std::array<ParticleCloud, 2> clouds;
    std::array<std::vector<float>, 2> normals;
};

Zones make(const CaseText& text)
{
    const TemporaryFolder folder;
    write_text(folder / "Case_Def.xml", text.text());
    Zones out{run(folder, {"Case_Def", "out/Case", "-save:all"}), {}, {}};
    EXPECT_EQ(out.result.code, 0) << out.result.output;
    for (std::size_t z = 0; z < 2 && out.result.code == 0; ++z)
    {
        const std::string name = folder / fmt::format("out/Case_vres{:02}", z);
        out.clouds[z] = fppg::read_particles(name, true, 1);
        out.normals[z] = bi4_array<float>(read_text(fmt::format("{}.bi4", name)), "BoundNor");
    }
    return out;
}

/// Particles at a distance from the middle of the ball.
std::vector<Vec3> at_radius(const ParticleCloud& cloud, double radius)
{
    std::vector<Vec3> out;
    for (const Vec3& p : cloud.positions)
        if (std::abs(norm(p) - radius) < 1e-3) out.push_back(p);
    return out;
}

/// The part of a sphere from x = low to high has a particle per dp^2, none of them elsewhere, and
/// no hole.
void expect_covered(const std::vector<Vec3>& points, double radius, double spacing, double low,
                    double high)
{
    double begin = 1e9;
    double end = -1e9;
    for (const Vec3& p : points)
    {
        begin = std::min(begin, p.x);
        end = std::max(end, p.x);
    }
    EXPECT_NEAR(begin, std::max(low, -radius), 0.8 * spacing);
    // A buffer ends at the node behind its width.
    EXPECT_NEAR(end, std::min(high, radius), 1.1 * spacing);
    const double area = 2 * std::numbers::pi * radius * (end - begin);
    EXPECT_NEAR(static_cast<double>(points.size()) * spacing * spacing / area, 1, 0.06);
    const int steps = 60;
    for (int i = 0; i < steps; ++i)
        for (int j = 0; j < steps; ++j)
        {
            const double x = radius * (2 * (i + 0.5) / steps - 1);
            if (x < low + spacing || x > high - spacing) continue;
            const double angle = 2 * std::numbers::pi * j / steps;
            const double r = std::sqrt(radius * radius - x * x);
            const Vec3 p{x, r * std::cos(angle), r * std::sin(angle)};
            double nearest = 1e9;
            for (const Vec3& q : points) nearest = std::min(nearest, norm(q - p));
            EXPECT_LT(nearest, 0.9 * spacing) << x << ' ' << p.y << ' ' << p.z;
        }
}

} // namespace

TEST(VresWalls, StandOnTheSurfaceInEachZoneWithItsSpacing)
{
    const Zones zones =
        make(ball_in_two_zones("<fppg><bodyfitted boundary=\"dbc\" layers=\"1\" /></fppg>"));
    expect_covered(at_radius(zones.clouds[0], 1), 1, dp, -2, buffer);
    expect_covered(at_radius(zones.clouds[1], 1), 1, dp / 2, -buffer / 2, 2);
}

TEST(VresWalls, HaveLayersWithNormalsInBuffersToo)
{
    const Zones zones = make(ball_in_two_zones("<fppg><bodyfitted boundary=\"mdbc\" /></fppg>"));
    for (std::size_t z = 0; z < 2; ++z)
    {
        const double spacing = z == 0 ? dp : dp / 2;
        const double low = z == 0 ? -2 : -buffer / 2;
        const double high = z == 0 ? buffer : 2;
        for (const double depth : {0.5, 1.5, 2.5})
            expect_covered(at_radius(zones.clouds[z], 1 - depth * spacing), 1 - depth * spacing,
                           spacing, low, high);
        const ParticleCloud& cloud = zones.clouds[z];
        ASSERT_EQ(zones.normals[z].size(), 3 * cloud.positions.size());
        for (std::size_t i = 0; i < cloud.positions.size(); ++i)
        {
            const double depth = 1 - norm(cloud.positions[i]);
            if (depth > 2.6 * spacing) continue;
            const float* n = &zones.normals[z][3 * i];
            EXPECT_NEAR(norm(Vec3{n[0], n[1], n[2]}), depth, 1e-3 * spacing);
        }
    }
}

TEST(VresWalls, StandInTurnedRegions)
{
    const Zones zones = make(ball_in_two_zones(
        "<fppg><bodyfitted boundary=\"dbc\" layers=\"1\" /></fppg>",
        R"(<transform><rotate angx="90" angy="0" angz="0" anglesunits="degrees" /></transform>)"));
    expect_covered(at_radius(zones.clouds[0], 1), 1, dp, -2, buffer);
    expect_covered(at_radius(zones.clouds[1], 1), 1, dp / 2, -buffer / 2, 2);
}

namespace
{

/// A tank in 2D with a rod in it, and a region of half the dp round that, which begins at a height.
CaseText tank_with_region(const std::string& boundary, double bottom, const std::string& fitted)
{
    CaseText text;
    text.dp = "0.02";
    text.pointmin = R"(<pointmin x="-0.2" y="0" z="-0.2" />)";
    text.pointmax = R"(<pointmax x="1.5" y="0" z="0.9" />)";
    text.mainlist =
        R"(<setdrawmode mode="full" /><setmkbound mk="0" /><drawbox><boxfill>solid</boxfill><point x="-0.08" y="-1" z="-0.16" /><size x="1.46" y="2" z="0.784" /></drawbox>
<setmkvoid /><drawbox><boxfill>solid</boxfill><point x="0" y="-1" z="0" /><size x="1.3" y="2" z="0.8" /></drawbox>
<setmkfluid mk="0" /><drawbox><boxfill>solid</boxfill><point x="0.01" y="-1" z="0.02" /><size x="1.28" y="2" z="0.346654" /></drawbox>
<setmkbound mk="1" /><drawcylinder radius="0.07"><point x="0.5" y="-1" z="0.193854" /><point x="0.5" y="1" z="0.193854" /></drawcylinder>)";
    text.after_geometry = fmt::format(
        R"({}<vres active="true"><buffsizeh v="2" /><bufferbox><point x="0.29" y="0" z="{}" /><endpoint x="0.71" y="0" z="0.4039" /><dpratio v="2" /></bufferbox></vres>)",
        fitted, bottom);
    text.execution = fmt::format(
        R"(<parameters><parameter key="Boundary" value="{}" /><parameter key="SlipMode" value="2" /><parameter key="NoPenetration" value="1" /></parameters>)",
        boundary);
    return text;
}

} // namespace

/// The solver v5.4 stops at walls in buffers: at all of dynamic boundaries, at those of modified
/// ones that have no normal. Under the layers nodes of a thick floor had none.
TEST(VresWalls, InBuffersHaveNormalsOrAreWarnedOf)
{
    const std::string said = "in buffers of <vres>";
    const std::string fitted = "<fppg><bodyfitted /></fppg>";
    const Zones made = make(tank_with_region("2", -0.1, fitted));
    EXPECT_FALSE(contains(made.result.output, said)) << made.result.output;
    std::size_t deep = 0;
    for (std::size_t i = 0; i < made.normals[1].size() / 3; ++i)
    {
        const float* n = &made.normals[1][3 * i];
        const Vec3& p = made.clouds[1].positions[i];
        if (p.z > -0.05 || (p.x > 0.28 && p.x < 0.72)) continue;
        ++deep;
        EXPECT_NEAR(n[2], -p.z, 1e-4);
    }
    EXPECT_GT(deep, 10u);
    EXPECT_TRUE(contains(make(tank_with_region("1", -0.1, fitted)).result.output, said));
    EXPECT_TRUE(contains(make(tank_with_region("2", -0.1, "")).result.output, said));
    EXPECT_FALSE(contains(make(tank_with_region("1", 0.04, fitted)).result.output, said));
}

/// Beside buffers fluid stays on the lattice, here half a dp farther off the floor than it is at
/// rest. What is missing there was put in between: 24 particles too many.
TEST(VresWalls, HaveAsMuchFluidBetweenBuffersAsFits)
{
    constexpr double spacing = 0.01, radius = 0.07;
    const Zones made = make(tank_with_region(
        "2", -0.0161,
        R"(<fppg><bodyfitted /></fppg><floatings><floating mkbound="1" rhopbody="1000" /></floatings>)"));
    fppg::Box3 box;
    double count = 0;
    const ParticleCloud& cloud = made.clouds[1];
    for (std::size_t i = 0; i < cloud.positions.size(); ++i)
    {
        if (cloud.mk[i] >= 10) continue; // mkbound 0
        box.add(cloud.positions[i]);
        ++count;
    }
    EXPECT_NEAR(box.min.z, spacing, 1e-9);
    const double area = (box.max.x - box.min.x + spacing) * (box.max.z - box.min.z + spacing) -
                        std::numbers::pi * radius * radius;
    EXPECT_NEAR(count, area / (spacing * spacing), 6);
}
