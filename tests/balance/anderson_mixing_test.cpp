// Chains of springs, whose shortest waves are a thousand times as stiff as their longest.

#include "balance/anderson_mixing.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace fppg
{
namespace
{

constexpr std::size_t n = 10000; // more than a chunk of sums
constexpr std::size_t links = 50;

/// Chains of particles that are joined to their neighbours, and the ends to fixed points, at rest
/// where all are at zero.
std::vector<Vec3> forces_of(const std::vector<Vec3>& at)
{
    std::vector<Vec3> out(n);
    for (std::size_t i = 0; i < n; ++i)
    {
        const Vec3 before = i % links == 0 ? Vec3{} : at[i - 1];
        const Vec3 after = i % links == links - 1 ? Vec3{} : at[i + 1];
        out[i] = before + after - 2.0 * at[i];
    }
    return out;
}

double largest(const std::vector<Vec3>& forces)
{
    double out = 0;
    for (const Vec3& f : forces) out = std::max(out, norm(f));
    return out;
}

std::vector<Vec3> start()
{
    std::vector<Vec3> out;
    for (std::size_t i = 0; i < n; ++i)
    {
        const double x = static_cast<double>(i % links) / links;
        out.push_back({x * (1 - x), 0.1 * std::sin(40 * x), i % 2 == 0 ? 0.02 : -0.02});
    }
    return out;
}

std::vector<Vec3> after(int iterations, int threads)
{
    std::vector<Vec3> at = start();
    AndersonMixing mixing(n, threads);
    for (int it = 0; it < iterations; ++it)
    {
        mixing.add(at, forces_of(at));
        for (std::size_t i = 0; i < n; ++i) at[i] = at[i] + mixing.step(i, 0.4);
    }
    return at;
}

TEST(AndersonMixing, BringsChainsOfSpringsToRest)
{
    std::vector<Vec3> plain = start();
    for (int it = 0; it < 300; ++it)
    {
        const std::vector<Vec3> forces = forces_of(plain);
        for (std::size_t i = 0; i < n; ++i) plain[i] = plain[i] + 0.4 * forces[i];
    }
    EXPECT_GT(norm(plain[links / 2]), 0.1); // steps along the force alone take thousands
    const std::vector<Vec3> mixed = after(300, 2);
    EXPECT_LT(largest(mixed), 0.01);
    EXPECT_LT(largest(forces_of(mixed)), 1e-4);
}

TEST(AndersonMixing, IsTheSameOnAnyNumberOfThreads)
{
    EXPECT_EQ(after(12, 1), after(12, 3));
}

TEST(AndersonMixing, StaysWhereNothingPushes)
{
    const std::vector<Vec3> at = start(), none(n);
    AndersonMixing mixing(n, 1);
    mixing.add(at, none);
    mixing.add(at, none);
    EXPECT_EQ(mixing.step(7, 0.4), Vec3{});
}

} // namespace
} // namespace fppg
