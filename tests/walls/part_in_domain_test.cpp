// Bodies far larger than the domain: what comes into it is as if all of them were laid out.

#include "walls/part_in_domain.h"

#include "fppg/case_def.h"
#include "fppg/error.h"
#include "fppg/lattice.h"
#include "fppg/scene.h"

#include "helpers/case_text.h"
#include "helpers/surface_cover.h"
#include "meshes/mesh_query.h"
#include "walls/fit_shape.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace fppg
{
namespace
{

using test::add_quad;
using test::box;

constexpr double dp = 0.05;

LatticeGrid domain()
{
    return {.origin = {-1.01, -0.97, -0.8}, .dp = dp, .n = {41, 41, 33}};
}

FittedDraw fit(const TriangleSoup& soup, bool is_solid, BodyExtent extent)
{
    FitSettings settings;
    return fit_shape({soup, is_solid}, settings, domain(), {}, extent, 2);
}

double height(double x, double y)
{
    return 0.3 * std::sin(2 * x) * std::cos(1.5 * y);
}

/// Hills of 20 m by 20 m; a solid has walls and a bottom.
TriangleSoup hills(bool is_solid)
{
    constexpr int n = 80;
    constexpr double half = 10;
    const auto at = [](int i, int j)
    {
        const double x = -half + 2 * half * i / n, y = -half + 2 * half * j / n;
        return Vec3{x, y, height(x, y)};
    };
    TriangleSoup soup;
    for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j)
        {
            std::array<Vec3, 4> quad{at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)};
            add_quad(soup, quad[0], quad[1], quad[2], quad[3]);
            if (!is_solid) continue;
            for (std::size_t s = 0; s < 4; ++s)
            {
                const Vec3& a = quad[s];
                const Vec3& b = quad[(s + 1) % 4];
                if (std::max({std::fabs(a.x), std::fabs(a.y)}) < half - 1e-9 ||
                    std::max({std::fabs(b.x), std::fabs(b.y)}) < half - 1e-9 ||
                    (a.x != b.x ? std::fabs(a.y) : std::fabs(a.x)) < half - 1e-9)
                    continue;
                add_quad(soup, b, a, {a.x, a.y, -3}, {b.x, b.y, -3});
            }
            for (Vec3& p : quad) p.z = -3;
            add_quad(soup, quad[3], quad[2], quad[1], quad[0]);
        }
    return soup;
}

/// Facets that lie in the domain with a step to spare.
SurfaceMesh part_well_inside(const TriangleSoup& soup)
{
    const LatticeGrid grid = domain();
    TriangleSoup out;
    for (std::size_t f = 0; f < soup.size(); ++f)
    {
        const auto is_inside = [&](const Vec3& p)
        {
            for (int axis = 0; axis < 3; ++axis)
            {
                const double index = (p[axis] - grid.origin[axis]) / dp;
                if (index < 1 || index > grid.n[static_cast<std::size_t>(axis)] - 2.0) return false;
            }
            return true;
        };
        const Vec3* p = &soup.vertices[3 * f];
        if (std::all_of(p, p + 3, is_inside)) out.vertices.insert(out.vertices.end(), p, p + 3);
    }
    MeshReport report;
    return repair_mesh(out, {}, 1, report);
}

/// Nodes 2 dp under the hills are inside, those above are not.
void expect_full_below_hills(const std::vector<Spans>& volume)
{
    const LatticeGrid grid = domain();
    for (std::uint32_t x = 0; x < grid.n[0]; ++x)
        for (std::uint32_t y = 0; y < grid.n[1]; ++y)
        {
            std::uint32_t nodes = 0;
            for (const Span& span : volume[x])
                if (span.y == y) nodes += span.z_end - span.z_begin;
            const double z = height(grid.origin.x + dp * x, grid.origin.y + dp * y);
            const double under = (z - grid.origin.z) / dp;
            ASSERT_GE(nodes, std::floor(under - 2) + 1) << x << ' ' << y;
            ASSERT_LE(nodes, under + 1) << x << ' ' << y;
        }
}

class LargeBody : public testing::TestWithParam<bool>
{
};

TEST_P(LargeBody, HasTheWallsInTheDomainThatTheWholeBodyHas)
{
    const TriangleSoup soup = hills(GetParam());
    const FittedDraw whole = fit(soup, GetParam(), BodyExtent::Whole);
    const FittedDraw part = fit(soup, GetParam(), BodyExtent::NearDomain);
    EXPECT_LT(part.body.measures.area, 0.1 * whole.body.measures.area) << "nothing was cut off";

    const auto n = static_cast<double>(whole.particles.size());
    ASSERT_GT(n, 1000);
    // Before relaxation 0.9 to 1.15 a dp^2.
    EXPECT_NEAR(static_cast<double>(part.particles.size()), n, 0.06 * n);
    const MeshQuery query(TriangleSoup(soup), 1);
    for (const Vec3& p : part.particles.positions) ASSERT_LT(query.closest_point(p).distance, 1e-9);
    EXPECT_LT(test::farthest_point_dp(part_well_inside(soup), part.particles.positions, dp, 4),
              0.92);
    if (GetParam()) expect_full_below_hills(part.volume);
}

INSTANTIATE_TEST_SUITE_P(SolidAndSheet, LargeBody, testing::Bool());

TEST(LargeBody, KeepsItsEdgesAndCornersInTheDomain)
{
    // One corner of a cube of 20 m lies in the domain.
    const FittedDraw part =
        fit(box({0.013, 0.021, 0.017}, {20, 20, 20}), true, BodyExtent::NearDomain);
    const auto count = [&](FitKind kind)
    { return std::count(part.particles.kinds.begin(), part.particles.kinds.end(), kind); };
    EXPECT_EQ(count(FitKind::Corner), 1);
    // The three edges are 0.98, 1.01 and 0.78 m long up to the end of the domain.
    EXPECT_NEAR(static_cast<double>(count(FitKind::Edge)), (0.98 + 1.01 + 0.78) / dp, 2);
}

TEST(LargeBody, StandsForTheVolumeOfWhatIsLeft)
{
    FittedDraw part = fit(hills(true), true, BodyExtent::NearDomain);
    FitMeasures& measures = part.body.measures;
    EXPECT_NEAR(measures.node_volume + measures.wall_volume, measures.volume,
                0.001 * measures.volume);
}

TEST(LargeBody, ThatHoldsTheDomainFillsIt)
{
    const FittedDraw part = fit(box({-20, -20, -20}, {20, 20, 20}), true, BodyExtent::NearDomain);
    std::size_t nodes = 0;
    for (const Spans& slab : part.volume)
        for (const Span& span : slab) nodes += span.z_end - span.z_begin;
    EXPECT_EQ(nodes, 41u * 41u * 33u);
    EXPECT_EQ(part.particles.size(), 0u);
}

TEST(LargeBody, BesideTheDomainHasNothingInIt)
{
    const FittedDraw part = fit(box({5, 5, 5}, {25, 25, 25}), true, BodyExtent::NearDomain);
    EXPECT_EQ(part.particles.size(), 0u);
    for (const Spans& slab : part.volume) EXPECT_TRUE(slab.empty());
}

TEST(SmallBody, FarBesideTheDomainHasNothingInIt)
{
    for (const double at : {3.0, 2e8, 1e15, 1e307})
        for (int axis = 0; axis < 3; ++axis)
        {
            Vec3 low{0.2, 0.2, 0.2};
            low[axis] = at;
            Vec3 high = low + Vec3{0.3, 0.3, 0.3};
            high[axis] = std::max(high[axis], 1.1 * at);
            const FittedDraw part = fit(box(low, high), true, BodyExtent::NearDomain);
            EXPECT_EQ(part.particles.size(), 0u) << at << ' ' << axis;
            EXPECT_TRUE(part.body.mesh.facets.empty()) << at << ' ' << axis;
            for (const Spans& slab : part.volume) EXPECT_TRUE(slab.empty());
        }
}

TEST(SmallBody, WhosePartsAreFarAboveEachOtherIsRefusedWhereBothCount)
{
    TriangleSoup soup = box({0.2, 0.2, 0.2}, {0.5, 0.5, 0.5});
    const TriangleSoup far = box({0.2, 0.2, 2e6}, {0.5, 0.5, 2e6 + 0.3});
    soup.vertices.insert(soup.vertices.end(), far.vertices.begin(), far.vertices.end());
    EXPECT_THROW(fit(soup, true, BodyExtent::Whole), GeometryError);
}

TEST(LargeBody, BeyondAllNumbersIsRefused)
{
    EXPECT_THROW(fit(box({0.2, 1e307, 0.3}, {0.3, 1.1e307, 0.4}), true, BodyExtent::Whole),
                 GeometryError);
}

/// The walls of a case in a domain of 2 x 2 x 2 m that draws `command` body-fitted.
///
/// after  what comes behind `<geometry>`: floating bodies, `<fppg>`
FittedWalls walls_of(const std::string& command, const std::string& after = {})
{
    const test::TemporaryFolder folder;
    test::CaseText text;
    text.dp = "0.05";
    text.pointmin = R"(<pointmin x="-1" y="-1" z="-1" />)";
    text.pointmax = R"(<pointmax x="1" y="1" z="1" />)";
    text.mainlist = R"(<setdrawmode mode="face" /><setmkbound mk="0" />)" + command;
    text.after_geometry = after;
    test::write_text(folder / "Case_Def.xml", text.text());
    CaseOptions options;
    options.fit = FitChoice::On;
    const CaseDef def = read_case(folder / "Case_Def.xml", options);
    LatticeReport report;
    return draw_scene(make_scene(def), 2, {}, report).walls;
}

double area_laid(const FittedWalls& walls)
{
    double area = 0;
    for (const FittedBody& body : walls.bodies) area += body.report.area;
    return area;
}

/// A pipe along x, from -20 to `end`, without its ends.
std::string pipe_to(const std::string& end)
{
    return R"(<drawcylinder radius="0.3" mask="1|2"><point x="-20" y="0.1" z="0.1" /><point x=")" +
           end + R"(" y="0.1" z="0.1" /></drawcylinder>)";
}

TEST(LargeBody, ThatIsAPipeIsMadeInTheDomainAlone)
{
    // A pipe of 40 m, and one so long that no machine could hold its facets.
    for (const std::string end : {"20", "2e7"})
    {
        const FittedWalls walls = walls_of(pipe_to(end));
        const double area = 2 * std::numbers::pi * 0.3 * 2;
        EXPECT_NEAR(static_cast<double>(walls.particles.size()) * dp * dp, area, 0.05 * area);
        for (const Vec3& p : walls.particles.positions)
            EXPECT_NEAR(std::hypot(p.y - 0.1, p.z - 0.1), 0.3, 0.01 * dp);
        EXPECT_LT(area_laid(walls), 3 * area);
    }
}

TEST(LargeBody, ThatIsABallIsFineInTheDomainAlone)
{
    // Of 200 m, 1e5 m and 1e8 m in radius, through (0.1, 0, 0) along (1, 0.5, 0.2).
    const Vec3 normal = Vec3{1, 0.5, 0.2} / norm(Vec3{1, 0.5, 0.2});
    for (const double radius : {200.0, 1e5, 1e8})
    {
        const Vec3 center = Vec3{0.1, 0, 0} - radius * normal;
        const FittedWalls walls =
            walls_of(fmt::format(R"(<drawsphere radius="{}"><point x="{}" y="{}" z="{}" />)"
                                 "</drawsphere>",
                                 radius, center.x, center.y, center.z));
        const std::vector<Vec3>& places = walls.particles.positions;
        double farthest = 0;
        for (const Vec3& p : places)
            farthest = std::max(farthest, std::fabs(norm(p - center) - radius));
        EXPECT_LT(farthest, std::max(0.006 * dp, 4e-16 * radius)) << radius;
        // As flat as a plane here, which passes all of the four sides along x: |y|, |z| < 1.
        const double area = 2 * 2 / normal.x;
        EXPECT_NEAR(static_cast<double>(places.size()) * dp * dp, area, 0.1 * area) << radius;
        EXPECT_LT(area_laid(walls), 20 * area) << radius;
    }
}

const std::string floats =
    R"(<floatings><floating mkbound="0" relativeweight="0.5" /></floatings>)";
const std::string lies_inside = R"(<fppg><bodyfitted place="inside" /></fppg>)";

TEST(LargeBody, ThatIsCutByThePlaneOfA2DCaseIsLaidInTheDomainAlone)
{
    // A strip 0.6 m wide: 66 km and 6 million km long.
    for (const double top : {65536.0, 6e9})
    {
        const test::TemporaryFolder folder;
        test::CaseText text;
        text.dp = "0.05";
        text.pointmin = R"(<pointmin x="-1" y="0" z="-1" />)";
        text.pointmax = R"(<pointmax x="1" y="0" z="1" />)";
        text.mainlist = fmt::format(
            R"(<setdrawmode mode="face" /><setmkbound mk="0" /><drawbox><boxfill>all</boxfill>)"
            R"(<point x="-0.3" y="-0.2" z="-0.4" /><size x="0.6" y="0.4" z="{}" /></drawbox>)"
            R"(<drawbox><boxfill>all</boxfill><point x="5" y="-0.2" z="0" /><size x="1" y="0.4" z="1" />)"
            R"(</drawbox>)",
            top);
        test::write_text(folder / "Case_Def.xml", text.text());
        CaseOptions options;
        options.fit = FitChoice::On;
        const CaseDef def = read_case(folder / "Case_Def.xml", options);
        LatticeReport report;
        const FittedWalls walls = draw_scene(make_scene(def), 2, {}, report).walls;
        EXPECT_EQ(walls.bodies.size(), 2u)
            << "one of them has no particles, and is fitted all the same";
        // The bottom and, up to the last nodes at 0.95 m and half a step, two sides.
        EXPECT_NEAR(static_cast<double>(walls.particles.size()) * dp, 0.6 + 2 * 1.375, 3 * dp);
        for (const Vec3& p : walls.particles.positions)
            EXPECT_LT(std::min(std::fabs(std::fabs(p.x) - 0.3), std::fabs(p.z + 0.4)), 1e-6 * dp);
    }
}

TEST(LargeBody, WithACornerFarAwayHasParticlesOnItsFaces)
{
    // Two of its faces are 0.6 m wide and 1,200 km long.
    const FittedWalls walls = walls_of(
        R"(<drawpyramid><point x="0.45" y="0.52" z="1.03" /><point x="0.03" y="0.5" z="0.6" />)"
        R"(<point x="-0.2" y="1.33" z="0.1" /><point x="1" y="1186837.6" z="0" />)"
        R"(<point x="1.1" y="1" z="27.6" /><point x="0.003" y="1" z="0.13" /></drawpyramid>)");
    EXPECT_GT(walls.particles.size(), 200u);
    const SurfaceMesh& mesh = walls.bodies[0].mesh;
    for (std::size_t f = 0; f < mesh.facets.size(); ++f)
    {
        const auto& [a, b, c] = mesh.facets[f];
        const Vec3 twice =
            cross(mesh.vertices[b] - mesh.vertices[a], mesh.vertices[c] - mesh.vertices[a]);
        if (norm(twice) < dp * dp) continue;
        EXPECT_GT(dot(twice, mesh.normals[f]) / norm(twice), 0.999) << f;
    }
}

TEST(LargeBody, OfMoreParticlesThanAFileHoldsIsLaidInTheDomainAlone)
{
    // 2,000 km by 2,000 km: 1.6e15 particles, 1,600 of them in the domain.
    const FittedWalls walls =
        walls_of(R"(<drawbox><boxfill>bottom</boxfill><point x="-1e6" y="-1e6" z="-0.31" />)"
                 R"(<size x="2e6" y="2e6" z="1" /></drawbox>)");
    EXPECT_NEAR(static_cast<double>(walls.particles.size()) * dp * dp, 1.95 * 1.95, 0.4);
}

TEST(LargeBody, ThatFloatsIsMadeWhole)
{
    EXPECT_NEAR(area_laid(walls_of(pipe_to("20"), floats)), 2 * std::numbers::pi * 0.3 * 40, 0.5);
}

TEST(LargeBody, ThatIsMadeWholeIsRefusedWhereNoFileCouldHoldIt)
{
    // In the domain alone there are 1,500 particles of it.
    for (const std::string& after : {floats, lies_inside})
        EXPECT_THROW(walls_of(pipe_to("2e9"), after), GeometryError);
}

TEST(LargeBody, ThatIsADiscIsLaidInTheDomainAlone)
{
    const FittedWalls walls = walls_of(
        R"(<drawcylinder radius="240"><point x="0" y="0" z="-0.3" /><point x="0" y="0" z="0.4" />)"
        R"(</drawcylinder>)");
    const double area = 2 * 1.95 * 1.95;
    EXPECT_NEAR(static_cast<double>(walls.particles.size()) * dp * dp, area, 0.1 * area);
    for (const Vec3& p : walls.particles.positions)
        EXPECT_LT(std::min(std::fabs(p.z + 0.3), std::fabs(p.z - 0.4)), 1e-6 * dp);
    EXPECT_LT(area_laid(walls), 20 * area);
}

} // namespace
} // namespace fppg
