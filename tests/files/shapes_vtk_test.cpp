#include "files/helpers.h"
#include "files/vtk_reader.h"

namespace fppg
{

namespace
{

VtkFile vtk_of(const std::vector<ShapePolygons>& shapes)
{
    return VtkFile(written([&](OutputFile& file) { write_shapes_vtk(file, shapes); }));
}

const ShapePolygons triangle_and_line{
    4, 10, {{0, 0, 0}, {1, 0, 0}, {1, 1, 0.1}}, {{0, 1, 2}, {0, 2}}};

/// As in the files of GenCase v5.4: those of lines before those of faces.
TEST(WriteShapesVtk, NumbersEachPlaceOnceInOrderOfUse)
{
    const VtkFile file = vtk_of({triangle_and_line, triangle_and_line});
    EXPECT_EQ(file.points, (std::vector<float>{0, 0, 0, 1, 1, 0.1f, 1, 0, 0}));
    EXPECT_EQ(file.cells.at("POLYGONS"), (std::vector<int>{3, 0, 2, 1, 3, 0, 2, 1}));
    EXPECT_EQ(file.cells.at("LINES"), (std::vector<int>{2, 0, 1, 2, 0, 1}));
}

TEST(WriteShapesVtk, OrdersCellValuesAsPointsLinesFaces)
{
    const ShapePolygons point{7, -1, {{0, 0, 0}}, {{0}}};
    const VtkFile file = vtk_of({triangle_and_line, point});
    EXPECT_EQ(file.cells.at("VERTICES"), (std::vector<int>{1, 0}));
    EXPECT_EQ(file.arrays.at("Mk"), (std::vector<double>{-1, 10, 10}));
    EXPECT_EQ(file.arrays.at("ObjId"), (std::vector<double>{7, 4, 4}));
}

TEST(WriteShapesVtk, LeavesEmptyPartsOut)
{
    const VtkFile file =
        vtk_of({{0, 10, {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}, {{0, 1, 2, 3}}}});
    EXPECT_EQ(file.cells.size(), 1U);
    EXPECT_EQ(file.cells.at("POLYGONS"), (std::vector<int>{4, 0, 1, 2, 3}));
}

TEST(WriteOffLatticePointsVtk, KeepsPlacesInDoublesWithMkAndType)
{
    OffLatticePoints points;
    points.positions = {{0.1, 0.2, 0.3}, {0.4, 0.5, 0.6}};
    points.mk = {1, 10};
    points.types = {ParticleType::Fluid, ParticleType::Floating};
    const VtkFile file =
        VtkFile(written([&](OutputFile& out) { write_off_lattice_points_vtk(out, points); }));
    EXPECT_EQ(file.double_points, (std::vector<double>{0.1, 0.2, 0.3, 0.4, 0.5, 0.6}));
    EXPECT_EQ(file.cells.at("VERTICES"), (std::vector<int>{1, 0, 1, 1}));
    EXPECT_EQ(file.arrays.at("Mk"), (std::vector<double>{1, 10}));
    EXPECT_EQ(file.arrays.at("Type"), (std::vector<double>{3, 2}));
    EXPECT_EQ(file.types.at("Mk"), "unsigned_char");
}

} // namespace

} // namespace fppg
