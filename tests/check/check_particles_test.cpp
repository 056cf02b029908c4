// Cases in memory, each with one fault, which must be found once and nothing else.

#include "check/layered_tank.h"
#include "fppg/check.h"

#include <gmock/gmock.h>

#include <limits>
#include <map>
#include <string>

namespace
{

using namespace fppg;
using namespace fppg::test;

/// The faults that were found, by name.
std::map<std::string, std::uint64_t> found(const CheckReport& report)
{
    std::map<std::string, std::uint64_t> out;
    for (std::size_t f = 0; f < fault_count; ++f)
        if (const std::uint64_t n = report.total(static_cast<Fault>(f)); n > 0)
            out[fault_name(static_cast<Fault>(f))] = n;
    return out;
}

using Faults = std::map<std::string, std::uint64_t>;

const CheckedMk& mk_of(const CheckReport& report, std::uint16_t mk)
{
    for (const CheckedMk& of : report.mks)
        if (of.mk == mk) return of;
    throw std::runtime_error("no such mk");
}

class CheckedTank : public testing::TestWithParam<bool>
{
protected:
    LayeredTank tank_{GetParam()};
    const double y_ = GetParam() ? 0.0 : 0.45;
};

std::string dimensions(const testing::TestParamInfo<bool>& info)
{
    return info.param ? "In2D" : "In3D";
}

} // namespace

INSTANTIATE_TEST_SUITE_P(Dimensions, CheckedTank, testing::Bool(), dimensions);

TEST_P(CheckedTank, ByLayersPasses)
{
    const CheckReport report = tank_.check();
    EXPECT_EQ(found(report), Faults{}) << to_text(report);
    EXPECT_TRUE(report.is_clean());
    const CheckedMk& wall = mk_of(report, LayeredTank::wall_mk);
    // Three layers are within 2h of the fluid in 3D, two in 2D; in edges and corners fewer.
    EXPECT_EQ(wall.near_fluid, GetParam() ? 96U : 3450U);
    EXPECT_GT(wall.front, 0U);
    EXPECT_EQ(wall.front_no_penetration, wall.front);
    EXPECT_GE(wall.mean_window, 0.75);
}

TEST_P(CheckedTank, IsJudgedAsFullThoughHalfOfItIsEmpty)
{
    const std::uint64_t near_half = mk_of(tank_.check(), LayeredTank::wall_mk).near_fluid;
    tank_.drain([](const Vec3& p) { return p.z > 0.1; });
    const CheckReport report = tank_.check();
    EXPECT_EQ(mk_of(report, LayeredTank::wall_mk).near_fluid, near_half);
    EXPECT_EQ(found(report), Faults{}) << to_text(report);
}

TEST_P(CheckedTank, IsNotFilledFromOutsideWhereFluidRunsOverItsRim)
{
    const std::uint64_t near_tank = mk_of(tank_.check(), LayeredTank::wall_mk).near_fluid;
    // A post beside the tank and higher: the box of the walls reaches over and beyond its side.
    tank_.setup.domain.max = {4, 4, 4};
    for (int k = 0; k < 22; ++k) tank_.add_wall({3.05, y_, (k - 2.5) * LayeredTank::dp}, {}, 11);
    const CheckReport report = tank_.check();
    EXPECT_EQ(found(report), Faults{}) << to_text(report);
    EXPECT_NEAR(static_cast<double>(mk_of(report, LayeredTank::wall_mk).near_fluid),
                static_cast<double>(near_tank), 0.01 * static_cast<double>(near_tank));
    // A floor beside the tank holds what runs over: its side is wet from there too.
    for (int i = 26; i <= 33; ++i)
        for (int j = 0; j < (GetParam() ? 1 : 16); ++j)
            tank_.add_wall(
                {(i - 2.5) * LayeredTank::dp, GetParam() ? 0 : (j - 2.5) * LayeredTank::dp, -0.25},
                {0, 0, 0.05}, 12);
    EXPECT_GT(mk_of(tank_.check(), 12).near_fluid, 0U);
}

TEST_P(CheckedTank, WithoutFluidIsJudgedAsFull)
{
    tank_.drain([](const Vec3&) { return true; });
    EXPECT_EQ(found(tank_.check()), Faults{}) << to_text(tank_.check());
}

TEST_P(CheckedTank, IsNotFilledWhereTheKernelIsFarLargerThanIt)
{
    for (const double h : {1000.0, 1e307})
    {
        tank_.setup.h = h;
        tank_.setup.domain = {{-9, -9, -9}, {9, 9, 9}};
        EXPECT_THAT(tank_.check().setup.notes,
                    testing::Contains(testing::HasSubstr("too large to be filled")));
    }
}

TEST_P(CheckedTank, WithoutFluidTakesNoGapInAWallForSpace)
{
    tank_.drain([](const Vec3&) { return true; });
    // Three more layers under the floor, too deep for normals; one particle is missing in them.
    const int ny = GetParam() ? 1 : 16;
    for (int i = 0; i < 26; ++i)
        for (int j = 0; j < ny; ++j)
            for (const double z : {-0.35, -0.45, -0.55})
                if (i != 13 || (ny > 1 && j != 8) || z != -0.45)
                    tank_.add_wall({(i - 2.5) * 0.1, ny > 1 ? (j - 2.5) * 0.1 : 0, z}, {});
    EXPECT_EQ(found(tank_.check()), Faults{}) << to_text(tank_.check());
}

TEST_P(CheckedTank, GivesTheSameForAnyNumberOfThreads)
{
    tank_.normal_at({1.05, y_, -0.05}) = {};
    const CheckReport one = tank_.check(1);
    const CheckReport four = tank_.check(4);
    EXPECT_EQ(to_json(one), to_json(four));
    EXPECT_EQ(to_vtk(one), to_vtk(four));
}

TEST_P(CheckedTank, FindsAMissingNormal)
{
    tank_.normal_at({1.05, y_, -0.05}) = {};
    EXPECT_EQ(found(tank_.check()), (Faults{{"no_normal", 1}}));
}

TEST_P(CheckedTank, SaysThatACaseWithoutNormalsStopsTheSolver)
{
    std::fill(tank_.particles.normals.begin(), tank_.particles.normals.end(),
              std::array<float, 3>{});
    const CheckReport report = tank_.check();
    const CheckedMk& wall = mk_of(report, LayeredTank::wall_mk);
    EXPECT_EQ(wall[Fault::NoNormal], wall.near_fluid);
    EXPECT_NE(to_text(report).find("No valid normal vectors"), std::string::npos);
}

TEST_P(CheckedTank, FindsReversedNormals)
{
    // Of the first layer: the ghost node lies in the third.
    tank_.normal_at({1.05, y_, -0.05}) = {0, 0, -0.05F};
    EXPECT_EQ(found(tank_.check()), (Faults{{"ghost_in_wall", 1}}));
}

TEST_P(CheckedTank, FindsANormalToASurfaceBeyondTheNearestFluid)
{
    // Fluid is 0.1 m from a particle of the first layer.
    tank_.normal_at({1.05, y_, -0.05}) = {0.05F, 0, 0.18F};
    EXPECT_EQ(found(tank_.check()), (Faults{}));
    tank_.normal_at({1.05, y_, -0.05}) = {0.05F, 0, 0.22F};
    EXPECT_EQ(found(tank_.check()), (Faults{{"looks_away", 1}}));
}

TEST_P(CheckedTank, FindsANormalThatLeavesTheCase)
{
    // Of the second layer: the ghost node lies beyond the third.
    tank_.normal_at({1.05, y_, -0.15}) = {0, 0, -0.15F};
    EXPECT_EQ(found(tank_.check()), (Faults{{"ghost_outside", 1}}));
    tank_.setup.domain.min.z = -2;
    EXPECT_EQ(found(tank_.check()), (Faults{{"looks_away", 1}}));
}

TEST_P(CheckedTank, FindsAGhostNodeInAnotherWall)
{
    // From the floor beside the wall at x = 0 into that wall.
    tank_.normal_at({0.05, y_, -0.05}) = {-0.1F, 0, 0.1F};
    EXPECT_EQ(found(tank_.check()), (Faults{{"ghost_in_wall", 1}}));
}

TEST_P(CheckedTank, FindsANormalThroughAPlate)
{
    // A plate of one sheet with water on both sides, served from above.
    const int ny = GetParam() ? 1 : 4;
    for (int i = 0; i < 8; ++i)
        for (int j = 0; j < ny; ++j)
            tank_.add_wall({0.65 + 0.1 * i, GetParam() ? 0 : 0.35 + 0.1 * j, 0.35}, {0, 0, 0.05},
                           11);
    tank_.drain(
        [](const Vec3& p)
        {
            return p.x > 0.6 && p.x < 1.4 && p.z > 0.3 && p.z < 0.4 &&
                   (GetParam() || (p.y > 0.3 && p.y < 0.7));
        });
    const CheckReport report = tank_.check();
    EXPECT_EQ(found(report), (Faults{{"wet_on_both_sides", static_cast<std::uint64_t>(8 * ny)}}))
        << to_text(report);
    const CheckedMk& plate = mk_of(report, 11);
    // 0.05 m to the surface above, and water 0.1 m below less half a dp.
    EXPECT_NEAR(plate.thinnest, 0.1, 1e-6);
    EXPECT_NEAR(plate.dp_needed, 0.1 / (2 * std::sqrt(GetParam() ? 2 : 3) - 0.5), 1e-6);

    tank_.normal_at({1.05, y_, -0.05}) = {0, 0, 0.3F};
    EXPECT_EQ(
        found(tank_.check()),
        (Faults{{"through_wall", 1}, {"wet_on_both_sides", static_cast<std::uint64_t>(8 * ny)}}));
}

TEST_P(CheckedTank, FindsFluidInAWallAndPairs)
{
    tank_.add_fluid({1.05, y_, -0.05 + 0.04});
    EXPECT_EQ(found(tank_.check()), (Faults{{"fluid_near_wall", 1}}));
    tank_.add_fluid({1.05, y_, 0.25 + 0.02});
    const CheckReport report = tank_.check();
    EXPECT_EQ(found(report), (Faults{{"fluid_near_wall", 1}, {"close_pair", 2}}));
    EXPECT_EQ(report.close_pairs, 1U);
    tank_.add_fluid({1.05, y_, -0.05 + 0.03 - 0.001});
    // It is next to the wall and next to the first one.
    EXPECT_EQ(tank_.check().close_pairs, 3U);
}

TEST_P(CheckedTank, TakesHalfADpForFarEnough)
{
    tank_.drain([](const Vec3& p) { return p.z < 0.1; });
    tank_.add_fluid({1.05, y_, -0.05 + 0.05});
    tank_.add_fluid({1.05, y_, -0.05 + 0.08});
    EXPECT_EQ(found(tank_.check()), Faults{});
}

TEST_P(CheckedTank, FindsParticlesOutsideTheDomain)
{
    tank_.check(); // sets the domain
    tank_.add_fluid({1.05, y_, 1.5});
    EXPECT_EQ(found(tank_.check()), (Faults{{"outside_domain", 1}}));
    tank_.add_fluid({std::numeric_limits<double>::quiet_NaN(), y_, 0.5});
    EXPECT_EQ(found(tank_.check()), (Faults{{"outside_domain", 2}}));
}

TEST_P(CheckedTank, FindsWallsTooNearToAnInletAndTheRowsBehindIt)
{
    // The first layer of the floor stands at z = -0.05.
    tank_.setup.inlets.push_back({std::nullopt, {{0.55, y_, 0.03}}, {1, 0, 0}, 3});
    EXPECT_EQ(found(tank_.check()), Faults{});
    tank_.setup.inlets.push_back({std::nullopt, {{0.55, y_, 0.01}}, {1, 0, 0}, 3});
    EXPECT_EQ(found(tank_.check()), (Faults{{"near_inlet", 3}}));
    tank_.setup.inlets = {{LayeredTank::fluid_mk, {}, {0, 0, 1}, 2}};
    // Fluid on the floor is a dp off it; the row behind it is on the wall.
    EXPECT_EQ(tank_.check().total(Fault::NearInlet), GetParam() ? 20U : 200U);
}

TEST_P(CheckedTank, SaysWhereNoPenetrationCannotAct)
{
    // Walls of one sheet on the surface, as body-fitted ones for DBC.
    for (std::size_t i = 0; i < tank_.particles.normals.size(); ++i)
    {
        auto& n = tank_.particles.normals[i];
        const double length = norm({n[0], n[1], n[2]});
        tank_.particles.positions[i] =
            tank_.particles.positions[i] + Vec3{n[0], n[1], n[2]} * (1 - 0.001 / length);
        for (float& c : n) c *= static_cast<float>(0.001 / length);
    }
    const CheckReport report = tank_.check();
    EXPECT_LT(mk_of(report, LayeredTank::wall_mk).mean_window, 0.02);
    EXPECT_NE(to_text(report).find("NoPenetration acts on"), std::string::npos);
}

TEST_P(CheckedTank, TakesPeriodicSidesAsOneSpace)
{
    // Without the walls at x = 0 and 2 the tank goes on for ever.
    LayeredTank& tank = tank_;
    CheckParticles left;
    for (std::size_t i = 0; i < tank.particles.positions.size(); ++i)
    {
        const Vec3& p = tank.particles.positions[i];
        if (p.x < 0 || p.x > 2) continue;
        left.positions.push_back(p);
        left.mk.push_back(tank.particles.mk[i]);
        left.type.push_back(tank.particles.type[i]);
        left.ids.push_back(static_cast<std::uint32_t>(left.ids.size()));
        if (i < tank.particles.normals.size()) left.normals.push_back(tank.particles.normals[i]);
    }
    tank.particles = std::move(left);
    tank.setup.is_periodic[0] = true;
    tank.setup.periodic[0] = {2, 0, 0};
    tank.setup.domain = {{0, -0.3, -0.3}, {2, 1.3, 1.3}};
    EXPECT_EQ(found(tank.check()), Faults{}) << to_text(tank.check());
    // Over the limit at x = 2 into the floor at x = 0.
    tank.normal_at({1.95, y_, -0.05}) = {0.1F, 0, 0};
    EXPECT_EQ(found(tank.check()), (Faults{{"ghost_in_wall", 1}}));
    // 0.02 m from its neighbour beyond the limit.
    tank.add_fluid({1.99, y_, 0.65});
    tank.add_fluid({0.01, y_, 0.65});
    EXPECT_EQ(tank.check().close_pairs, 1U);
}

TEST_P(CheckedTank, JudgesPlacesOfCasesWithoutNormals)
{
    tank_.setup.boundary = 1;
    for (auto& n : tank_.particles.normals) n = {};
    tank_.add_fluid({1.05, y_, -0.01});
    const CheckReport report = tank_.check();
    EXPECT_FALSE(report.judges_normals);
    EXPECT_EQ(found(report), (Faults{{"fluid_near_wall", 1}}));
    EXPECT_EQ(to_text(report).find("Walls, with the cavity"), std::string::npos);
}

TEST_P(CheckedTank, FindsWhatStopsTheSolverInBufferZones)
{
    // A zone around the middle of the floor: 12 columns of 3 layers, less the inner 8.
    tank_.setup.buffers.push_back({{{0.4, -9, -1}, {1.6, 9, 1}}, {{0.6, -9, -9}, {1.4, 9, 9}}});
    EXPECT_EQ(found(tank_.check()), Faults{});
    tank_.normal_at({0.45, y_, -0.05}) = {};
    EXPECT_EQ(found(tank_.check()), (Faults{{"no_normal", 1}, {"in_buffer_zone", 1}}));
    tank_.setup.boundary = 1;
    const std::uint64_t across = GetParam() ? 4 * 3 : 4 * (3 * 10 + 2 * 3 * 13);
    EXPECT_EQ(tank_.check().total(Fault::InBufferZone), across);
}
