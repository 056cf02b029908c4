#include "meshes/crowded_points.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <random>
#include <tuple>

namespace fppg
{
namespace
{

constexpr double reach = 0.1;

/// Points in a cube of 1 m, some of them far from it, some twice.
std::vector<Vec3> some_points(std::size_t count, double far)
{
    std::mt19937 random(5);
    std::uniform_real_distribution<double> place(0, 1);
    std::vector<Vec3> points;
    for (std::size_t i = 0; i < count; ++i)
    {
        Vec3 p{place(random), place(random), place(random)};
        if (i % 50 == 49) p = p + Vec3{far, -far, 0.5 * far};
        points.push_back(i % 41 == 40 ? points[i / 2] : p);
    }
    return points;
}

TEST(CrowdedPoints, HaveTheNearestDistancesOfAPlainSearch)
{
    for (const double far : {0.0, 7.0, 1e9, 1e300})
    {
        const std::vector<Vec3> points = some_points(5000, far);
        const std::vector<double> found = nearest_distances(points, reach, 2);
        ASSERT_EQ(found.size(), points.size());
        for (std::size_t i = 0; i < points.size(); ++i)
        {
            double nearest = reach;
            for (std::size_t j = 0; j < points.size(); ++j)
                if (j != i) nearest = std::min(nearest, norm(points[j] - points[i]));
            ASSERT_DOUBLE_EQ(found[i], nearest) << i << ", " << far;
        }
    }
    EXPECT_TRUE(nearest_distances({}, reach, 2).empty());
}

TEST(CrowdedPoints, GoInTheOrderOfTheirRank)
{
    const std::vector<Vec3> points = some_points(5000, 3);
    std::vector<std::uint32_t> rank(points.size());
    for (std::uint32_t i = 0; i < rank.size(); ++i) rank[i] = i * 7 % 3;
    const auto may_stay = [](std::size_t i, std::size_t j) { return (i + j) % 5 == 0; };
    std::vector<std::uint32_t> order(points.size());
    std::iota(order.begin(), order.end(), 0);
    std::sort(order.begin(), order.end(),
              [&](std::uint32_t a, std::uint32_t b)
              { return std::tuple(rank[a], a) < std::tuple(rank[b], b); });
    std::vector<char> expected(points.size(), 0);
    for (std::size_t at = 0; at < order.size(); ++at)
        for (std::size_t before = 0; before < at; ++before)
            if (expected[order[before]] == 0 && !may_stay(order[at], order[before]) &&
                norm(points[order[at]] - points[order[before]]) < (1 - 1e-4) * reach)
                expected[order[at]] = 1;
    const auto gone = std::count(expected.begin(), expected.end(), 1);
    EXPECT_GT(gone, 200);
    EXPECT_LT(gone, 4900);
    EXPECT_EQ(find_crowded(points, rank, reach, may_stay, 2), expected);
}

} // namespace
} // namespace fppg
