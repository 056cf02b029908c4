// Water at rest beside fitted walls, judged by the sums of the solver over the particles of
// Case.bi4.

#include "balance/made_case.h"

#include "helpers/run_fppg.h"

#include <gtest/gtest.h>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <numbers>
#include <numeric>

namespace
{

using namespace fppg::test;
using fppg::ParticleCloud;
using fppg::Vec3;

constexpr double dp = 0.1;
constexpr double h = 1.7320508075688772 * dp;

/// An open tank of 1.65 x 1.45 x 1 m, its walls sheets, with water 0.8 m deep up to where a box
/// of this size along x from x = -0.2 ends.
CaseText tank(const std::string& fppg, const std::string& water_size = "2.2")
{
    CaseText text;
    text.pointmin = R"(<pointmin x="-0.3" y="-0.3" z="-0.3" />)";
    text.pointmax = R"(<pointmax x="1.95" y="1.75" z="1.3" />)";
    text.mainlist = R"(<setdrawmode mode="full" />
<setmkbound mk="0" /><drawbox><boxfill>bottom | left | right | front | back</boxfill><point x="0" y="0" z="0" /><size x="1.65" y="1.45" z="1" /></drawbox>
<setmkfluid mk="0" /><fillbox x="0.4" y="0.7" z="0.4"><modefill>void</modefill><point x="-0.2" y="-0.2" z="-0.2" /><size x=")" +
                    water_size + R"(" y="2" z="1.05" /></fillbox>)";
    text.after_geometry = "<fppg>" + fppg + "</fppg>";
    return text;
}

/// What gravity is in these cases.
constexpr double g = 9.81;

/// Accelerations of the fluid over gravity, as the solver with dynamic boundaries sums them; of the
/// two highest rows along the surface only, as they draw together in every lattice.
std::vector<double> accelerations(const MadeCase& r, double b)
{
    std::vector<double> out;
    const auto pressure = [&](std::size_t i)
    { return b * (std::pow(double{r.densities[i]} / 1000, 7) - 1); };
    const double mass = 1000 * dp * dp * dp;
    const double factor = -5 * 21 / (16 * std::numbers::pi) / (h * h * h * h * h);
    const std::vector<Vec3>& at = r.cloud.positions;
    double highest = 0;
    for (std::size_t i = 0; i < at.size(); ++i)
        if (r.cloud.mk[i] < first_bound) highest = std::max(highest, at[i].z);
    for (std::size_t i = 0; i < at.size(); ++i)
    {
        if (r.cloud.mk[i] >= first_bound) continue;
        Vec3 a{0, 0, -g};
        for (std::size_t j = 0; j < at.size(); ++j)
        {
            const Vec3 away = at[i] - at[j];
            const double q = norm(away) / h;
            if (j == i || q >= 2) continue;
            a = a - mass * (pressure(i) + pressure(j)) /
                        (double{r.densities[i]} * double{r.densities[j]}) * factor *
                        std::pow(1 - q / 2, 3) * away;
        }
        if (at[i].z > highest - 1.5 * dp) a.z = 0;
        out.push_back(norm(a) / g);
    }
    std::sort(out.begin(), out.end());
    return out;
}

/// Of a particle of a 2D case with coefh 1, in m/s^2, as the solver with dynamic boundaries sums
/// it.
Vec3 acceleration_2d(const MadeCase& r, double b, std::size_t i)
{
    const double h_2d = std::numbers::sqrt2 * dp;
    const auto pressure = [&](std::size_t k)
    { return b * (std::pow(double{r.densities[k]} / 1000, 7) - 1); };
    const double factor = -5 * 7 / (4 * std::numbers::pi) / std::pow(h_2d, 4);
    Vec3 a{0, 0, -g};
    for (std::size_t j = 0; j < r.cloud.positions.size(); ++j)
    {
        const Vec3 away = r.cloud.positions[i] - r.cloud.positions[j];
        const double q = norm(away) / h_2d;
        if (j == i || q >= 2) continue;
        a = a - 1000 * dp * dp * (pressure(i) + pressure(j)) /
                    (double{r.densities[i]} * double{r.densities[j]}) * factor *
                    std::pow(1 - q / 2, 3) * away;
    }
    return a;
}

/// A case whose walls are fitted, its fluid balanced on its lattice or left even.
ParticleCloud fitted(CaseText text, bool is_balanced)
{
    const TemporaryFolder folder;
    text.after_geometry = fmt::format(
        R"(<fppg><bodyfitted /><fluidband balance="{}" packing="cubic" /></fppg>)", is_balanced);
    return make(folder, text).cloud;
}

double distance_to_fluid(const ParticleCloud& cloud, const Vec3& p)
{
    double out = 1e9;
    for (std::size_t i = 0; i < cloud.positions.size(); ++i)
        if (cloud.mk[i] < first_bound) out = std::min(out, norm(cloud.positions[i] - p));
    return out;
}

double mean_of(const std::vector<double>& values)
{
    return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

double b_of(const TemporaryFolder& folder)
{
    const std::string xml = read_text(folder / "out/Case.xml");
    const std::size_t at = xml.find("<b value=\"");
    return std::stod(xml.substr(at + 10));
}

} // namespace

TEST(Balance, WaterBesideFittedWallsStartsAtRest)
{
    const TemporaryFolder folder;
    CaseText text = tank(R"(<bodyfitted layers="3" /><fluidband />)");
    const MadeCase even =
        make(folder, tank(R"(<bodyfitted layers="3" /><fluidband balance="false" />)"));
    const std::vector<double> before = accelerations(even, b_of(folder));
    const MadeCase calm = make(folder, text);
    EXPECT_TRUE(contains(calm.output, "Balanced fluid")) << calm.output;
    const std::vector<double> after = accelerations(calm, b_of(folder));
    ASSERT_EQ(after.size(), before.size());
    EXPECT_GT(mean_of(before), 0.05);
    EXPECT_LT(mean_of(after), mean_of(before) / 5);
    EXPECT_LT(mean_of(after), 0.02);
    EXPECT_LT(after[after.size() / 2], 0.01);
    EXPECT_LT(after[after.size() * 9 / 10], 0.05);
}

/// A lattice at the pressures of its depth falls by a hundredth of g. Fluid beside walls was held
/// at rest against that: its columns slid along those of the lattice by 0.01 to 0.02 g.
TEST(Balance, WaterBesideFlatWallsFallsAsTheLatticeDoes)
{
    const TemporaryFolder folder;
    CaseText text;
    text.pointmin = R"(<pointmin x="-0.6" y="0" z="-0.6" />)";
    text.pointmax = R"(<pointmax x="3" y="0" z="4.6" />)";
    text.mainlist =
        R"(<setdrawmode mode="full" /><setmkbound mk="0" />)" +
        box_command(R"(x="-0.4" y="-1" z="-0.4")", R"(x="3.2" y="2" z="4.8")") + "<setmkvoid />" +
        box_command(R"(x="0" y="-1" z="0")", R"(x="2.4" y="2" z="5")") +
        R"(<setmkfluid mk="0" />)" + box_command(R"(x="0" y="-1" z="0")", R"(x="2.4" y="2" z="4")");
    text.after_geometry = R"(<fppg><bodyfitted /><fluidband packing="cubic" /></fppg>)";
    const MadeCase calm = make(folder, text);
    const double b = b_of(folder);
    const auto falls = [&](double from, double to)
    {
        double sum = 0;
        int count = 0;
        for (std::size_t i = 0; i < calm.cloud.positions.size(); ++i)
        {
            const Vec3& p = calm.cloud.positions[i];
            if (calm.cloud.mk[i] >= first_bound || p.x < from || p.x > to || p.z < 0.95 ||
                p.z > 3.05)
                continue;
            sum += acceleration_2d(calm, b, i).z / g;
            ++count;
        }
        EXPECT_GT(count, 19);
        return sum / count;
    };
    const double in_the_middle = falls(1, 1.4);
    EXPECT_LT(in_the_middle, -0.003);
    EXPECT_NEAR(falls(0.05, 0.15), in_the_middle, 0.002);
    EXPECT_NEAR(falls(0.15, 0.25), in_the_middle, 0.002);
    EXPECT_NEAR(falls(2.25, 2.35), in_the_middle, 0.002);
}

/// Rows that balancing goes on with lose their order, and what comes to rest in the end moves in
/// the solver: here the mean acceleration rose from 0.002 to 0.04 g, and fell below 0.002 again
/// after particles had moved by a quarter of dp.
TEST(Balance, RowsOfTheLatticeStayInOrder)
{
    CaseText text;
    const std::string coefh = R"(<coefh value="1" />)";
    text.constants.replace(text.constants.find(coefh), coefh.size(), R"(<coefh value="1.2" />)");
    text.execution =
        R"(<parameters><parameter key="Boundary" value="2" /><parameter key="SlipMode" value="2" /><parameter key="NoPenetration" value="1" /></parameters>)";
    text.pointmin = R"(<pointmin x="-0.8" y="0" z="-0.8" />)";
    text.pointmax = R"(<pointmax x="4.83" y="0" z="6.6" />)";
    text.mainlist = R"(<setdrawmode mode="full" /><setmkbound mk="0" />)" +
                    box_command(R"(x="-0.37" y="-1" z="-0.37")", R"(x="4.83" y="2" z="6.2")") +
                    "<setmkvoid />" +
                    box_command(R"(x="0.03" y="-1" z="0.03")", R"(x="4.03" y="2" z="6")") +
                    R"(<setmkfluid mk="0" />)" +
                    box_command(R"(x="0.03" y="-1" z="0.03")", R"(x="4.03" y="2" z="5")");
    const ParticleCloud even = fitted(text, false);
    const ParticleCloud calm = fitted(text, true);
    double sum = 0;
    std::size_t count = 0;
    for (std::size_t i = 0; i < even.positions.size(); ++i)
    {
        const Vec3& p = even.positions[i];
        if (even.mk[i] >= first_bound || (p.x > 0.6 && p.x < 3.5 && p.z > 0.6)) continue;
        sum += distance_to_fluid(calm, p);
        ++count;
    }
    EXPECT_GT(count, 700);
    EXPECT_LT(sum / static_cast<double>(count), 0.03 * dp);
}

/// Where a step that does not fit the lattice has moved the fluid beside it off that, fluid farther
/// off moves along: else the two slid along one another. What falls through the air stays.
TEST(Balance, FluidFartherFromWallsMovesAlongAndWhatFallsStays)
{
    CaseText text;
    text.pointmin = R"(<pointmin x="-0.6" y="0" z="-0.6" />)";
    text.pointmax = R"(<pointmax x="4.6" y="0" z="6.6" />)";
    text.mainlist =
        R"(<setdrawmode mode="full" /><setmkbound mk="0" />)" +
        box_command(R"(x="-0.4" y="-1" z="-0.4")", R"(x="4.8" y="2" z="6.4")") + "<setmkvoid />" +
        box_command(R"(x="0" y="-1" z="0")", R"(x="4" y="2" z="6.5")") +
        R"(<setmkfluid mk="0" />)" + box_command(R"(x="0" y="-1" z="0")", R"(x="4" y="2" z="3")") +
        box_command(R"(x="1.8" y="-1" z="4.5")", R"(x="0.6" y="2" z="0.6")") +
        R"(<setmkbound mk="0" />)" +
        box_command(R"(x="0" y="-1" z="0")", R"(x="1.54" y="2" z="1.27")");
    const ParticleCloud even = fitted(text, false);
    const ParticleCloud calm = fitted(text, true);
    double farthest = 0;
    int in_the_air = 0;
    for (std::size_t i = 0; i < even.positions.size(); ++i)
    {
        const Vec3& p = even.positions[i];
        if (even.mk[i] >= first_bound) continue;
        const double off = distance_to_fluid(calm, p);
        if (p.z > 4)
        {
            ++in_the_air;
            EXPECT_LT(off, 1e-6) << p.x << ' ' << p.z;
        }
        else if (p.x > 2.4 && p.x < 3.3 && p.z > 0.7 && p.z < 2.6)
            farthest = std::max(farthest, off);
    }
    EXPECT_GT(in_the_air, 30);
    EXPECT_GT(farthest, 0.1 * dp);
}

/// Its walls are 3 to 4 dp thick here. Where the lattice stood a whole dp off its sides, this water
/// was not at rest at 0.0124 to 0.013 m, and a tenth of the walls was missing.
TEST(Balance, TheWaterOfCasesRestStartsAtRestAtOtherDistancesToo)
{
    const TemporaryFolder folder;
    const std::filesystem::path rest = std::filesystem::path(FPPG_CASES) / "rest";
    for (const char* name : {"basin.stl", "CaseRest_Def.xml"})
        std::filesystem::copy(rest / name, folder.path() / name);
    for (const char* distance : {"0.0124", "0.0125", "0.0127", "0.013"})
    {
        const RunResult result =
            run(folder, {"CaseRest_Def", "out/Case", fmt::format("-dp:{}", distance)});
        EXPECT_EQ(result.code, 0) << result.output;
        EXPECT_TRUE(contains(result.output, "Balanced fluid")) << distance;
        EXPECT_FALSE(contains(result.output, "do not have the volume of their solids")) << distance;
    }
}

TEST(Balance, DensitiesAreThoseOfTheDepthBelowTheSurface)
{
    const TemporaryFolder folder;
    const MadeCase calm = make(folder, tank(R"(<bodyfitted layers="3" />)"));
    const double b = b_of(folder);
    double top = 0;
    for (std::size_t i = 0; i < calm.cloud.positions.size(); ++i)
        if (calm.cloud.mk[i] < first_bound) top = std::max(top, calm.cloud.positions[i].z);
    const auto of_depth = [&](double depth)
    { return 1000 * std::pow(1 + 1000 * g * std::max(0.0, depth) / b, 1.0 / 7); };
    // Nodes stand from z = 0.1 to 0.8, so the surface is at 0.85.
    int walls = 0;
    for (std::size_t i = 0; i < calm.cloud.positions.size(); ++i)
    {
        const Vec3& p = calm.cloud.positions[i];
        const bool is_wall = calm.cloud.mk[i] >= first_bound;
        if (is_wall && distance_to_fluid(calm.cloud, p) > 2 * h) continue;
        EXPECT_NEAR(calm.densities[i], of_depth(0.85 - p.z), 2e-3)
            << p.x << ' ' << p.y << ' ' << p.z;
        if (is_wall && p.z < 0.8) ++walls;
    }
    EXPECT_GT(walls, 500);
    EXPECT_LT(top, 0.85);
}

TEST(Balance, FluidThatIsMeantToFallStaysAsItIs)
{
    const TemporaryFolder folder;
    const MadeCase even =
        make(folder, tank(R"(<bodyfitted layers="3" /><fluidband balance="false" />)", "1.05"));
    const MadeCase dam = make(folder, tank(R"(<bodyfitted layers="3" /><fluidband />)", "1.05"));
    EXPECT_TRUE(contains(dam.output, "at free faces")) << dam.output;
    ASSERT_EQ(dam.cloud.positions.size(), even.cloud.positions.size());
    int face = 0;
    int moved = 0;
    for (std::size_t i = 0; i < even.cloud.positions.size(); ++i)
    {
        if (even.cloud.mk[i] >= first_bound) continue;
        const double distance = norm(even.cloud.positions[i] - dam.cloud.positions[i]);
        if (even.cloud.positions[i].x > 0.8 - 2 * h && even.cloud.positions[i].z < 0.6)
        {
            ++face;
            EXPECT_EQ(distance, 0);
        }
        moved += distance > 0 ? 1 : 0;
    }
    EXPECT_GT(face, 100);
    EXPECT_GT(moved, 100);
}

/// Where water 0.85 m deep meets water 0.35 m deep it starts to move; all else is at rest.
TEST(Balance, ADamOverAWetBedIsHeldWhereItsDepthsMeet)
{
    const TemporaryFolder folder;
    const auto with_bed = [](const std::string& band)
    {
        CaseText text = tank(R"(<bodyfitted layers="3" />)" + band, "1.05");
        text.mainlist +=
            R"(<fillbox x="1.2" y="0.7" z="0.2"><modefill>void</modefill><point x="0.8" y="-0.2" z="-0.2" /><size x="1.2" y="2" z="0.55" /></fillbox>)";
        return text;
    };
    const MadeCase even = make(folder, with_bed(R"(<fluidband balance="false" />)"));
    const MadeCase dam = make(folder, with_bed("<fluidband />"));
    EXPECT_TRUE(contains(dam.output, "Balanced fluid")) << dam.output;
    EXPECT_TRUE(contains(dam.output, "where one depth meets another")) << dam.output;
    ASSERT_EQ(dam.cloud.positions.size(), even.cloud.positions.size());
    int held = 0;
    int moved = 0;
    for (std::size_t i = 0; i < even.cloud.positions.size(); ++i)
    {
        if (even.cloud.mk[i] >= first_bound) continue;
        const Vec3& p = even.cloud.positions[i];
        const double distance = norm(p - dam.cloud.positions[i]);
        moved += distance > 0 ? 1 : 0;
        if (std::abs(p.x - 0.85) > h || p.z > 0.3) continue;
        ++held;
        EXPECT_EQ(distance, 0) << p.x << ' ' << p.y << ' ' << p.z;
    }
    EXPECT_GT(held, 90);
    EXPECT_GT(moved, 300);
}

TEST(Balance, OnlyPlacesAndDensitiesChangeAndThreadsDoNotMatter)
{
    const TemporaryFolder folder;
    const MadeCase even =
        make(folder, tank(R"(<bodyfitted layers="3" /><fluidband balance="false" />)"));
    const std::string banded = R"(<bodyfitted layers="3" /><fluidband packing="cubic" />)";
    const MadeCase calm = make(folder, tank(banded), {"-threads:1"});
    ASSERT_EQ(calm.cloud.mk, even.cloud.mk);
    for (std::size_t i = 0; i < calm.cloud.positions.size(); ++i)
        EXPECT_LE(norm(calm.cloud.positions[i] - even.cloud.positions[i]), 1.0001 * dp);
    const std::string one = read_text(folder / "out/Case.bi4");
    make(folder, tank(banded), {"-threads:8"});
    EXPECT_EQ(read_text(folder / "out/Case.bi4"), one);
}

TEST(Balance, NothingIsDoneWithoutFittedWallsGravityOrDepths)
{
    const TemporaryFolder folder;
    const MadeCase lattice = make(folder, tank(R"(<bodyfitted layers="3" />)"), {"-fit:off"});
    EXPECT_FALSE(contains(lattice.output, "Balance"));
    EXPECT_EQ(lattice.densities.front(), 1000);
    CaseText weightless = tank(R"(<bodyfitted layers="3" />)");
    weightless.gravity = R"(<gravity x="0" y="0" z="0" />)";
    EXPECT_FALSE(contains(make(folder, weightless).output, "Balance"));
    CaseText uniform = tank(R"(<bodyfitted layers="3" />)");
    uniform.rhopgradient = R"(<rhopgradient value="1" />)";
    EXPECT_FALSE(contains(make(folder, uniform).output, "Balance"));
    EXPECT_FALSE(contains(
        make(folder, tank(R"(<bodyfitted layers="3" /><fluidband active="false" />)")).output,
        "Balance"));
}

TEST(Balance, NothingIsDoneWhereTheEquationOfStateHasNoStiffness)
{
    const TemporaryFolder folder;
    CaseText text = tank(R"(<bodyfitted layers="3" />)");
    text.constants =
        R"(<rhop0 value="1000" /><hswl value="0" /><gamma value="7" /><coefsound value="20" /><coefh value="1" /><cflnumber value="0.2" />)";
    const MadeCase made = make(folder, text);
    EXPECT_TRUE(contains(made.output, "Constant B is zero"));
    EXPECT_TRUE(contains(made.output, "Balance: left out, as constant B"));
    EXPECT_EQ(*std::min_element(made.densities.begin(), made.densities.end()), 1000);
    EXPECT_EQ(*std::max_element(made.densities.begin(), made.densities.end()), 1000);
}

TEST(Balance, WaterUnderARoofHasThePressureOfTheOpenSurface)
{
    const TemporaryFolder folder;
    // A plate of 0.3 m in the water, its underside at z = 0.35.
    CaseText text = tank(R"(<bodyfitted layers="3" />)");
    const std::size_t fill = text.mainlist.find("<setmkfluid");
    text.mainlist.insert(
        fill, R"(<setmkbound mk="1" /><drawbox><boxfill>solid</boxfill>)"
              R"(<point x="0.5" y="0.4" z="0.35" /><size x="0.6" y="0.6" z="0.3" /></drawbox>)");
    const MadeCase calm = make(folder, text);
    const double b = b_of(folder);
    int under = 0;
    for (std::size_t i = 0; i < calm.cloud.positions.size(); ++i)
    {
        const Vec3& p = calm.cloud.positions[i];
        if (calm.cloud.mk[i] >= first_bound || p.z > 0.3 || std::abs(p.x - 0.8) > 0.2 ||
            std::abs(p.y - 0.7) > 0.2)
            continue;
        ++under;
        EXPECT_NEAR(calm.densities[i], 1000 * std::pow(1 + 1000 * g * (0.85 - p.z) / b, 1.0 / 7),
                    2e-3)
            << p.x << ' ' << p.y << ' ' << p.z;
    }
    EXPECT_GT(under, 20);
}

/// GenCase's columns go on through floating bodies: water below one has the density of its deck.
TEST(Balance, WaterBelowAFloatingBodyHasThePressureOfTheOpenSurface)
{
    const TemporaryFolder folder;
    CaseText text = tank(R"(<bodyfitted layers="3" />)");
    const std::size_t at = text.mainlist.find(R"(<setmkfluid mk="0" />)");
    text.mainlist.insert(
        at,
        R"(<setmkbound mk="1" /><drawbox><boxfill>solid</boxfill><point x="0.53" y="0.42" z="0.45" /><size x="0.6" y="0.6" z="0.7" /></drawbox>)");
    text.after_geometry += R"(<floatings><floating mkbound="1" rhopbody="500" /></floatings>)";
    const MadeCase r = make(folder, text);
    EXPECT_TRUE(contains(r.output, "Balanced fluid")) << r.output;
    const double b = b_of(folder);
    std::size_t below = 0;
    for (std::size_t i = 0; i < r.cloud.positions.size(); ++i)
    {
        if (r.cloud.mk[i] >= first_bound) continue;
        const Vec3& p = r.cloud.positions[i];
        const double depth = b * (std::pow(double{r.densities[i]} / 1000, 7) - 1) / (1000 * g);
        // Half a dp above the highest node of the water, at 0.8 m.
        EXPECT_NEAR(p.z + depth, 0.85, 0.02 * dp) << p.x << ' ' << p.y << ' ' << p.z;
        below += p.z < 0.45 && std::abs(p.x - 0.83) < 0.25 && std::abs(p.y - 0.72) < 0.25 ? 1 : 0;
    }
    EXPECT_GT(below, 20u);
}

/// The first particles of floating bodies stand half a dp inside; held half a dp off the surface as
/// well, water was pressed towards them.
TEST(Balance, DeepWaterBesideAFloatingBodyStartsAtRest)
{
    const TemporaryFolder folder;
    CaseText text;
    text.pointmin = R"(<pointmin x="-0.5" y="0" z="-0.5" />)";
    text.pointmax = R"(<pointmax x="3.5" y="0" z="5" />)";
    text.mainlist = R"(<setdrawmode mode="full" />
<setmkfluid mk="0" /><drawbox><boxfill>solid</boxfill><point x="0" y="-1" z="0" /><size x="3" y="2" z="4" /></drawbox>
<setmkbound mk="0" /><drawbox><boxfill>all ^ top</boxfill><point x="0" y="-1" z="0" /><size x="3" y="2" z="4.5" /></drawbox>
<setmkbound mk="1" /><drawbox><boxfill>solid</boxfill><point x="1.13" y="-1" z="0.97" /><size x="0.8" y="2" z="0.6" /></drawbox>)";
    text.after_geometry =
        R"(<floatings><floating mkbound="1" rhopbody="500" /></floatings><fppg><bodyfitted /></fppg>)";
    const MadeCase r = make(folder, text);
    ASSERT_TRUE(contains(r.output, "Balanced fluid")) << r.output;
    const double b = b_of(folder);
    std::vector<double> near;
    for (std::size_t i = 0; i < r.cloud.positions.size(); ++i)
    {
        const Vec3& p = r.cloud.positions[i];
        const double off = std::max(std::abs(p.x - 1.53) - 0.4, std::abs(p.z - 1.27) - 0.3);
        if (r.cloud.mk[i] < first_bound && off < 1.5 * dp)
            near.push_back(norm(acceleration_2d(r, b, i)) / g);
    }
    ASSERT_GT(near.size(), 30u);
    EXPECT_LT(mean_of(near), 0.02);
    EXPECT_LT(*std::max_element(near.begin(), near.end()), 0.1);
}

TEST(Balance, NumberOfFluidThatFitsIsWarnedOfWithABandOrWithout)
{
    const TemporaryFolder folder;
    const auto count = [](const MadeCase& r)
    {
        return std::count_if(r.cloud.mk.begin(), r.cloud.mk.end(),
                             [](std::uint16_t mk) { return mk < first_bound; });
    };
    const auto on_nodes =
        count(make(folder, tank(R"(<bodyfitted layers="3" /><fluidband active="false" />)")));
    for (const char* band : {"", "<fluidband />"})
    {
        const MadeCase made =
            make(folder, tank(R"(<bodyfitted layers="3" />)" + std::string(band)));
        EXPECT_NE(count(made), on_nodes) << band;
        EXPECT_TRUE(contains(made.output, "litres of fills")) << made.output;
    }
}
