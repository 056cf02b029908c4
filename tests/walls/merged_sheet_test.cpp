// The sheet between the innermost layers of both sides of a part, by its middle.

#include "walls/merged_sheet.h"

#include "fppg/features.h"

#include "meshes/test_shapes.h"
#include "offset/middle.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

namespace fppg
{
namespace
{

constexpr double dp = 0.1;
constexpr double height = 12 * dp, length = 16 * dp;
constexpr std::array<double, 2> thick{3.5 * dp, 2.3 * dp}; ///< at the foot and at the top

/// A wall of one dp less at the top than at the foot, and 80 small blocks, whose middles lack less
/// than a fifth of a particle each.
TriangleSoup tapered_wall_and_blocks()
{
    const auto corner = [](int x, int y, int z) {
        return Vec3{(x - 0.5) * length, (y - 0.5) * thick.at(static_cast<std::size_t>(z)),
                    z * height};
    };
    TriangleSoup soup;
    const auto quad = [&](const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d)
    { test::add_quad(soup, a, b, c, d); };
    quad(corner(0, 0, 0), corner(0, 1, 0), corner(1, 1, 0), corner(1, 0, 0));
    quad(corner(0, 0, 1), corner(1, 0, 1), corner(1, 1, 1), corner(0, 1, 1));
    quad(corner(0, 0, 0), corner(1, 0, 0), corner(1, 0, 1), corner(0, 0, 1));
    quad(corner(1, 0, 0), corner(1, 1, 0), corner(1, 1, 1), corner(1, 0, 1));
    quad(corner(1, 1, 0), corner(0, 1, 0), corner(0, 1, 1), corner(1, 1, 1));
    quad(corner(0, 1, 0), corner(0, 0, 0), corner(0, 0, 1), corner(0, 1, 1));
    const Vec3 half{1.3 * dp, 1.12 * dp, 1.3 * dp};
    for (int k = 0; k < 80; ++k)
    {
        const Vec3 centre{5 * dp * (k % 10) - length, 2 + 5 * dp * (k / 10), 0};
        const TriangleSoup block = test::box(centre - half, centre + half);
        soup.vertices.insert(soup.vertices.end(), block.vertices.begin(), block.vertices.end());
    }
    return soup;
}

/// Every facet cut into four.
TriangleSoup quartered(const TriangleSoup& soup)
{
    TriangleSoup out;
    for (std::size_t f = 0; f < soup.size(); ++f)
    {
        const Vec3* const p = &soup.vertices[3 * f];
        const Vec3 ab = 0.5 * (p[0] + p[1]), bc = 0.5 * (p[1] + p[2]), ca = 0.5 * (p[2] + p[0]);
        test::add_facet(out, p[0], ab, ca);
        test::add_facet(out, ab, p[1], bc);
        test::add_facet(out, ca, bc, p[2]);
        test::add_facet(out, ab, bc, ca);
    }
    return out;
}

struct Part
{
    MeshReport report;
    SurfaceMesh mesh;
    WallDepth wall;

    explicit Part(const TriangleSoup& soup)
        : mesh(repair_mesh(soup, {}, 1, report)), wall(mesh, report, true, WallSide::Behind, 30, 1)
    {
    }
};

/// Blocks took a particle each of it, and forces drew what was left to the foot and to the top.
TEST(MergedSheet, HasTheNumberThatEachPlaceBetweenLayersLacks)
{
    const Part part(tapered_wall_and_blocks());
    const Features features = find_features(part.mesh, {});
    MergedSheetOptions options;
    options.dp = dp;
    options.gaps = {{1.1, 1.8, 2}};
    const ThinParts thin = find_thin_parts(part.wall, features, options, 1);
    const SurfaceParticles sheet = merged_sheet(part.wall, features, thin.middle, {}, options, 1);
    constexpr int parts = 4;
    std::array<double, parts> found{};
    std::size_t all = 0;
    for (const Vec3& p : sheet.positions)
    {
        if (p.y > 1) continue;
        EXPECT_NEAR(p.y, 0, 1e-6);
        ++found.at(static_cast<std::size_t>(p.z / height * parts));
        ++all;
    }
    // The middle ends where it is as deep below the ends as below the sides.
    double wanted_of_all = 0;
    for (int k = 0; k < parts; ++k)
    {
        const double middle = (k + 0.5) / parts;
        const double thickness = ((1 - middle) * thick[0] + middle * thick[1]) / dp;
        const double from = std::max(k * 12.0 / parts, 1.75);
        const double to = std::min((k + 1) * 12.0 / parts, 12 - 1.15);
        const double wanted = (thickness - 2) * (to - from) * (16 - thickness);
        EXPECT_NEAR(found.at(static_cast<std::size_t>(k)), wanted, 0.25 * wanted) << k;
        wanted_of_all += wanted;
    }
    EXPECT_NEAR(static_cast<double>(all), wanted_of_all, 0.08 * wanted_of_all);
}

/// Of small facets one stands for those around it.
TEST(MergedSheet, ItsMiddleIsTheSameUnderSmallFacets)
{
    TriangleSoup plate = test::box({0, 0, 0}, {length, 1.2 * dp, height});
    const auto middle_of = [](const TriangleSoup& soup)
    {
        const Part part(soup);
        MergedSheetOptions options;
        options.dp = dp;
        return find_thin_parts(part.wall, find_features(part.mesh, {}), options, 1);
    };
    const ThinParts coarse = middle_of(plate);
    for (int level = 0; level < 7; ++level) plate = quartered(plate);
    const ThinParts fine = middle_of(plate);
    EXPECT_NEAR(fine.volume / coarse.volume, 1, 0.01);
    ASSERT_FALSE(coarse.middle.empty());
    for (const MiddlePoint& p : coarse.middle)
    {
        double nearest = length;
        for (const MiddlePoint& q : fine.middle)
            nearest = std::min(nearest, norm(p.position - q.position));
        EXPECT_LT(nearest, 0.25 * dp);
    }
}

/// Over the edge where two walls of a tank meet, which runs into the solid.
TEST(MergedSheet, ItsMiddleGoesRoundAnEdge)
{
    // The walls of a channel: 1 m outside, 0.3 m less inside, along y.
    TriangleSoup soup;
    const std::array<Vec3, 6> outline{Vec3{0, -1, 0}, {1, -1, 0},   {1, -1, 0.3},
                                      {0.3, -1, 0.3}, {0.3, -1, 1}, {0, -1, 1}};
    const Vec3 along{0, 2, 0};
    for (std::size_t i = 0; i < 6; ++i)
    {
        const Vec3 &a = outline.at(i), &b = outline.at((i + 1) % 6);
        test::add_quad(soup, a, a + along, b + along, b);
    }
    for (const auto& quad : {std::array<std::size_t, 4>{0, 1, 2, 3}, {0, 3, 4, 5}})
    {
        test::add_quad(soup, outline.at(quad[0]), outline.at(quad[1]), outline.at(quad[2]),
                       outline.at(quad[3]));
        test::add_quad(soup, outline.at(quad[3]) + along, outline.at(quad[2]) + along,
                       outline.at(quad[1]) + along, outline.at(quad[0]) + along);
    }
    const Part part(soup);
    // From the edge (0.3, 0.3) at 30 degrees to the wall along z.
    const Vec3 way{-std::cos(0.5), 0, -std::sin(0.5)};
    const Vec3 p = Vec3{0.3, 0.1, 0.3} + 0.12 * way;
    const auto ball = ball_through(part.wall, part.wall.at(p), p, 0.3);
    ASSERT_TRUE(ball);
    // As far from the edge as from the outside.
    EXPECT_NEAR(ball->radius, 0.3 / (1 + std::cos(0.5)), 1e-4);
    EXPECT_NEAR(norm(ball->centre - Vec3{0.3, 0.1, 0.3} - ball->radius * way), 0, 1e-6);
}

} // namespace
} // namespace fppg
