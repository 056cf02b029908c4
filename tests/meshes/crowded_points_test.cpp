#include "meshes/crowded_points.h"
#include "meshes/point_slabs.h"

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

/// On a sheet of 1500 by 1500 places, each a little off its own.
std::vector<Vec3> many_points()
{
    std::mt19937 random(7);
    std::uniform_real_distribution<double> off(-0.3, 0.3);
    std::vector<Vec3> points;
    for (int i = 0; i < 1500; ++i)
        for (int j = 0; j < 1500; ++j)
            points.push_back({i + off(random), j + off(random), off(random)});
    return points;
}

TEST(CrowdedPoints, AreTheSameForMorePointsThanAreWorkedOnAtOnce)
{
    const std::vector<Vec3> points = many_points();
    const std::vector<double> nearest = nearest_distances(points, 1.5, 2);
    const std::vector<char> goes =
        find_crowded(points, std::vector<std::uint32_t>(points.size(), 0), 0.5, {}, 2);
    // The first rows alone, but for the last of them, whose neighbours are missing.
    const std::size_t part = 900 * 1500, sure = 890 * 1500;
    for (const bool is_end : {false, true})
    {
        const std::size_t first = is_end ? points.size() - part : 0;
        const auto begin = points.begin() + static_cast<std::ptrdiff_t>(first);
        const std::vector<Vec3> some(begin, begin + static_cast<std::ptrdiff_t>(part));
        const std::vector<double> own = nearest_distances(some, 1.5, 1);
        const std::size_t from = is_end ? part - sure : 0;
        for (std::size_t i = from; i < from + sure; ++i)
            ASSERT_EQ(nearest[first + i], own[i]) << first << ", " << i;
    }
    std::vector<Vec3> stays;
    for (std::size_t i = 0; i < points.size(); ++i)
        if (goes[i] == 0) stays.push_back(points[i]);
    EXPECT_LT(stays.size(), points.size() - 1000);
    for (const double distance : nearest_distances(stays, 1.5, 2))
        ASSERT_GE(distance, 0.5 * (1 - 1e-4));
}

TEST(PointSlabs, HoldEachPointOnceAndAreNoThinnerThanAsked)
{
    const std::vector<Vec3> points = some_points(5000, 0);
    std::vector<std::uint32_t> which;
    for (std::uint32_t i = 0; i < points.size(); i += 2) which.push_back(i);
    for (const double thinnest : {0.0, 0.17})
    {
        const std::vector<PointSlab> slabs = cut_into_slabs(points, which, 200, thinnest);
        ASSERT_EQ(slabs.size(), thinnest > 0 ? 5u : 13u);
        std::vector<std::uint32_t> all;
        for (const PointSlab& slab : slabs)
        {
            for (const std::uint32_t i : slab.members)
            {
                EXPECT_GE(points[i][slab.axis], slab.low - 1e-12);
                EXPECT_LE(points[i][slab.axis], slab.high + 1e-12);
            }
            EXPECT_GE(slab.high - slab.low, thinnest);
            EXPECT_LE(slab.members.size(), thinnest > 0 ? 850u : 210u);
            all.insert(all.end(), slab.members.begin(), slab.members.end());
        }
        std::sort(all.begin(), all.end());
        EXPECT_EQ(all, which);
    }
    EXPECT_EQ(cut_into_slabs(points, {7, 7}, 1, 0).size(), 1u);
    EXPECT_TRUE(cut_into_slabs(points, {}, 1, 0)[0].members.empty());
}

} // namespace
} // namespace fppg
