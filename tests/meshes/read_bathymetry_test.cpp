#include "fppg/shapes.h"

#include <gtest/gtest.h>

#include "fppg/error.h"
#include "meshes/stl_files.h"

namespace fppg
{

namespace
{

using test::TemporaryFile;

BathymetryGrid unit_grid()
{
    BathymetryGrid grid;
    grid.spacing = 1;
    return grid;
}

/// Heights of the corners at (x, y) of all facets.
std::vector<double> heights(const std::string& content, const BathymetryGrid& grid, double x,
                            double y)
{
    const MeshFile mesh =
        read_mesh_file(TemporaryFile(content).path(), {MeshFormat::Bathymetry, {}, grid}, 2);
    std::vector<double> found;
    for (const Vec3& v : mesh.soup.vertices)
        if (std::abs(v.x - x) < 1e-6 && std::abs(v.y - y) < 1e-6) found.push_back(v.z);
    return found;
}

/// Heights x / 2 at whole x from 0 to 6 and y from 0 to 4.
std::string slope()
{
    std::string text = "x y z\n";
    for (int y = 0; y <= 4; ++y)
        for (int x = 0; x <= 6; ++x) text += fmt::format("{},{};{}\n", x, y, 0.5 * x);
    return text;
}

TEST(ReadBathymetry, TakesTheHeightsOfPointsOnItsNodes)
{
    for (const double z : heights(slope(), unit_grid(), 3, 2)) EXPECT_EQ(z, 1.5);
    EXPECT_EQ(heights(slope(), unit_grid(), 0, 0).size(), 2U);
}

TEST(ReadBathymetry, InterpolatesBetweenPoints)
{
    BathymetryGrid grid = unit_grid();
    grid.spacing = 0.5;
    ASSERT_FALSE(heights(slope(), grid, 2.5, 1.5).empty());
    for (const double z : heights(slope(), grid, 2.5, 1.5)) EXPECT_NEAR(z, 1.25, 1e-9);
}

TEST(ReadBathymetry, GoesOnAsExpandsSaysAndCutsAtANegativeSize)
{
    BathymetryGrid grid = unit_grid();
    grid.expands[0] = {2, 7.0, 3, std::nullopt};
    grid.expands[1] = {-1.5, std::nullopt, 0, std::nullopt};
    EXPECT_EQ(heights(slope(), grid, -2, 1).at(0), 7);
    EXPECT_EQ(heights(slope(), grid, -5, 1).at(0), 7);
    EXPECT_EQ(heights(slope(), grid, 4.5, 1).at(0), 2.25);
    EXPECT_TRUE(heights(slope(), grid, 5, 1).empty());
}

TEST(ReadBathymetry, BringsBothEndsOfAPeriodToOneHeight)
{
    BathymetryGrid grid = unit_grid();
    grid.periods[0] = {1.5, 1};
    for (const double x : {-1.0, 0.0, 6.0, 7.0})
        EXPECT_EQ(heights(slope(), grid, x, 1).at(0), 1.5) << x; // mean of 0.75 and 2.25
    EXPECT_EQ(heights(slope(), grid, 1.5, 1).at(0), 0.75);
    EXPECT_TRUE(heights(slope(), grid, 1, 1).empty());
}

TEST(ReadBathymetry, RefusesAGridFileThatIsNoGrid)
{
    BathymetryGrid grid;
    grid.is_grid_file = true;
    EXPECT_EQ(heights("0 0 1\n1 0 2\n0 1 3\n1 1 4\n", grid, 1, 1).at(0), 4);
    EXPECT_THROW(heights("0 0 1\n1 0 2\n0 1 3\n1.5 1 4\n", grid, 1, 1), GeometryError);
    EXPECT_THROW(heights("0 0 1\n1 0 2\n0 1 3\n", grid, 1, 1), GeometryError);
}

} // namespace

} // namespace fppg
