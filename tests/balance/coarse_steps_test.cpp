#include "balance/coarse_steps.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace fppg
{
namespace
{

/// 24 particles a side, 1 m apart, in cells of 4 m.
std::vector<Vec3> block()
{
    std::vector<Vec3> out;
    for (int x = 0; x < 24; ++x)
        for (int y = 0; y < 24; ++y)
            for (int z = 0; z < 24; ++z)
                out.push_back(
                    {static_cast<double>(x), static_cast<double>(y), static_cast<double>(z)});
    return out;
}

TEST(CoarseSteps, AreWhatNeighboursHaveInCommon)
{
    const std::vector<Vec3> at = block();
    CoarseSteps steps(
        at, [](std::size_t) { return true; }, 4);
    // Up in one half, down in the other, and each against its neighbours, ten times as much.
    const auto step = [&](std::size_t i)
    {
        const auto parity = std::lround(at[i].x + at[i].y + at[i].z) % 2;
        return Vec3{0, parity == 0 ? 1e-2 : -1e-2, at[i].x < 12 ? 1e-3 : -1e-3};
    };
    steps.add(step, short_momentum, 2);
    const Vec3 up = steps.at({4, 12, 12});
    const Vec3 down = steps.at({19, 12, 12});
    EXPECT_NEAR(up.z, -down.z, 1e-9);
    EXPECT_GT(up.z, 2e-3);
    EXPECT_LT(std::abs(up.y), 0.05 * up.z);
    EXPECT_LT(std::abs(steps.at({11.5, 12, 12}).z), 0.5 * up.z); // between both
    // They go on as long as the force does.
    steps.add(step, short_momentum, 2);
    EXPECT_GT(steps.at({4, 12, 12}).z, 1.5 * up.z);
}

TEST(CoarseSteps, AreNoneWhereNothingMoves)
{
    const std::vector<Vec3> at = block();
    CoarseSteps steps(
        at, [&](std::size_t i) { return at[i].x < 8; }, 4);
    steps.add([](std::size_t) { return Vec3{0, 0, 1e-3}; }, short_momentum, 1);
    EXPECT_GT(steps.at({2, 12, 12}).z, 1e-3);
    CoarseSteps none(
        at, [](std::size_t) { return false; }, 4);
    none.add([](std::size_t) { return Vec3{0, 0, 1e-3}; }, short_momentum, 1);
    EXPECT_EQ(none.at({2, 12, 12}), (Vec3{}));
}

} // namespace
} // namespace fppg
