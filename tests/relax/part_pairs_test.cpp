#include "relax/part_pairs.h"

#include "meshes/crowded_points.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace fppg
{
namespace
{

const PutBeside anywhere = [](std::size_t, const Vec3&, const Vec3& to) { return to; };

double least_of(const std::vector<Vec3>& points)
{
    const std::vector<double> near = nearest_distances(points, 2, 1);
    return *std::min_element(near.begin(), near.end());
}

/// A square of points 1 apart with one more beside its middle.
std::vector<Vec3> crowded_square()
{
    std::vector<Vec3> out;
    for (int x = -4; x <= 4; ++x)
        for (int z = -4; z <= 4; ++z) out.push_back({x * 1.0, 0, z * 1.0});
    out.push_back({0.3, 0, 0.2});
    return out;
}

TEST(PartPairs, LeadsThemApartInAPlaneAndLeavesOthersAlone)
{
    std::vector<Vec3> points = crowded_square();
    const std::vector<Vec3> before = points;
    EXPECT_EQ(part_pairs(points, points.size(), 0.75, anywhere, 1), 0.75);
    EXPECT_GE(least_of(points), 0.75);
    for (std::size_t i = 0; i < points.size(); ++i)
    {
        EXPECT_EQ(points[i].y, 0);
        if (norm(before[i]) > 4.2)
        {
            EXPECT_EQ(points[i], before[i]);
        }
    }
}

TEST(PartPairs, DoesNotMoveWhatStays)
{
    std::vector<Vec3> points{{0.4, 0, 0}, {0, 0, 0}, {5, 0, 0}, {5.2, 0, 0}};
    EXPECT_EQ(part_pairs(points, 1, 0.75, anywhere, 1), 0.75);
    EXPECT_GE(points[0].x, 0.75);
    EXPECT_EQ(points[1], Vec3{});
    EXPECT_EQ(points[3], (Vec3{5.2, 0, 0}));
}

TEST(PartPairs, KeepsToThePlacesThatAreAllowed)
{
    std::vector<Vec3> points = crowded_square();
    const PutBeside on_line = [](std::size_t, const Vec3& from, const Vec3& to) {
        return Vec3{to.x, from.y, from.z};
    };
    const std::vector<Vec3> before = points;
    const double least = part_pairs(points, points.size(), 0.75, on_line, 1);
    EXPECT_GE(least, least_of(before));
    for (std::size_t i = 0; i < points.size(); ++i) EXPECT_EQ(points[i].z, before[i].z);
}

TEST(PartPairs, IsTheSameWithAnyNumberOfThreads)
{
    std::vector<Vec3> one = crowded_square(), many = one;
    part_pairs(one, one.size(), 0.9, anywhere, 1);
    part_pairs(many, many.size(), 0.9, anywhere, 16);
    EXPECT_EQ(one, many);
}

/// Those that came to one place go back, and what is in their way then, too.
TEST(PutBackCrowded, LeavesNoneNearerThanAtFirst)
{
    const std::vector<Vec3> starts{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {5, 0, 0}, {5.3, 0, 0}};
    std::vector<Vec3> places{{0.9, 0, 0}, {0.91, 0, 0}, {1.1, 0, 0}, {5, 0.2, 0}, {5.3, 0, 0}};
    put_back_crowded(places, starts, 0.6, 1);
    EXPECT_EQ(places, starts);
    places[2] = {2.1, 0, 0};
    const std::vector<Vec3> apart = places;
    put_back_crowded(places, starts, 0.6, 1);
    EXPECT_EQ(places, apart);
}

} // namespace
} // namespace fppg
