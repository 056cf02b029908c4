#include "fit/walk.h"

#include "fit/fit_shapes.h"

#include <gtest/gtest.h>

namespace fppg
{

namespace
{

using namespace test;

WorkMesh work_of(const FitInput& input, double longest)
{
    return make_work_mesh(input.mesh, input.features, longest, 1);
}

double area_of(const WorkMesh& work)
{
    double area = 0;
    for (std::uint32_t f = 0; f < work.facets.size(); ++f) area += work.area(f);
    return area;
}

} // namespace

TEST(WorkMesh, HalvesLongSidesAndKeepsTheArea)
{
    const FitInput input(box({0, 0, 0}, {3, 2, 1}), 0.1);
    const WorkMesh work = work_of(input, 0.4);
    EXPECT_NEAR(area_of(work), 22, 1e-12);
    for (const WorkFacet& facet : work.facets)
        for (std::size_t s = 0; s < 3; ++s)
            EXPECT_LE(norm(facet.corners[(s + 1) % 3] - facet.corners[s]), 0.4);
}

TEST(WorkMesh, JoinsPiecesSideToSideButNotAcrossFeatures)
{
    const FitInput input(box({0, 0, 0}, {3, 2, 1}), 0.1);
    const WorkMesh work = work_of(input, 0.4);
    for (std::uint32_t f = 0; f < work.facets.size(); ++f)
        for (std::size_t s = 0; s < 3; ++s)
        {
            const Vec3 middle =
                0.5 * (work.facets[f].corners[s] + work.facets[f].corners[(s + 1) % 3]);
            int faces = 0;
            const Vec3 size{3, 2, 1};
            for (int axis = 0; axis < 3; ++axis)
                faces += middle[axis] == 0 || middle[axis] == size[axis];
            const std::uint32_t next = work.facets[f].neighbours[s];
            ASSERT_EQ(next == no_index, faces == 2);
            if (next == no_index) continue;
            const auto& back = work.facets[next].neighbours;
            EXPECT_TRUE(std::find(back.begin(), back.end(), f) != back.end());
            EXPECT_EQ(work.facets[next].normal, work.facets[f].normal);
        }
}

TEST(WorkMesh, FindsThePieceOfAPoint)
{
    const FitInput input(box({0, 0, 0}, {3, 2, 1}), 0.1);
    for (const double longest : {0.4, 0.04})
    {
        const WorkMesh work = work_of(input, longest);
        for (std::uint32_t f = 0; f < work.facets.size(); ++f)
        {
            const auto& c = work.facets[f].corners;
            const std::uint32_t parent = work.facets[f].parent;
            EXPECT_EQ(work.locate(parent, (c[0] + c[1] + c[2]) / 3), f);
            // Of points on a side, either piece that has it.
            const Vec3 on_side = 0.5 * (c[0] + c[1]);
            const std::uint32_t at = work.locate(parent, on_side);
            EXPECT_TRUE(at == f || at == work.facets[f].neighbours[0]);
        }
    }
}

TEST(WorkMesh, OfAFacetThousandsOfStepsLongFindsPiecesInTheirBoxes)
{
    TriangleSoup soup;
    add_facet(soup, {0, 0, 0}, {400, 0, 1}, {0, 400, 2});
    const FitInput input(soup, 0.1);
    const WorkMesh work = work_of(input, 1.6);
    ASSERT_GT(work.facets.size(), 50000u);
    // All of them, which to ask one by one for each would take minutes.
    for (std::uint32_t f = 0; f < work.facets.size(); ++f)
    {
        const auto& c = work.facets[f].corners;
        ASSERT_EQ(work.locate(0, (c[0] + c[1] + c[2]) / 3), f);
    }
}

TEST(Walk, EndsAtASliverThatLiesAcrossItsNormal)
{
    // A sliver 6e-8 m high in the plane y = 0 takes the normal of the facet beside it.
    const Vec3 a{1.426, 0, 0.09}, b{1.426, -0.587, 0.09}, c{1.426, 0, 0.09000006},
        d{0.992, 0, -0.738}, e{0.992, -0.587, -0.738};
    TriangleSoup soup;
    add_facet(soup, a, c, d);
    add_facet(soup, a, b, c);
    add_facet(soup, c, e, d);
    add_facet(soup, c, b, e);
    const FitInput input(soup, 0.1);
    const WorkMesh work = work_of(input, 10);
    for (std::uint32_t f = 0; f < work.facets.size(); ++f)
        for (int i = 0; i < 36; ++i)
        {
            const auto& facet = work.facets[f];
            const Vec3 x =
                (facet.corners[1] - facet.corners[0]) / norm(facet.corners[1] - facet.corners[0]);
            const double angle = std::numbers::pi * i / 18;
            const Vec3 way = x * std::cos(angle) + cross(facet.normal, x) * std::sin(angle);
            for (const Vec3& corner : facet.corners)
            {
                const SurfaceRay end = walk(work, {corner, f, way}, 0.2);
                if (end.facet == no_index) continue;
                EXPECT_LT(end.position.y, 1e-6) << f << ' ' << i;
                EXPECT_GT(end.position.y, -0.587 - 1e-6) << f << ' ' << i;
            }
        }
}

TEST(Walk, RoundASphereComesBack)
{
    const FitInput input(sphere(5), 0.1);
    const WorkMesh work = work_of(input, 10);
    const std::uint32_t facet = work.locate(0, input.mesh.vertices[input.mesh.facets[0][0]]);
    const auto& c = work.facets[facet].corners;
    const Vec3 start = (c[0] + c[1] + c[2]) / 3;
    const Vec3 direction = (c[1] - c[0]) / norm(c[1] - c[0]);
    const SurfaceRay end = walk(work, {start, facet, direction}, 2 * std::numbers::pi);
    ASSERT_NE(end.facet, no_index);
    EXPECT_LE(norm(end.position - start), 0.1);
    EXPECT_GE(dot(end.direction, direction), 0.95);
    EXPECT_LE(std::abs(norm(end.position) - 1), 0.002);
}

TEST(Walk, GoesStraightOverPiecesOfAPlane)
{
    const FitInput input(box({0, 0, 0}, {3, 2, 1}), 0.1);
    const WorkMesh work = work_of(input, 0.2);
    const Vec3 from{1.53, 1.02, 1};
    const auto depth = [&](std::uint32_t f)
    {
        return norm(work.facets[f].corners[0] + work.facets[f].corners[1] +
                    work.facets[f].corners[2] - 3 * from);
    };
    std::uint32_t facet = 0;
    for (std::uint32_t f = 1; f < work.facets.size(); ++f)
        if (depth(f) < depth(facet)) facet = f;
    facet = work.locate(work.facets[facet].parent, from);
    const Vec3 direction{0.8, 0.6, 0};
    const SurfaceRay end = walk(work, {from, facet, direction}, 1);
    EXPECT_LE(norm(end.position - (from + direction)), 1e-14);
    EXPECT_LE(norm(end.direction - direction), 1e-14);
}

TEST(Walk, EndsAtAFeature)
{
    const FitInput input(box({0, 0, 0}, {1, 1, 1}), 0.1);
    const WorkMesh work = work_of(input, 10);
    const auto& facet = work.facets[0];
    const Vec3 start = (facet.corners[0] + facet.corners[1] + facet.corners[2]) / 3;
    const Vec3 direction =
        (facet.corners[1] - facet.corners[0]) / norm(facet.corners[1] - facet.corners[0]);
    EXPECT_EQ(walk(work, {start, 0, direction}, 2).facet, no_index);
}

} // namespace fppg
