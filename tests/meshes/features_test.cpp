#include "fppg/features.h"

#include <cstdlib>
#include <filesystem>

#include <gtest/gtest.h>

#include "fppg/error.h"
#include "fppg/shapes.h"
#include "meshes/point_grid.h"
#include "meshes/test_shapes.h"

namespace fppg
{

namespace
{

using test::add_facet;
using test::add_quad;
using test::box;
using test::joined;

constexpr double pi = 3.14159265358979323846;

SurfaceMesh taken_in(const TriangleSoup& soup, int threads = 2)
{
    MeshReport report;
    return repair_mesh(soup, {}, threads, report);
}

/// A prism over a polygon around the origin, along z from 0 to `height`.
TriangleSoup prism(const std::vector<Vec3>& outline, double height)
{
    TriangleSoup soup;
    const Vec3 up{0, 0, height};
    for (std::size_t i = 0; i < outline.size(); ++i)
    {
        const Vec3 &a = outline[i], &b = outline[(i + 1) % outline.size()];
        add_quad(soup, a, b, b + up, a + up);
        add_facet(soup, {0, 0, 0}, b, a);
        add_facet(soup, up, a + up, b + up);
    }
    return soup;
}

TriangleSoup cylinder(int sides, double radius = 1, double height = 2)
{
    std::vector<Vec3> outline;
    for (int i = 0; i < sides; ++i)
        outline.push_back(
            {radius * std::cos(2 * pi * i / sides), radius * std::sin(2 * pi * i / sides), 0});
    return prism(outline, height);
}

/// A wheel with square teeth whose flanks lean, so that lines of many lengths meet.
TriangleSoup gear(int teeth, double radius, double depth, double height)
{
    std::vector<Vec3> outline;
    for (int i = 0; i < teeth; ++i)
        for (const auto& [share, r] :
             {std::pair{0.0, radius}, std::pair{0.31, radius}, std::pair{0.42, radius - depth},
              std::pair{0.87, radius - depth}})
        {
            const double angle = 2 * pi * (i + share) / teeth;
            outline.push_back({r * std::cos(angle), r * std::sin(angle), 0});
        }
    return prism(outline, height);
}

double smallest_distance(const std::vector<FeatureParticle>& particles, double dp)
{
    PointGrid grid(dp, particles.size());
    double smallest = 2 * dp;
    for (const FeatureParticle& particle : particles)
    {
        grid.for_each_near(particle.position, dp,
                           [&](std::uint32_t, double squared)
                           { smallest = std::min(smallest, std::sqrt(squared)); });
        grid.add(particle.position);
    }
    return smallest;
}

/// The farthest point of all feature lines from any particle, sampled every 0.02 dp; lines longer
/// than `longer_than` only.
double largest_gap(const SurfaceMesh& mesh, const Features& features,
                   const std::vector<FeatureParticle>& particles, double dp, double longer_than = 0)
{
    PointGrid grid(dp, particles.size());
    for (const FeatureParticle& particle : particles) grid.add(particle.position);
    double largest = 0;
    for (const FeatureLine& line : features.lines)
        for (const std::uint32_t e : line.edges)
        {
            if (line.length <= longer_than) continue;
            const Vec3 &a = mesh.vertices[mesh.edges[e][0]], &b = mesh.vertices[mesh.edges[e][1]];
            const double steps = std::ceil(norm(b - a) / (0.02 * dp));
            for (double i = 0; i <= steps; ++i)
            {
                double nearest = 4 * dp * dp;
                grid.for_each_near(a + (i / steps) * (b - a), dp,
                                   [&](std::uint32_t, double squared)
                                   { nearest = std::min(nearest, squared); });
                largest = std::max(largest, std::sqrt(nearest));
            }
        }
    return largest;
}

/// The share of corners farther than dp from all others that have a particle on them.
double covered_corners(const SurfaceMesh& mesh, const Features& features,
                       const std::vector<FeatureParticle>& particles, double dp)
{
    PointGrid corners(dp, features.singular.size());
    for (const std::uint32_t v : features.singular) corners.add(mesh.vertices[v]);
    std::vector<char> is_on(mesh.vertices.size(), 0);
    for (const FeatureParticle& particle : particles)
        if (particle.is_corner) is_on[particle.vertex] = 1;
    double alone = 0, covered = 0;
    for (const std::uint32_t v : features.singular)
    {
        int near = 0;
        corners.for_each_near(mesh.vertices[v], dp, [&](std::uint32_t, double) { ++near; });
        if (near > 1) continue;
        ++alone;
        covered += is_on[v];
    }
    return alone > 0 ? covered / alone : 1;
}

void expect_good(const SurfaceMesh& mesh, double dp, double angle_deg = 30)
{
    const FeatureOptions options{.angle_deg = angle_deg, .dp = dp};
    const Features features = find_features(mesh, options);
    const std::vector<FeatureParticle> particles = place_feature_particles(mesh, features, options);
    EXPECT_LE(largest_gap(mesh, features, particles, dp), 0.701 * dp);
    EXPECT_GE(smallest_distance(particles, dp), 0.6 * dp * (1 - 1e-12));
    EXPECT_EQ(covered_corners(mesh, features, particles, dp), 1);
}

} // namespace

TEST(FindFeatures, CubeHasTwelveLinesBetweenEightCorners)
{
    const SurfaceMesh mesh = taken_in(box({0, 0, 0}, {1, 1, 1}));
    for (const double angle : {30.0, 89.9})
    {
        const Features features = find_features(mesh, {.angle_deg = angle});
        EXPECT_EQ(features.edges.size(), 12u);
        EXPECT_EQ(features.singular.size(), 8u);
        ASSERT_EQ(features.lines.size(), 12u);
        for (const FeatureLine& line : features.lines)
        {
            EXPECT_FALSE(line.is_closed);
            EXPECT_DOUBLE_EQ(line.length, 1);
        }
    }
    EXPECT_TRUE(find_features(mesh, {.angle_deg = 90}).edges.empty());
}

TEST(FindFeatures, CylinderHasTwoClosedLines)
{
    const Features features = find_features(taken_in(cylinder(48)), {});
    EXPECT_TRUE(features.singular.empty());
    ASSERT_EQ(features.lines.size(), 2u);
    for (const FeatureLine& line : features.lines)
    {
        EXPECT_TRUE(line.is_closed);
        EXPECT_EQ(line.vertices.size(), 48u);
        EXPECT_EQ(line.edges.size(), 48u);
        EXPECT_NEAR(line.length, 2 * 48 * std::sin(pi / 48), 1e-12);
    }
}

TEST(FindFeatures, EightSidesAreARoundRimAndSixAreCorners)
{
    EXPECT_EQ(find_features(taken_in(cylinder(8)), {.angle_deg = 60}).singular.size(), 0u);
    EXPECT_EQ(find_features(taken_in(cylinder(6)), {.angle_deg = 70}).singular.size(), 12u);
    EXPECT_EQ(find_features(taken_in(cylinder(6)), {.angle_deg = 70}).lines.size(), 12u);
}

TEST(FindFeatures, TwelveSidesAtThirtyDegreesAreJudgedAlike)
{
    TriangleSoup soup = cylinder(12);
    for (Vec3& v : soup.vertices)
        for (int axis = 0; axis < 3; ++axis) v[axis] = static_cast<float>(v[axis]);
    EXPECT_EQ(find_features(taken_in(soup), {.angle_deg = 30}).edges.size(), 24u);
}

TEST(FindFeatures, BendsOfACadModelCountInThePlaceOfFacetAngles)
{
    // Twelve sides at 30 degrees that stand for a round tube: only its rims bend, and of those one
    // edge is not known.
    const SurfaceMesh mesh = taken_in(cylinder(12));
    std::vector<float> bends(mesh.edges.size(), 0);
    std::vector<std::size_t> rims;
    for (std::size_t e = 0; e < mesh.edges.size(); ++e)
    {
        const auto& facets = mesh.edge_facets[e];
        if (std::fabs(dot(mesh.normals[facets[0]], mesh.normals[facets[1]])) < 0.1)
            rims.push_back(e);
    }
    ASSERT_EQ(rims.size(), 24u);
    EXPECT_TRUE(find_features(mesh, {.angle_deg = 5}, {}, bends).edges.empty());
    for (const std::size_t e : rims) bends[e] = static_cast<float>(2 * pi / 180);
    bends[rims[0]] = -1;
    EXPECT_EQ(find_features(mesh, {.angle_deg = 5}, {}, bends).edges.size(), 24u);
    EXPECT_EQ(find_features(mesh, {.angle_deg = 5, .cad_angle_deg = 3}, {}, bends).edges.size(),
              1u);
}

TEST(FindFeatures, OpenEdgesAreFeaturesHoweverFlat)
{
    TriangleSoup sheet;
    add_quad(sheet, {0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0});
    const Features features = find_features(taken_in(sheet), {.angle_deg = 170});
    EXPECT_EQ(features.edges.size(), 4u);
    EXPECT_EQ(features.singular.size(), 4u);
}

TEST(FindFeatures, EdgesOfThreeFacetsAreFeatures)
{
    TriangleSoup soup;
    add_facet(soup, {0, 0, 0}, {1, 0, 0}, {0, 1, 0});
    add_facet(soup, {1, 0, 0}, {0, 0, 0}, {0, -1, 0});
    add_facet(soup, {0, 0, 0}, {1, 0, 0}, {0, 0, 1});
    const Features features = find_features(taken_in(soup), {});
    EXPECT_EQ(features.edges.size(), 7u);
    EXPECT_EQ(features.singular.size(), 5u);
}

TEST(FindFeatures, EveryFeatureEdgeIsOnOneLine)
{
    const SurfaceMesh mesh = taken_in(gear(17, 1, 0.2, 0.3));
    const Features features = find_features(mesh, {});
    std::vector<std::uint32_t> edges;
    for (const FeatureLine& line : features.lines)
    {
        edges.insert(edges.end(), line.edges.begin(), line.edges.end());
        for (std::size_t i = 0; i < line.edges.size(); ++i)
        {
            const std::uint32_t a = line.vertices[i],
                                b = line.vertices[(i + 1) % line.vertices.size()];
            const std::array<std::uint32_t, 2> ends{std::min(a, b), std::max(a, b)};
            EXPECT_EQ(mesh.edges[line.edges[i]], ends);
        }
    }
    std::sort(edges.begin(), edges.end());
    EXPECT_EQ(edges, features.edges);
}

TEST(FindFeatures, RefusesAnglesOutOfRange)
{
    const SurfaceMesh mesh = taken_in(box({0, 0, 0}, {1, 1, 1}));
    EXPECT_THROW(find_features(mesh, {.angle_deg = 180}), GeometryError);
    EXPECT_THROW(find_features(mesh, {.angle_deg = std::nan("")}), GeometryError);
    EXPECT_THROW(place_feature_particles(mesh, find_features(mesh, {}), {}), GeometryError);
}

TEST(PlaceFeatureParticles, DividesACubeEvenly)
{
    const SurfaceMesh mesh = taken_in(box({0, 0, 0}, {1, 1, 1}));
    const Features features = find_features(mesh, {});
    const auto exact = place_feature_particles(mesh, features, {.dp = 0.1});
    EXPECT_EQ(exact.size(), 8u + 12 * 9);
    const auto finer = place_feature_particles(mesh, features, {.dp = 0.099});
    EXPECT_EQ(finer.size(), 8u + 12 * 10);
    for (std::size_t i = 0; i < finer.size(); ++i) EXPECT_EQ(finer[i].is_corner, i < 8);
}

TEST(PlaceFeatureParticles, PutsThemOnTheirEdges)
{
    const SurfaceMesh mesh = taken_in(gear(11, 1, 0.2, 0.3));
    const Features features = find_features(mesh, {});
    for (const FeatureParticle& particle : place_feature_particles(mesh, features, {.dp = 0.07}))
    {
        if (particle.is_corner)
        {
            EXPECT_EQ(particle.position, mesh.vertices[particle.vertex]);
            continue;
        }
        const auto& on = features.lines[particle.line].edges;
        EXPECT_NE(std::find(on.begin(), on.end(), particle.edge), on.end());
        const Vec3 &a = mesh.vertices[mesh.edges[particle.edge][0]],
                   &b = mesh.vertices[mesh.edges[particle.edge][1]];
        EXPECT_LT(norm(cross(particle.position - a, b - a)) / norm(b - a), 1e-15);
    }
}

TEST(PlaceFeatureParticles, CoversAGearFromFineToFarTooCoarse)
{
    const SurfaceMesh mesh = taken_in(gear(23, 1, 0.15, 0.3));
    for (const double dp : {0.005, 0.013, 0.04, 0.07, 0.11, 0.2, 0.5, 3.0}) expect_good(mesh, dp);
}

TEST(PlaceFeatureParticles, LeaveNoPlaceFartherThanHalfADpWhereLinesAreApart)
{
    const SurfaceMesh mesh = taken_in(gear(23, 1, 0.15, 0.3));
    for (const double dp : {0.005, 0.013, 0.03})
    {
        const FeatureOptions options{.dp = dp};
        const Features features = find_features(mesh, options);
        FeaturesLeftOut left_out;
        const auto particles = place_feature_particles(mesh, features, options, &left_out);
        EXPECT_LE(largest_gap(mesh, features, particles, dp), 0.501 * dp) << dp;
        EXPECT_EQ(left_out.corners + left_out.edges, 0u) << dp;
    }
}

TEST(PlaceFeatureParticles, SayHowManyTheyLeaveOutWhereCornersAreTooNear)
{
    // Two bars 0.3 dp apart, each of 0.5 dp by 0.5 dp.
    const double dp = 0.1;
    const SurfaceMesh mesh =
        taken_in(joined(box({0, 0, 0}, {0.05, 1, 0.05}), box({0.08, 0, 0}, {0.13, 1, 0.05})));
    const FeatureOptions options{.dp = dp};
    const Features features = find_features(mesh, options);
    FeaturesLeftOut left_out;
    const auto particles = place_feature_particles(mesh, features, options, &left_out);
    const auto corners = static_cast<std::size_t>(std::count_if(
        particles.begin(), particles.end(), [](const FeatureParticle& p) { return p.is_corner; }));
    EXPECT_EQ(corners + left_out.corners, 16u);
    EXPECT_LE(corners, 12u);
    EXPECT_GE(left_out.edges, 10u);
    EXPECT_LE(largest_gap(mesh, features, particles, dp), 0.701 * dp);
    EXPECT_GE(smallest_distance(particles, dp), 0.6 * dp);
}

TEST(PlaceFeatureParticles, CoversLinesCloserThanDp)
{
    // Eleven plates of 0.3 dp side by side: every line runs within 0.3 dp of another.
    TriangleSoup soup;
    for (int i = 0; i < 11; ++i)
        soup = joined(soup, box({0.06 * i, 0, 0}, {0.06 * i + 0.03, 1, 1}));
    const SurfaceMesh mesh = taken_in(soup);
    for (const double dp : {0.1, 0.031, 0.3}) expect_good(mesh, dp);
}

TEST(PlaceFeatureParticles, CoversRimsOfAnyLength)
{
    for (const int sides : {8, 9, 40})
        for (double radius = 0.1; radius < 2; radius += 0.083)
            expect_good(taken_in(cylinder(sides, radius, 0.7)), 0.5, 60);
}

TEST(PlaceFeatureParticles, RefusesAdpThatNeedsTooMany)
{
    const SurfaceMesh mesh = taken_in(box({0, 0, 0}, {1000, 1000, 1000}));
    EXPECT_THROW(place_feature_particles(mesh, find_features(mesh, {}), {.dp = 1e-7}),
                 GeometryError);
}

TEST(PlaceFeatureParticles, CoversTheModels)
{
    const char* shared = std::getenv("FPPG_SHARED");
    if (shared == nullptr) GTEST_SKIP() << "FPPG_SHARED, the folder with models/, is not set";
    struct Model
    {
        const char* name;
        double dp;
    };
    for (const Model& model :
         {Model{"gear1", 0.8}, Model{"gear1", 0.3}, Model{"gear2", 0.15}, Model{"fandisk", 0.03},
          Model{"bunny_fppg", 0.888}, Model{"skyscraper", 0.08}, Model{"skyscraper", 0.03},
          Model{"tyre", 0.002}, Model{"tyre", 0.006}, Model{"vehicle_body", 0.02},
          Model{"motorbike", 0.01}, Model{"beetle_car", 0.02}})
    {
        std::string path;
        for (const auto& entry : std::filesystem::recursive_directory_iterator(
                 std::filesystem::path(shared) / "models"))
            if (entry.path().filename() == std::string(model.name) + ".stl")
                path = entry.path().string();
        ASSERT_FALSE(path.empty()) << model.name;
        SCOPED_TRACE(model.name);
        const SurfaceMesh mesh = taken_in(read_stl(path).soup);
        expect_good(mesh, model.dp);
        const Features features = find_features(mesh, {});
        RecordProperty(model.name, static_cast<int>(features.lines.size()));
    }
}

} // namespace fppg
