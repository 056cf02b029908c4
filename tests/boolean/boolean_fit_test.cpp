// Particles on the surface of combinations.
#include "boolean/boolean_parts.h"

#include "fppg/relax.h"
#include "meshes/mesh_query.h"
#include "meshes/point_grid.h"

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
        {
            const Vec3& a = mesh.vertices[f[0]];
            const Vec3 u = mesh.vertices[f[1]] - a;
            const Vec3 v = mesh.vertices[f[2]] - a;
            // Points a quarter of dp apart.
            const int n = 4 + static_cast<int>(4 * std::max({norm(u), norm(v), norm(v - u)}) / dp);
            for (int i = 0; i <= n; ++i)
                for (int j = 0; i + j <= n; ++j)
                {
                    const Vec3 p = a + (1.0 * i / n) * u + (1.0 * j / n) * v;
                    double nearest = 4 * dp * dp;
                    grid.for_each_near(p, 2 * dp,
                                       [&](std::uint32_t, double d)
                                       { nearest = std::min(nearest, d); });
                    widest = std::max(widest, std::sqrt(nearest));
                }
        }
        return widest / dp;
    }
};

/// Whether a particle stands between solid behind it and none before it, judged by the parts alone.
bool is_on_the_surface(const PartList& list, const BooleanNode& tree, const FittedBoolean& fitted,
                       std::size_t i)
{
    const SurfaceMesh& mesh = fitted.bodies[0].mesh;
    const auto& facet = mesh.facets[fitted.particles.facets[i]];
    const Vec3& a = mesh.vertices[facet[0]];
    const Vec3& b = mesh.vertices[facet[1]];
    const Vec3& c = mesh.vertices[facet[2]];
    // Particles on edges and corners are looked at from within their facet.
    const Vec3& p = fitted.particles.positions[i];
    const Vec3 within = p + 0.02 * ((1.0 / 3) * (a + b + c) - p);
    const Vec3 normal = cross(b - a, c - a);
    const auto is_solid = [&](double side)
    {
        std::vector<char> in;
        for (const SurfaceMesh& part : list.meshes)
            in.push_back(winding_number(soup_of(part),
                                        within + (side * 1e-5 * dp / norm(normal)) * normal) > 0.5);
        return evaluate(tree, in);
    };
    return is_solid(-1) && !is_solid(1);
}

TEST(FitBoolean, CoversSeamsAndSurfacesOfRandomPairsAndTriples)
{
    std::size_t combined = 0;
    for (unsigned seed = 1; seed <= 40; ++seed)
    {
        SCOPED_TRACE("seed " + std::to_string(seed));
        std::mt19937 random(seed);
        PartList list;
        const bool is_triple = seed % 4 == 0;
        for (int i = 0; i < (is_triple ? 3 : 2); ++i) list.add(any_part(random, Placing::Random));
        BooleanNode tree = of_two(static_cast<BooleanOp>(1 + seed % 3));
        if (is_triple)
            tree = test::combined(static_cast<BooleanOp>(1 + seed / 4 % 3), {tree, leaf(2)});
        const FittedBoolean fitted(list, tree);
        if (fitted.bodies.empty()) continue;
        ++combined;
        EXPECT_LE(fitted.widest_gap_on(fitted.combined.seams), 0.7 + 1e-6);
        EXPECT_LE(fitted.widest_gap(), 0.75);
        std::size_t strays = 0;
        for (std::size_t i = 0; i < fitted.particles.size(); i += 7)
            if (!is_on_the_surface(list, tree, fitted, i)) ++strays;
        EXPECT_EQ(strays, 0U);
    }
    EXPECT_GE(combined, 30U);
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
