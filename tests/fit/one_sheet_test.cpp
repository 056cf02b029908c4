#include "fppg/one_sheet.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace fppg
{
namespace
{

constexpr double dp = 0.1;

TriangleSoup box(const Vec3& size)
{
    TriangleSoup soup;
    const auto corner = [&](int i) {
        return Vec3{size.x * (i & 1), size.y * (i >> 1 & 1), size.z * (i >> 2)};
    };
    const std::array<std::array<int, 4>, 6> sides{
        {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}}};
    for (const auto& s : sides)
        for (const int i : {s[0], s[1], s[2], s[0], s[2], s[3]}) soup.vertices.push_back(corner(i));
    return soup;
}

struct Fitted
{
    explicit Fitted(const Vec3& size, int threads = 1)
    {
        MeshReport report;
        mesh = repair_mesh(box(size), {}, 1, report);
        FeatureOptions options;
        options.dp = dp;
        features = find_features(mesh, options);
        FitOptions fit;
        fit.dp = dp;
        particles =
            fit_surface(mesh, features, place_feature_particles(mesh, features, options), fit, 1);
        taken = keep_one_sheet(mesh, features, {.dp = dp}, particles, threads).positions.size();
    }
    SurfaceMesh mesh;
    Features features;
    SurfaceParticles particles;
    std::size_t taken = 0;
};

TEST(OneSheet, OfAThinPlateIsAllThatStays)
{
    for (const double thickness : {0.2, 0.5, 0.9})
    {
        const Fitted plate({2, 3, thickness * dp});
        std::size_t below = 0;
        for (const Vec3& p : plate.particles.positions) below += p.z == 0;
        const std::size_t n = plate.particles.positions.size();
        // All on one of its two large sides, rims included: about one a dp^2.
        EXPECT_TRUE(below == n || below == 0) << thickness << ": " << below << " of " << n;
        EXPECT_GT(static_cast<double>(n) * dp * dp, 0.9 * 6);
        EXPECT_LT(static_cast<double>(n) * dp * dp, 1.2 * 6);
    }
}

TEST(OneSheet, LeavesNoHoleInThePlate)
{
    const Fitted plate({2, 3, 0.4 * dp});
    for (double x = 0; x <= 2; x += 0.05)
        for (double y = 0; y <= 3; y += 0.05)
        {
            double nearest = 1;
            for (const Vec3& p : plate.particles.positions)
                nearest = std::min(nearest, norm(p - Vec3{x, y, 0.2 * dp}));
            EXPECT_LT(nearest, dp);
        }
}

TEST(OneSheet, LeavesThickBodiesAlone)
{
    EXPECT_EQ(Fitted({2, 3, 1.5 * dp}).taken, 0U);
}

TEST(OneSheet, IsTheSameForAnyNumberOfThreads)
{
    EXPECT_EQ(Fitted({2, 3, 0.4 * dp}, 1).particles.facets,
              Fitted({2, 3, 0.4 * dp}, 8).particles.facets);
}

} // namespace
} // namespace fppg
