#include "fppg/features.h"
#include "fppg/surface_mesh.h"

#include "files/helpers.h"
#include "files/vtk_reader.h"
#include "meshes/test_shapes.h"

#include <algorithm>
#include <set>

namespace fppg
{

namespace
{

VtkFile vtk_of(const FittedWalls& walls)
{
    return VtkFile(written([&](OutputFile& file) { write_features_vtk(file, walls); }));
}

FittedBody body_of(const TriangleSoup& soup, std::uint16_t mk)
{
    FittedBody body;
    body.mk = mk;
    body.mesh = repair_mesh(soup, {}, 1, body.report);
    body.features = find_features(body.mesh, {});
    return body;
}

TEST(WriteFeaturesVtk, ShowsTheEdgesAndCornersOfABox)
{
    FittedWalls walls;
    walls.bodies.push_back(body_of(test::box({0, 0, 0}, {1, 2, 3}), 10));
    const VtkFile file = vtk_of(walls);
    EXPECT_EQ(file.points.size(), 3U * 8);
    EXPECT_EQ(file.cells.at("VERTICES").size(), 2U * 8);
    EXPECT_EQ(file.cells.at("LINES").size(), 3U * 12);
    EXPECT_EQ(file.types.at("Length"), "float");
    const std::vector<double>& length = file.arrays.at("Length");
    ASSERT_EQ(length.size(), 20U);
    for (const double value : {1.0, 2.0, 3.0})
        EXPECT_EQ(std::count(length.begin() + 8, length.end(), value), 4) << value;
    EXPECT_EQ(std::count(length.begin(), length.begin() + 8, 0), 8);
}

TEST(WriteFeaturesVtk, PutsEveryLineWhereItsLengthSays)
{
    FittedWalls walls;
    walls.bodies.push_back(body_of(test::box({5, 5, 5}, {6, 7, 8}), 10));
    walls.bodies.push_back(body_of(test::box({0, 0, 0}, {1, 2, 3}), 11));
    const VtkFile file = vtk_of(walls);
    const std::vector<int>& lines = file.cells.at("LINES");
    std::size_t cell = file.cells.at("VERTICES").size() / 2;
    for (std::size_t at = 0; at < lines.size(); at += static_cast<std::size_t>(lines[at]) + 1)
    {
        double length = 0;
        for (int i = 1; i < lines[at]; ++i)
            for (std::size_t axis = 0; axis < 3; ++axis)
            {
                const auto p =
                    3 * static_cast<std::size_t>(lines[at + static_cast<std::size_t>(i)]);
                const auto q =
                    3 * static_cast<std::size_t>(lines[at + static_cast<std::size_t>(i) + 1]);
                length += std::abs(file.points.at(p + axis) - file.points.at(q + axis));
            }
        EXPECT_EQ(length, file.arrays.at("Length").at(cell++));
    }
    EXPECT_EQ(cell, file.arrays.at("Length").size());
}

TEST(WriteFeaturesVtk, GivesCellsTheMkAndNumberOfTheirBody)
{
    FittedWalls walls;
    walls.bodies.push_back(body_of(test::box({0, 0, 0}, {1, 1, 1}), 300));
    walls.bodies.push_back(body_of(test::box({2, 0, 0}, {3, 1, 1}), 10));
    const VtkFile file = vtk_of(walls);
    std::vector<double> mk;
    std::vector<double> body;
    for (const std::size_t cells : {8U, 12U}) // points of both bodies, then their lines
        for (const int b : {0, 1})
        {
            mk.insert(mk.end(), cells, b == 0 ? 300 : 10);
            body.insert(body.end(), cells, b);
        }
    EXPECT_EQ(file.arrays.at("Mk"), mk);
    EXPECT_EQ(file.arrays.at("Body"), body);
}

TEST(WriteFeaturesVtk, ClosesALoopAndLeavesUnusedVerticesOut)
{
    FittedBody body;
    body.mk = 12;
    body.mesh.vertices = {{9, 9, 9}, {0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
    body.features.lines.push_back({{1, 2, 3, 4}, {0, 1, 2, 3}, true, 4});
    FittedWalls walls;
    walls.bodies.push_back(body);
    const VtkFile file = vtk_of(walls);
    EXPECT_EQ(file.points, (std::vector<float>{0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0}));
    EXPECT_EQ(file.cells.at("LINES"), (std::vector<int>{5, 0, 1, 2, 3, 0}));
    EXPECT_FALSE(file.cells.contains("VERTICES"));
}

TEST(WriteFeaturesVtk, WritesAFileWithoutCellsForWallsWithoutFeatures)
{
    FittedWalls walls;
    walls.bodies.emplace_back();
    const VtkFile file = vtk_of(walls);
    EXPECT_TRUE(file.points.empty() && file.cells.empty());
    EXPECT_TRUE(file.arrays.at("Mk").empty());
}

TEST(WriteWallParticlesVtk, HoldsPositionsMkAndKind)
{
    WallParticles particles;
    particles.positions = {{1, 2, 3}, {4, 5, 6}};
    particles.mk = {10, 300};
    particles.kinds = {FitKind::Corner, FitKind::Surface};
    const VtkFile file(written([&](OutputFile& out) { write_wall_particles_vtk(out, particles); }));
    EXPECT_EQ(file.points, (std::vector<float>{1, 2, 3, 4, 5, 6}));
    EXPECT_EQ(file.cells.at("VERTICES"), (std::vector{1, 0, 1, 1}));
    EXPECT_EQ(file.arrays.at("Mk"), (std::vector<double>{10, 300}));
    EXPECT_EQ(file.arrays.at("Kind"), (std::vector<double>{0, 2}));
}

} // namespace

} // namespace fppg
