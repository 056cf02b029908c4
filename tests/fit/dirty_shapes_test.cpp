#include "fit/dirty_shapes.h"

#include "fit/wall_of_soup.h"
#include "fppg/shapes.h"
#include "meshes/spans_helpers.h"

#include <gtest/gtest.h>

namespace fppg
{
namespace
{

using namespace test;

const double sphere_volume = fit_soup(sphere(3)).zone.body_volume;

/// The mesh comes out with the volume of the clean shape, within 1 %, and one warning names what
/// was mended.
void expect_mended(const TriangleSoup& soup, double volume, const std::string& warning)
{
    const FittedMesh fitted = fit_soup(soup);
    EXPECT_NEAR(fitted.volume(), volume, 0.01 * volume);
    std::string all;
    for (const std::string& text : fitted.warnings) all += text + "\n";
    EXPECT_NE(all.find(warning), std::string::npos) << all;
}

TEST(DirtyShapes, CopiesOfFacetsAreLeftOut)
{
    expect_mended(sphere_with_copies(), sphere_volume, "102 facets are copies of another");
}

TEST(DirtyShapes, TurnedFacetsAreTurnedBack)
{
    expect_mended(sphere_with_turned_facets(), sphere_volume, "facets look inwards");
}

TEST(DirtyShapes, SmallHolesCountAsClosed)
{
    expect_mended(sphere_with_holes(), sphere_volume, "count as closed");
}

TEST(DirtyShapes, ABowlHasNoInside)
{
    const FittedMesh fitted = fit_soup(open_bowl());
    EXPECT_FALSE(fitted.zone.has_inside);
    EXPECT_EQ(count_nodes(fitted.zone.volume), 0u);
    EXPECT_NE(fitted.warnings.back().find("bounds no volume"), std::string::npos);
}

TEST(DirtyShapes, FacetsAreSplitAtTJunctions)
{
    expect_mended(cube_with_t_junctions(), 8, "these facets are split there");
}

TEST(DirtyShapes, FacetsWithoutAreaAreLeftOut)
{
    expect_mended(sphere_with_degenerate_facets(), sphere_volume, "80 facets are without area");
}

TEST(DirtyShapes, AFinIsNoPartOfTheInside)
{
    expect_mended(cube_with_a_fin(), 8, "2 of 14 facets bound no volume");
}

TEST(DirtyShapes, OverlappingPartsCountOnce)
{
    // Two spheres of radius 1, 1 apart, share 5 pi / 12.
    const double ideal = 4.1887902;
    const double lens = 1.3089969 * sphere_volume / ideal;
    expect_mended(overlapping_spheres(), 2 * sphere_volume - lens, "count once");
}

TEST(DirtyShapes, ACavityStaysEmpty)
{
    const FittedMesh fitted = fit_soup(sphere_with_cavity());
    EXPECT_NEAR(fitted.volume(), 0.875 * sphere_volume, 0.01 * sphere_volume);
}

TEST(DirtyShapes, LooseFacetsAreJoined)
{
    expect_mended(sphere_of_loose_facets(), sphere_volume, "The facets do not meet");
}

TEST(InsideByVote, IsTheInsideOfACleanMeshWithoutDispute)
{
    LatticeGrid grid = cube_grid({-1.2, -1.2, -1.2}, 0.11, 24);
    grid.stretch = {0.96, 1.05, 1.02};
    for (const TriangleSoup& soup : {sphere(3), unit_cube(), overlapping_spheres()})
    {
        std::uint64_t disputed = 1;
        const SpanSet voted = inside_by_vote(soup, grid, 1, disputed);
        EXPECT_EQ(nodes_of(voted, grid), nodes_of(inside_spans(soup, grid, 1), grid));
        EXPECT_EQ(disputed, 0u);
    }
}

TEST(InsideByVote, OfASphereWithHolesIsThatOfTheSphere)
{
    const LatticeGrid grid = cube_grid({-1.2, -1.2, -1.2}, 0.057, 44);
    std::uint64_t disputed = 0;
    const SpanSet voted = inside_by_vote(sphere_with_holes(), grid, 2, disputed);
    const auto found = nodes_of(voted, grid);
    const auto expected = nodes_of(inside_spans(sphere(3), grid, 1), grid);
    std::size_t wrong = 0;
    for (std::size_t at = 0; at < found.size(); ++at) wrong += found[at] != expected[at] ? 1 : 0;
    EXPECT_LT(wrong, 20u);
    EXPECT_GT(disputed, 0u);
    EXPECT_LT(disputed, 500u);
}

} // namespace
} // namespace fppg
