// Particles on the surface of combinations.
#include "boolean/boolean_parts.h"

#include "fppg/relax.h"
#include "shapes/mesh_query.h"
#include "shapes/point_grid.h"

#include <gtest/gtest.h>

namespace fppg
{
namespace
{

using namespace test;

constexpr double dp = 0.1;

/// A combination with its relaxed particles.
struct FittedBoolean
{
    BooleanMesh combined;
    std::vector<FittedBody> bodies;
    WallParticles particles;

    FittedBoolean(const PartList& list, const BooleanNode& tree) : combined(list.run(tree))
    {
        if (combined.mesh.facets.empty()) return;
        FittedBody body;
        body.mesh = combined.mesh;
        body.report = combined.report;
        for (const std::uint32_t owner : combined.owners)
            body.facet_mk.push_back(static_cast<std::uint16_t>(10 + owner));
        FeatureOptions options;
        options.dp = dp;
        body.features = find_features(body.mesh, options, combined.seams);
        FitOptions fit;
        fit.dp = dp;
        const SurfaceParticles placed =
            fit_surface(body.mesh, body.features,
                        place_feature_particles(body.mesh, body.features, options), fit, 1);
        particles.positions = placed.positions;
        particles.kinds = placed.kinds;
        particles.facets = placed.facets;
        particles.bodies.assign(placed.positions.size(), 0);
        particles.held.assign(placed.positions.size(), 0);
        for (const std::uint32_t f : placed.facets) particles.mk.push_back(body.facet_mk[f]);
        bodies.push_back(std::move(body));
        RelaxSurfaceOptions relax;
        relax.dp = dp;
        std::vector<char> held;
        relax_surface(bodies, particles, held, relax, 1);
    }

    /// The largest distance from points of the edges to their particles.
    double widest_gap_on(const std::vector<std::uint32_t>& edges) const
    {
        const SurfaceMesh& mesh = bodies[0].mesh;
        PointGrid grid(dp, particles.size());
        for (const Vec3& p : particles.positions) grid.add(p);
        double widest = 0;
        for (const std::uint32_t e : edges)
            for (int i = 0; i <= 8; ++i)
            {
                const Vec3& a = mesh.vertices[mesh.edges[e][0]];
                const Vec3 p = a + (i / 8.0) * (mesh.vertices[mesh.edges[e][1]] - a);
                double nearest = 4 * dp * dp;
                grid.for_each_near(
                    p, 2 * dp, [&](std::uint32_t, double d) { nearest = std::min(nearest, d); });
                widest = std::max(widest, std::sqrt(nearest));
            }
        return widest / dp;
    }

    /// The same for points all over the surface.
    double widest_gap() const
    {
        const SurfaceMesh& mesh = bodies[0].mesh;
        PointGrid grid(dp, particles.size());
        for (const Vec3& p : particles.positions) grid.add(p);
        double widest = 0;
        for (const auto& f : mesh.facets)
            for (int i = 0; i <= 6; ++i)
                for (int j = 0; i + j <= 6; ++j)
                {
                    const Vec3& a = mesh.vertices[f[0]];
                    const Vec3 p = a + (i / 6.0) * (mesh.vertices[f[1]] - a) +
                                   (j / 6.0) * (mesh.vertices[f[2]] - a);
                    double nearest = 4 * dp * dp;
                    grid.for_each_near(p, 2 * dp,
                                       [&](std::uint32_t, double d)
                                       { nearest = std::min(nearest, d); });
                    widest = std::max(widest, std::sqrt(nearest));
                }
        return widest / dp;
    }
};

TEST(FitBoolean, CoversSeamsAndSurfacesOfRandomPairs)
{
    for (unsigned seed = 1; seed <= 12; ++seed)
    {
        std::mt19937 random(seed);
        PartList list;
        for (int i = 0; i < 2; ++i) list.add(any_part(random, Placing::Random));
        const FittedBoolean fitted(list, of_two(static_cast<BooleanOp>(1 + seed % 3)));
        if (fitted.bodies.empty()) continue;
        EXPECT_LE(fitted.widest_gap_on(fitted.combined.seams), 0.5 + 1e-6) << "seed " << seed;
        EXPECT_LE(fitted.widest_gap(), 0.76) << "seed " << seed;
    }
}

TEST(FitBoolean, KeepsTheParticlesOfAPartOnIt)
{
    PartList list;
    list.add(box({-1, -1, -1}, {1, 1, 1}));
    list.add(moved(sphere(3), placed({}, 0.8, {1, 0.2, 0.9})));
    const FittedBoolean fitted(list, of_two(BooleanOp::Union));
    const MeshQuery of_box(soup_of(list.meshes[0]));
    const MeshQuery of_ball(soup_of(list.meshes[1]));
    for (std::size_t i = 0; i < fitted.particles.size(); ++i)
    {
        const Vec3& p = fitted.particles.positions[i];
        const MeshQuery& own = fitted.particles.mk[i] == 10 ? of_box : of_ball;
        EXPECT_LT(own.closest_point(p).distance, 1e-6);
        // Nothing stands inside the other part.
        const MeshQuery& other = fitted.particles.mk[i] == 10 ? of_ball : of_box;
        const bool is_inside = winding_number(other.soup(), p + Vec3{1e-7, 2e-7, 3e-7}) > 0.5;
        EXPECT_TRUE(!is_inside || other.closest_point(p).distance < 1e-5);
    }
}

TEST(FitBoolean, GivesTheWallOfAHoleToThePartAroundIt)
{
    PartList list;
    list.add(box({-1, -1, -1}, {1, 1, 1}));
    TriangleSoup drill = tube(48);
    for (Vec3& v : drill.vertices) v = {0.5 * v.x, 0.5 * v.y, 2 * v.z};
    list.add(drill);
    const FittedBoolean fitted(list, of_two(BooleanOp::Difference));
    EXPECT_EQ(std::count(fitted.particles.mk.begin(), fitted.particles.mk.end(), 10),
              static_cast<std::ptrdiff_t>(fitted.particles.size()));
}

} // namespace
} // namespace fppg
