#include "relax/slide.h"

#include "fit/fit_shapes.h"
#include "relax/surface_forces.h"

#include <gtest/gtest.h>

namespace fppg
{

namespace
{

using namespace test;

WorkMesh work_mesh(const TriangleSoup& soup)
{
    const FitInput input(soup, 0.1);
    return make_work_mesh(input.mesh, input.features, 10, 1);
}

SlidePlace on_top(const WorkMesh& mesh, const Vec3& position)
{
    for (std::uint32_t f = 0; f < mesh.facets.size(); ++f)
        if (mesh.facets[f].normal.z > 0.5)
            return place_on_facet(mesh, mesh.facets[f].parent, position);
    return {};
}

} // namespace

TEST(Slide, GoesAlongAFeatureEdgeInsteadOfOverIt)
{
    const WorkMesh mesh = work_mesh(box({0, 0, 0}, {1, 1, 1}));
    SlidePlace place = on_top(mesh, {0.95, 0.4, 1});
    ASSERT_TRUE(slide(mesh, place, {0.3, 0.3, 0}, 1e-12));
    EXPECT_NEAR(place.position.x, 1, 1e-11);
    EXPECT_LT(place.position.x, 1);
    EXPECT_NEAR(place.position.y, 0.7, 1e-9);
    EXPECT_EQ(place.position.z, 1);
}

TEST(Slide, StopsInACorner)
{
    const WorkMesh mesh = work_mesh(box({0, 0, 0}, {1, 1, 1}));
    SlidePlace place = on_top(mesh, {0.95, 0.9, 1});
    ASSERT_TRUE(slide(mesh, place, {0.3, 0.4, 0}, 1e-12));
    EXPECT_NEAR(place.position.x, 1, 1e-9);
    EXPECT_NEAR(place.position.y, 1, 1e-9);
    EXPECT_EQ(mesh.facets[place.facet].normal.z, 1);
}

TEST(Slide, FollowsABentSurface)
{
    const WorkMesh mesh = work_mesh(sphere(4));
    SlidePlace place = on_top(mesh, {0, 0, 1});
    const Vec3 before = place.position;
    const Vec3 normal = mesh.facets[place.facet].normal;
    const Vec3 step = Vec3{0.2, 0, 0} - normal * (0.2 * normal.x);
    ASSERT_TRUE(slide(mesh, place, step, 1e-12));
    EXPECT_NEAR(norm(place.position), 1, 0.01);
    EXPECT_NEAR(norm(place.position - before), norm(step), 0.005);
}

TEST(Slide, LeavesThePlaceAsItIsWhenItWouldCrossTooManyFacets)
{
    const WorkMesh mesh = work_mesh(sphere(6));
    SlidePlace place = on_top(mesh, {0, 0, 1});
    const SlidePlace before = place;
    const Vec3 normal = mesh.facets[place.facet].normal;
    const Vec3 step = Vec3{3, 0, 0} - normal * (3 * normal.x);
    EXPECT_FALSE(slide(mesh, place, step, 1e-12));
    EXPECT_EQ(place.position, before.position);
    EXPECT_EQ(place.facet, before.facet);
}

TEST(PlaceOnFacet, OfAFacetWithoutAreaIsItsCorner)
{
    WorkMesh mesh = work_mesh(box({0, 0, 0}, {1, 1, 1}));
    const Vec3 corner{0.3, 0.4, 1};
    mesh.facets[0].corners = {corner, corner, corner};
    const SlidePlace place = place_on_facet(mesh, mesh.facets[0].parent, {0.3, 0.5, 1});
    EXPECT_EQ(place.position, corner);
}

TEST(StiffestMode, IsThatOfAHexagonalLayer)
{
    // Eigenvalues of the Hessian over the Brillouin zone, from a program of their own.
    EXPECT_NEAR(stiffest_mode(0.8), 8.0, 0.1);
    EXPECT_NEAR(stiffest_mode(1.0), 6.5, 0.1);
    EXPECT_NEAR(stiffest_mode(1.2), 4.8, 0.1);
    EXPECT_NEAR(stiffest_mode(2.0), 4.6, 0.1);
}

} // namespace fppg
