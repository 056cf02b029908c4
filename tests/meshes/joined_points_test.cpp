#include "meshes/joined_points.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <random>
#include <set>

namespace fppg
{
namespace
{

constexpr double reach = 0.1;

/// Every pair is looked at.
std::vector<std::uint32_t> first_of_sets(const std::vector<Vec3>& points)
{
    DisjointSet sets(points.size());
    for (std::uint32_t i = 0; i < points.size(); ++i)
        for (std::uint32_t j = 0; j < i; ++j)
        {
            const Vec3 way = points[i] - points[j];
            if (dot(way, way) <= reach * reach) sets.join(i, j);
        }
    std::vector<std::uint32_t> out;
    for (std::uint32_t i = 0; i < points.size(); ++i) out.push_back(sets.find(i));
    return out;
}

/// Returns the number of sets.
std::size_t expect_sets(const std::vector<Vec3>& points)
{
    DisjointSet sets = joined_within(points, reach);
    const std::vector<std::uint32_t> expected = first_of_sets(points);
    for (std::uint32_t i = 0; i < points.size(); ++i) EXPECT_EQ(sets.find(i), expected[i]) << i;
    return std::set<std::uint32_t>(expected.begin(), expected.end()).size();
}

TEST(JoinedPoints, AreThoseOfAPlainSearch)
{
    std::mt19937 random(7);
    std::uniform_real_distribution<double> place(0, 1);
    // From single points over many sets to one of all.
    for (const double size : {4.0, 1.6, 1.2, 0.5})
    {
        std::vector<Vec3> points;
        for (int i = 0; i < 1500; ++i)
            points.push_back(size * Vec3{place(random), place(random), 0.3 * place(random)});
        const std::size_t count = expect_sets(points);
        if (size == 4.0) EXPECT_GT(count, 1000U);
        if (size == 1.6) EXPECT_GT(count, 10U);
        if (size == 0.5) EXPECT_EQ(count, 1U);
    }
}

TEST(JoinedPoints, MayBeAsFarApartAsTheReach)
{
    // Two clusters whose middles are two reaches apart.
    EXPECT_EQ(expect_sets({{0, 0, 0}, {0.2, 0, 0}, {0.05, 0, 0}, {0.15, 0, 0}}), 1U);
    EXPECT_EQ(expect_sets({{0, 0, 0}, {0.2001, 0, 0}, {0.05, 0, 0}, {0.1501, 0, 0}}), 2U);
    EXPECT_EQ(expect_sets({}), 0U);
}

} // namespace
} // namespace fppg
