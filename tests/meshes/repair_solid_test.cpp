#include "fppg/surface_mesh.h"

#include <random>

#include <gtest/gtest.h>

#include "meshes/test_shapes.h"

namespace fppg
{
namespace
{

using test::box;
using test::inverted;
using test::joined;
using test::sphere;

constexpr double dp = 0.05;

SurfaceMesh as_solid(const TriangleSoup& soup, MeshReport& report)
{
    return repair_mesh(soup, {.dp = dp, .is_solid = true}, 2, report);
}

TriangleSoup jittered(TriangleSoup soup, double by)
{
    std::mt19937 random(5);
    std::uniform_real_distribution<double> shift(-by, by);
    for (Vec3& v : soup.vertices) v = v + Vec3{shift(random), shift(random), shift(random)};
    return soup;
}

TEST(RepairSolid, JoinsACornerThatIsOffInOneFacet)
{
    for (const double off : {6e-8, 1e-6, 1e-5, 1e-4})
        for (std::size_t corner = 0; corner < 36; ++corner)
        {
            TriangleSoup soup = box({0, 0, 0}, {1, 1, 1});
            soup.vertices[corner] = soup.vertices[corner] + Vec3{off, off, off};
            MeshReport report;
            const SurfaceMesh mesh = as_solid(soup, report);
            EXPECT_EQ(report.open_edges, 0u) << off << " at corner " << corner;
            EXPECT_EQ(mesh.facets.size(), 12u);
            EXPECT_NEAR(report.volume, 1, 4 * off);
        }
}

TEST(RepairSolid, ClosesFacetsWhoseCornersAreShakenByATwentyFifthOfDp)
{
    for (const TriangleSoup& soup : {box({0, 0, 0}, {1, 1, 1}), sphere(2)})
    {
        MeshReport clean, report;
        as_solid(soup, clean);
        as_solid(jittered(soup, dp / 25), report);
        EXPECT_EQ(report.open_edges, 0u);
        EXPECT_NEAR(report.volume, clean.volume, 0.01 * clean.volume);
        EXPECT_FALSE(report.warnings.empty());
    }
}

TEST(RepairSolid, ClosesTJunctionsThatAreOffTheEdge)
{
    for (const double off : {1e-6, 1e-4, 1e-3})
    {
        TriangleSoup soup = box({0, 0, 0}, {1, 1, 1});
        // The top as four facets, cut where x is a half; its middle corners are off the sides.
        soup.vertices.erase(soup.vertices.begin() + 6, soup.vertices.begin() + 12);
        const Vec3 low{0.5, -off, 1 + off}, high{0.5, 1 + off, 1 - off};
        test::add_quad(soup, {0, 0, 1}, low, high, {0, 1, 1});
        test::add_quad(soup, low, {1, 0, 1}, {1, 1, 1}, high);
        MeshReport report;
        as_solid(soup, report);
        EXPECT_EQ(report.open_edges, 0u) << off;
        EXPECT_EQ(report.t_junctions, 2u) << off;
        EXPECT_NEAR(report.volume, 1, 4 * off);
    }
}

TEST(RepairSolid, KeepsACrackThatIsWideInDp)
{
    TriangleSoup soup = box({0, 0, 0}, {1, 1, 1});
    for (std::size_t i = 6; i < 12; ++i) soup.vertices[i].z += 0.4 * dp; // a lid that floats
    MeshReport report;
    as_solid(soup, report);
    EXPECT_EQ(report.open_edges, 8u);
}

TEST(RepairSolid, DropsAWallThatTwoHalvesHaveOnce)
{
    TriangleSoup second = box({0.5, 0, 0}, {1, 1, 1});
    std::vector<Vec3> kept;
    for (std::size_t i = 0; i < second.vertices.size(); i += 3)
    {
        const Vec3* p = &second.vertices[i];
        if (p[0].x + p[1].x + p[2].x > 1.5) kept.insert(kept.end(), p, p + 3);
    }
    second.vertices = kept;
    ASSERT_EQ(second.size(), 10u);
    const TriangleSoup soup = joined(box({0, 0, 0}, {0.5, 1, 1}), second);
    MeshReport report;
    const SurfaceMesh mesh = as_solid(soup, report);
    EXPECT_EQ(report.partition_facets, 2u);
    EXPECT_EQ(report.shells, 1u);
    EXPECT_TRUE(report.is_watertight);
    EXPECT_DOUBLE_EQ(report.volume, 1);
    MeshReport hollow;
    EXPECT_EQ(repair_mesh(soup, {.dp = dp}, 1, hollow).facets.size(), 22u);
}

TEST(RepairSolid, KeepsACavityThatTouchesTheSurfaceAlongAnEdge)
{
    const TriangleSoup soup =
        joined(box({0, 0, 0}, {1, 1, 1}), inverted(box({0, 0, 0}, {0.5, 0.5, 1})));
    MeshReport report;
    as_solid(soup, report);
    EXPECT_EQ(report.partition_facets, 0u);
    EXPECT_NEAR(report.volume, 0.75, 1e-12);
}

TEST(RepairSolid, DropsAShellInsideAnotherOneButNoCavity)
{
    const TriangleSoup outer = box({0, 0, 0}, {1, 1, 1});
    const TriangleSoup inner = box({0.3, 0.3, 0.3}, {0.7, 0.7, 0.7});
    MeshReport same, cavity, beside;
    EXPECT_EQ(as_solid(joined(outer, inner), same).facets.size(), 12u);
    EXPECT_EQ(same.inner_shell_facets, 12u);
    EXPECT_DOUBLE_EQ(same.volume, 1);
    EXPECT_EQ(as_solid(joined(outer, inverted(inner)), cavity).facets.size(), 24u);
    EXPECT_NEAR(cavity.volume, 1 - 0.064, 1e-12);
    // An island in a cavity has the inside on one of its faces only.
    const TriangleSoup island = box({0.4, 0.4, 0.4}, {0.6, 0.6, 0.6});
    EXPECT_EQ(as_solid(joined(joined(outer, inverted(inner)), island), beside).facets.size(), 36u);
}

} // namespace
} // namespace fppg
