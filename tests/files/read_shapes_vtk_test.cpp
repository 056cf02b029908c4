#include "fppg/error.h"
#include "fppg/read_shapes.h"

#include "files/helpers.h"

namespace fppg
{

namespace
{

std::vector<ShapePolygons> read_text_file(const std::string& text)
{
    const TestFolder folder;
    std::ofstream(folder / "shape.vtk", std::ios::binary) << text;
    return read_shapes_vtk(folder / "shape.vtk");
}

const std::string ascii =
    "# vtk DataFile Version 3.0\nvtk output\nASCII\nDATASET POLYDATA\n"
    "POINTS 4 float\n0 0 0  1 0 0\n1 1.1 0\n0 1 0\n";

TEST(ReadShapesVtk, ReadsBackWhatIsWritten)
{
    const std::vector<ShapePolygons> shapes{
        {4, 10, {{0, 0, 0}, {1, 0, 0}, {1, 1, 0.1}}, {{0, 1, 2}, {0, 2}}},
        {5, 11, {{0, 0, 2}, {1, 0, 2}, {1, 1, 2}, {0, 1, 2}}, {{0, 1, 2, 3}}}};
    const TestFolder folder;
    OutputFile file(folder / "shape.vtk");
    write_shapes_vtk(file, shapes);
    file.commit();
    const auto found = read_shapes_vtk(folder / "shape.vtk");
    ASSERT_EQ(found.size(), 1U);
    EXPECT_EQ(found[0].polygons,
              (std::vector<std::vector<std::uint32_t>>{{0, 2, 1}, {3, 4, 5, 6}}));
    EXPECT_EQ(found[0].vertices[1].z, static_cast<double>(0.1f));
    EXPECT_EQ(found[0].vertices[6].z, 2);
}

TEST(ReadShapesVtk, ReadsTextAndRoundsToTheWidthOfBinaryFiles)
{
    const auto found = read_text_file(ascii + "POLYGONS 1 5\n4 0 1 2 3\nCELL_DATA 1\nanything\n");
    EXPECT_EQ(found[0].polygons.size(), 1U);
    EXPECT_EQ(found[0].vertices[2].y, static_cast<double>(1.1f));
}

TEST(ReadShapesVtk, RefusesWhatIsNotWhole)
{
    for (const char* rest :
         {"POLYGONS 1 5\n4 0 1 2\n", "POLYGONS 1 4\n4 0 1 2 3\n", "POLYGONS 1 4\n3 0 1 9\n",
          "POLYGONS 2 4\n3 0 1 2\n", "TRIANGLE_STRIPS 1 4\n3 0 1 2\n", "POLYGONS 1 x\n"})
        EXPECT_THROW(read_text_file(ascii + rest), IoError) << rest;
    EXPECT_THROW(read_text_file("solid\n"), IoError);
    EXPECT_THROW(read_text_file(ascii.substr(0, ascii.size() - 8)), IoError);
    EXPECT_THROW(read_text_file("# vtk DataFile Version 3.0\nx\nBINARY\nDATASET POLYDATA\n"
                                "POINTS 99999999999 float\n"),
                 IoError);
    EXPECT_THROW(read_shapes_vtk("no_such_file.vtk"), IoError);
}

} // namespace

} // namespace fppg
