#include "relax/neighbour_list.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace fppg
{

namespace
{

PointArrays scattered(std::size_t n, float size, unsigned seed)
{
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> place(-size, size);
    PointArrays points;
    points.resize(n);
    for (std::size_t i = 0; i < n; ++i)
    {
        points.x[i] = place(random);
        points.y[i] = place(random);
        points.z[i] = 0.3f * place(random);
    }
    return points;
}

bool all(std::uint32_t)
{
    return true;
}

bool any_pair(std::uint32_t, std::uint32_t)
{
    return true;
}

float squared_distance(const PointArrays& p, std::size_t i, std::size_t j)
{
    const float dx = p.x[j] - p.x[i];
    const float dy = p.y[j] - p.y[i];
    const float dz = p.z[j] - p.z[i];
    return dx * dx + dy * dy + dz * dz;
}

} // namespace

TEST(NeighbourList, HoldsWhatTryingAllPairsFinds)
{
    const PointArrays points = scattered(1500, 9, 1);
    NeighbourList list(1.6f, 0.3f);
    list.build(points, 2, all, any_pair);
    ASSERT_EQ(list.rows(), points.size());
    std::vector<char> is_met(points.size(), 0);
    for (std::size_t row = 0; row < list.rows(); ++row)
    {
        const std::uint32_t i = list.point(row);
        is_met[i] = 1;
        std::vector<std::uint32_t> expected;
        for (std::uint32_t j = 0; j < points.size(); ++j)
            if (j != i && squared_distance(points, i, j) <= 1.9f * 1.9f) expected.push_back(j);
        std::vector<std::uint32_t> found(list.neighbours(row).begin(), list.neighbours(row).end());
        std::sort(found.begin(), found.end());
        EXPECT_EQ(found, expected);
    }
    EXPECT_EQ(std::count(is_met.begin(), is_met.end(), 1), 1500);
}

TEST(NeighbourList, LeavesOutPairsAndPointsOnRequest)
{
    const PointArrays points = scattered(500, 4, 2);
    NeighbourList list(1.0f, 0.2f);
    list.build(
        points, 1, [](std::uint32_t i) { return i % 2 == 0; },
        [](std::uint32_t, std::uint32_t j) { return j % 3 == 0; });
    std::size_t pairs = 0;
    for (std::size_t row = 0; row < list.rows(); ++row)
    {
        EXPECT_TRUE(list.point(row) % 2 == 0 || list.neighbours(row).empty());
        for (const std::uint32_t j : list.neighbours(row)) EXPECT_EQ(j % 3, 0u);
        pairs += list.neighbours(row).size();
    }
    EXPECT_GT(pairs, 100u);
}

TEST(NeighbourList, IsOutdatedWhenAPointHasMovedByHalfTheSkin)
{
    PointArrays points = scattered(40000, 50, 3);
    NeighbourList list(1.0f, 0.4f);
    list.build(points, 2, all, any_pair);
    EXPECT_FALSE(list.is_outdated(points, 2));
    for (float& x : points.x) x += 0.19f;
    EXPECT_FALSE(list.is_outdated(points, 2));
    points.y[39999] += 0.1f;
    EXPECT_TRUE(list.is_outdated(points, 2));
    points.resize(39999);
    EXPECT_TRUE(list.is_outdated(points, 2));
}

TEST(NeighbourList, IsTheSameForAnyNumberOfThreads)
{
    const PointArrays points = scattered(60000, 60, 4);
    NeighbourList one(1.6f, 0.3f);
    one.build(points, 1, all, any_pair);
    for (const int threads : {2, 8})
    {
        NeighbourList many(1.6f, 0.3f);
        many.build(points, threads, all, any_pair);
        for (std::size_t row = 0; row < one.rows(); ++row)
        {
            ASSERT_EQ(one.point(row), many.point(row));
            ASSERT_TRUE(std::ranges::equal(one.neighbours(row), many.neighbours(row)));
        }
        EXPECT_EQ(morton_order(points, 2, 1), morton_order(points, 2, threads));
    }
}

TEST(NeighbourList, TakesPointsFartherApartThanCellsCanCount)
{
    PointArrays points = scattered(200, 2, 5);
    points.x[0] = 1e8f;
    points.y[1] = -3e7f;
    NeighbourList list(1.0f, 0.1f);
    list.build(points, 1, all, any_pair);
    std::size_t pairs = 0;
    std::size_t expected = 0;
    for (std::size_t i = 0; i < points.size(); ++i)
    {
        pairs += list.neighbours(i).size();
        for (std::size_t j = 0; j < points.size(); ++j)
            expected += i != j && squared_distance(points, i, j) <= 1.1f * 1.1f;
    }
    EXPECT_EQ(pairs, expected);
}

TEST(NeighbourList, TakesNoPointsAndOnePoint)
{
    NeighbourList list(1.0f, 0.1f);
    list.build({}, 2, all, any_pair);
    EXPECT_EQ(list.rows(), 0u);
    list.build(scattered(1, 1, 6), 2, all, any_pair);
    ASSERT_EQ(list.rows(), 1u);
    EXPECT_TRUE(list.neighbours(0).empty());
}

TEST(MortonOrder, PutsPointsOfOneCellTogether)
{
    const PointArrays points = scattered(5000, 20, 7);
    const auto order = morton_order(points, 4, 2);
    ASSERT_EQ(order.size(), points.size());
    double along = 0;
    double as_given = 0;
    for (std::size_t k = 1; k < order.size(); ++k)
    {
        along += std::sqrt(squared_distance(points, order[k - 1], order[k]));
        as_given += std::sqrt(squared_distance(points, k - 1, k));
    }
    EXPECT_LT(along, 0.25 * as_given);
}

} // namespace fppg
