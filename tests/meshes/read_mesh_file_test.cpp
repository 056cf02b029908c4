#include "fppg/shapes.h"

#include <bit>
#include <cstdint>
#include <random>

#include <gtest/gtest.h>
#include <zlib.h>

#include "fppg/error.h"
#include "meshes/stl_files.h"

namespace fppg
{

namespace
{

using test::TemporaryFile;

MeshFile read(const std::string& content, MeshFormat format, const ShapeSelection& shapes = {})
{
    return read_mesh_file(TemporaryFile(content).path(), {format, shapes, std::nullopt}, 2);
}

std::string message_of(const std::string& content, MeshFormat format)
{
    try
    {
        read(content, format);
    }
    catch (const GeometryError& error)
    {
        return error.what();
    }
    return "";
}

/// Bytes of a number, the highest first or last.
template <typename T>
std::string bytes_of(T value, bool is_big_endian)
{
    std::string bytes(sizeof value, '\0');
    std::memcpy(bytes.data(), &value, sizeof value);
    if (is_big_endian) std::reverse(bytes.begin(), bytes.end());
    return bytes;
}

const std::vector<Vec3> corners{{0, 0, 0}, {0.5, 0, 0}, {0.5, 0.25, 0}, {0, 0.25, 0}, {1, 0, 2}};

std::string ply_header(const std::string& format)
{
    return "ply\nformat " + format +
           " 1.0\ncomment a comment\nelement vertex 5\nproperty float x\nproperty float y\n"
           "property uchar red\nproperty float z\nelement face 2\n"
           "property list uchar int vertex_indices\nend_header\n";
}

std::string text_ply()
{
    std::string text = ply_header("ascii");
    for (const Vec3& c : corners) text += fmt::format("{} {} 255 {}\n", c.x, c.y, c.z);
    return text + "4 0 1 2 3\n3 1 4 2\n";
}

std::string binary_ply(bool is_big_endian)
{
    std::string bytes = ply_header(is_big_endian ? "binary_big_endian" : "binary_little_endian");
    for (const Vec3& c : corners)
        bytes += bytes_of(static_cast<float>(c.x), is_big_endian) +
                 bytes_of(static_cast<float>(c.y), is_big_endian) + '\xff' +
                 bytes_of(static_cast<float>(c.z), is_big_endian);
    for (const std::vector<int>& face : {std::vector<int>{0, 1, 2, 3}, std::vector<int>{1, 4, 2}})
    {
        bytes += static_cast<char>(face.size());
        for (const int i : face) bytes += bytes_of(i, is_big_endian);
    }
    return bytes;
}

void expect_quad_and_triangle(const MeshFile& mesh)
{
    ASSERT_EQ(mesh.soup.size(), 3U);
    const std::vector<std::size_t> expected{0, 1, 2, 0, 2, 3, 1, 4, 2};
    for (std::size_t i = 0; i < expected.size(); ++i)
        EXPECT_EQ(mesh.soup.vertices[i], corners[expected[i]]) << i;
    EXPECT_EQ(mesh.quads, std::vector<std::uint32_t>{0});
}

TEST(ReadPly, ReadsTextAndBothByteOrdersAlike)
{
    expect_quad_and_triangle(read(text_ply(), MeshFormat::Ply));
    expect_quad_and_triangle(read(binary_ply(false), MeshFormat::Ply));
    expect_quad_and_triangle(read(binary_ply(true), MeshFormat::Ply));
}

TEST(ReadPly, NamesTheLineOfABrokenNumber)
{
    std::string text = text_ply();
    text.replace(text.find("0.5 0.25"), 3, "x.5");
    EXPECT_NE(message_of(text, MeshFormat::Ply).find(":14: expected a number of x, found 'x.5'"),
              std::string::npos)
        << message_of(text, MeshFormat::Ply);
}

TEST(ReadPly, RefusesAFaceThatNamesAPointThatIsNotThere)
{
    std::string text = text_ply();
    text.replace(text.find("3 1 4 2"), 7, "3 1 5 2");
    EXPECT_NE(message_of(text, MeshFormat::Ply).find("polygon 1 of 2 names point 5"),
              std::string::npos);
}

TEST(ReadPly, RefusesAWrongCountOfItsHeader)
{
    std::string more = text_ply();
    more.replace(more.find("face 2"), 6, "face 3");
    EXPECT_NE(message_of(more, MeshFormat::Ply).find("ends after 2 of 3"), std::string::npos);
    std::string fewer = text_ply();
    fewer.replace(fewer.find("face 2"), 6, "face 1");
    EXPECT_NE(message_of(fewer, MeshFormat::Ply).find("after the last element"), std::string::npos);
    std::string huge = binary_ply(false);
    huge.replace(huge.find("vertex 5"), 8, "vertex 999999999999");
    EXPECT_NE(message_of(huge, MeshFormat::Ply).find("truncated"), std::string::npos);
}

std::string vtk_header(const std::string& version, const std::string& encoding)
{
    return "# vtk DataFile Version " + version + "\ntitle\n" + encoding + "\nDATASET POLYDATA\n";
}

std::string text_vtk()
{
    std::string text = vtk_header("3.0", "ASCII") + "POINTS 5 float\n";
    for (const Vec3& c : corners) text += fmt::format("{} {} {}\n", c.x, c.y, c.z);
    return text +
           "VERTICES 1 2\n1 4\nLINES 1 4\n3 0 1 4\nPOLYGONS 2 9\n4 0 1 2 3\n3 1 4 2\n"
           "CELL_DATA 4\nSCALARS a int\nLOOKUP_TABLE default\n1 2 3 4\n";
}

std::string vtk_of_version_5(bool is_binary)
{
    std::string text = vtk_header("5.1", is_binary ? "BINARY" : "ASCII") + "POINTS 5 double\n";
    const auto number = [&](auto value)
    { return is_binary ? bytes_of(value, true) : fmt::format("{} ", value); };
    for (const Vec3& c : corners) text += number(c.x) + number(c.y) + number(c.z);
    text += "\nMETADATA\nINFORMATION 0\n\nPOLYGONS 3 7\nOFFSETS vtktypeint64\n";
    for (const std::int64_t v : {0, 4, 7}) text += number(v);
    text += "\nCONNECTIVITY vtktypeint64\n";
    for (const std::int64_t v : {0, 1, 2, 3, 1, 4, 2}) text += number(v);
    return text + "\n";
}

TEST(ReadVtk, ReadsPointsLinesAndPolygons)
{
    const MeshFile mesh = read(text_vtk(), MeshFormat::Vtk);
    expect_quad_and_triangle(mesh);
    EXPECT_EQ(mesh.points, std::vector<Vec3>{corners[4]});
    EXPECT_EQ(mesh.lines, (std::vector<std::vector<Vec3>>{{corners[0], corners[1], corners[4]}}));
}

TEST(ReadVtk, ReadsTheCellsOfVersion5)
{
    expect_quad_and_triangle(read(vtk_of_version_5(false), MeshFormat::Vtk));
    expect_quad_and_triangle(read(vtk_of_version_5(true), MeshFormat::Vtk));
}

TEST(ReadVtk, KeepsDoubleCoordinatesAndRoundsFloatOnes)
{
    const auto x = [](const std::string& type)
    {
        return read(vtk_header("3.0", "ASCII") + "POINTS 1 " + type +
                        "\n0.04999999999 0 0\nVERTICES 1 2\n1 0\n",
                    MeshFormat::Vtk)
            .points.at(0)
            .x;
    };
    EXPECT_EQ(x("double"), 0.04999999999);
    EXPECT_EQ(x("float"), static_cast<double>(0.05F));
}

TEST(ReadVtk, TakesTheSelectedShapesOnly)
{
    const auto count = [](const ShapeSelection& s)
    {
        const MeshFile mesh = read(text_vtk(), MeshFormat::Vtk, s);
        return std::array{mesh.points.size(), mesh.lines.size(), mesh.soup.size()};
    };
    EXPECT_EQ(count({true, false, false, false, false}), (std::array<std::size_t, 3>{1, 0, 0}));
    EXPECT_EQ(count({false, true, true, false, false}), (std::array<std::size_t, 3>{0, 1, 1}));
    EXPECT_EQ(count({false, false, false, true, false}), (std::array<std::size_t, 3>{0, 0, 2}));
}

TEST(ReadVtk, CutsAPentagonByLeastPerimeter)
{
    const MeshFile mesh = read(vtk_header("3.0", "ASCII") +
                                   "POINTS 5 float\n1 0 0 1.2 0 0 1.3 .3 0 1.1 .5 0 .9 .3 0\n"
                                   "POLYGONS 1 6\n5 0 1 2 3 4\n",
                               MeshFormat::Vtk);
    ASSERT_EQ(mesh.soup.size(), 3U);
    const auto x = [&](std::size_t i) { return static_cast<float>(mesh.soup.vertices[i].x); };
    // (0, 1, 2), (2, 3, 4), (0, 2, 4), as GenCase cuts it.
    EXPECT_EQ((std::array{x(0), x(1), x(2)}), (std::array{1.0F, 1.2F, 1.3F}));
    EXPECT_EQ((std::array{x(3), x(4), x(5)}), (std::array{1.3F, 1.1F, 0.9F}));
}

TEST(ReadVtk, TurnsEverySecondTriangleOfAStrip)
{
    const MeshFile mesh = read(vtk_header("3.0", "ASCII") +
                                   "POINTS 4 float\n0 0 0 1 0 0 0 1 0 1 1 0\n"
                                   "TRIANGLE_STRIPS 1 5\n4 0 1 2 3\n",
                               MeshFormat::Vtk);
    ASSERT_EQ(mesh.soup.size(), 2U);
    for (std::size_t t = 0; t < 2; ++t)
    {
        const Vec3* const c = &mesh.soup.vertices[3 * t];
        EXPECT_GT(cross(c[1] - c[0], c[2] - c[0]).z, 0);
    }
}

TEST(ReadVtk, RefusesVolumeCells)
{
    const std::string text =
        "# vtk DataFile Version 3.0\nt\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 4 float\n"
        "0 0 0 1 0 0 0 1 0 0 0 1\nCELLS 1 5\n4 0 1 2 3\nCELL_TYPES 1\n10\n";
    EXPECT_NE(message_of(text, MeshFormat::Vtk).find("has the type 10"), std::string::npos);
}

std::string base64(const std::string& bytes)
{
    static const char* const letters =
        "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string out;
    for (std::size_t i = 0; i < bytes.size(); i += 3)
    {
        std::uint32_t bits = 0;
        for (std::size_t k = 0; k < 3; ++k)
            bits =
                bits << 8U | (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0U);
        for (std::size_t k = 0; k < 4; ++k)
            out += i + k > bytes.size() ? '=' : letters[bits >> (18 - 6 * k) & 63U];
    }
    return out;
}

enum class Packing
{
    Text,
    Base64,
    Zlib,
    AppendedRaw,
    AppendedZlib,
};

/// A PolyData file of the corners, a quad and a triangle.
std::string xml_vtp(Packing packing, bool is_long)
{
    std::string appended;
    const auto length = [&](std::size_t n)
    {
        return is_long ? bytes_of(std::uint64_t{n}, false)
                       : bytes_of(static_cast<std::uint32_t>(n), false);
    };
    const auto packed = [&](const std::string& data, bool is_text)
    {
        std::string zipped(::compressBound(data.size()), '\0');
        uLongf n = zipped.size();
        ::compress(reinterpret_cast<Bytef*>(zipped.data()), &n,
                   reinterpret_cast<const Bytef*>(data.data()), data.size());
        zipped.resize(n);
        const std::string head = length(1) + length(data.size()) + length(0) + length(n);
        return is_text ? base64(head) + base64(zipped) : head + zipped;
    };
    const auto array = [&](const std::string& name, const std::string& type,
                           const std::string& text, const std::string& data)
    {
        std::string out = "<DataArray type=\"" + type + "\" Name=\"" + name +
                          "\" NumberOfComponents=\"" + (name == "Points" ? "3" : "1") + "\" ";
        if (packing == Packing::Text) return out + "format=\"ascii\">" + text + "</DataArray>\n";
        if (packing == Packing::Base64)
            return out + "format=\"binary\">\n" + base64(length(data.size()) + data) +
                   "\n</DataArray>\n";
        if (packing == Packing::Zlib)
            return out + "format=\"binary\">" + packed(data, true) + "</DataArray>\n";
        out += fmt::format("format=\"appended\" offset=\"{}\"/>\n", appended.size());
        appended +=
            packing == Packing::AppendedRaw ? length(data.size()) + data : packed(data, false);
        return out;
    };
    std::string points_text;
    std::string points_data;
    for (const Vec3& c : corners)
        for (int axis = 0; axis < 3; ++axis)
        {
            points_text += fmt::format("{} ", c[axis]);
            points_data += bytes_of(static_cast<float>(c[axis]), false);
        }
    std::string cells;
    for (const std::int64_t v : {0, 1, 2, 3, 1, 4, 2}) cells += bytes_of(v, false);
    std::string ends;
    for (const int v : {4, 7}) ends += bytes_of(v, false);
    std::string text = fmt::format(
        "<?xml version=\"1.0\"?>\n<VTKFile type=\"PolyData\" version=\"1.0\" "
        "byte_order=\"LittleEndian\" header_type=\"{}\"{}>\n<PolyData>\n"
        "<Piece NumberOfPoints=\"5\" NumberOfVerts=\"0\" NumberOfPolys=\"2\">\n<Points>\n",
        is_long ? "UInt64" : "UInt32",
        packing == Packing::Zlib || packing == Packing::AppendedZlib
            ? " compressor=\"vtkZLibDataCompressor\""
            : "");
    text += array("Points", "Float32", points_text, points_data) + "</Points>\n<Polys>\n";
    text += array("connectivity", "Int64", "0 1 2 3 1 4 2", cells);
    text += array("offsets", "Int32", "4 7", ends) + "</Polys>\n</Piece>\n</PolyData>\n";
    if (!appended.empty())
        text += "<AppendedData encoding=\"raw\">\n_" + appended + "\n</AppendedData>\n";
    return text + "</VTKFile>\n";
}

TEST(ReadVtkXml, ReadsEveryPackingAlike)
{
    for (const Packing packing : {Packing::Text, Packing::Base64, Packing::Zlib,
                                  Packing::AppendedRaw, Packing::AppendedZlib})
        for (const bool is_long : {false, true})
        {
            SCOPED_TRACE(static_cast<int>(packing));
            expect_quad_and_triangle(read(xml_vtp(packing, is_long), MeshFormat::Vtk));
        }
}

TEST(ReadVtkXml, NamesTheArrayWhoseNumbersAreTooFew)
{
    std::string text = xml_vtp(Packing::Text, true);
    text.replace(text.find("0 1 2 3 1 4 2"), 13, "0 1 2 3 1 00004");
    EXPECT_NE(message_of(text, MeshFormat::Vtk).find("has 6 numbers, expected 7"),
              std::string::npos)
        << message_of(text, MeshFormat::Vtk);
}

TEST(ReadCsvBathymetry, MakesAQuadOfEveryCell)
{
    const MeshFile mesh =
        read("Y \\ X => Z;0;0.3;1\n0;1;2;3\n0.5;4;;6\n", MeshFormat::CsvBathymetry);
    ASSERT_EQ(mesh.soup.size(), 4U);
    EXPECT_EQ(mesh.quads, (std::vector<std::uint32_t>{0, 2}));
    EXPECT_EQ(mesh.soup.vertices[1], (Vec3{0.3, 0, 2}));
    EXPECT_EQ(mesh.soup.vertices[2], (Vec3{0.3, 0.5, 0})); // an empty cell is 0
    EXPECT_EQ(mesh.soup.vertices[5], (Vec3{0, 0.5, 4}));
}

TEST(ReadCsvBathymetry, NamesTheLineThatIsTooShortAndTheCellThatIsNoNumber)
{
    EXPECT_NE(
        message_of("a;0;1;2\n0;1;1;1\n1;1;1\n", MeshFormat::CsvBathymetry).find(":3: has 3 cells"),
        std::string::npos);
    EXPECT_NE(message_of("a;0;1\n0;1;q\n1;1;1\n", MeshFormat::CsvBathymetry)
                  .find(":2: expected a number in column 3, found 'q'"),
              std::string::npos);
    EXPECT_NE(message_of("a;1;0\n0;1;1\n1;1;1\n", MeshFormat::CsvBathymetry).find("rising"),
              std::string::npos);
}

/// Whatever is broken ends with a message of the right kind.
void expect_a_mesh_or_a_message(const std::string& content, MeshFormat format)
{
    try
    {
        const MeshFile mesh = read(content, format);
        for (const Vec3& v : mesh.soup.vertices) ASSERT_TRUE(is_finite(v));
    }
    catch (const GeometryError& error)
    {
        ASSERT_GT(std::string(error.what()).size(), 20U);
    }
}

std::vector<std::pair<std::string, MeshFormat>> whole_files()
{
    return {{text_ply(), MeshFormat::Ply},
            {binary_ply(false), MeshFormat::Ply},
            {text_vtk(), MeshFormat::Vtk},
            {vtk_of_version_5(true), MeshFormat::Vtk},
            {xml_vtp(Packing::Text, true), MeshFormat::Vtk},
            {xml_vtp(Packing::Base64, false), MeshFormat::Vtk},
            {xml_vtp(Packing::AppendedZlib, true), MeshFormat::Vtk},
            {"a;0;0.3;1\n0;1;2;3\n0.5;4;;6\n", MeshFormat::CsvBathymetry}};
}

TEST(ReadMeshFile, EndsWithAMessageWhereverAFileIsCut)
{
    for (const auto& [content, format] : whole_files())
        for (std::size_t n = 0; n < content.size(); n += 3)
            expect_a_mesh_or_a_message(content.substr(0, n), format);
}

TEST(ReadMeshFile, EndsWithAMessageWhateverByteIsWrong)
{
    std::mt19937 random(5);
    for (const auto& [content, format] : whole_files())
        for (int trial = 0; trial < 400; ++trial)
        {
            std::string wrong = content;
            for (int k = 0; k < 3; ++k)
                wrong[random() % wrong.size()] = static_cast<char>(random());
            expect_a_mesh_or_a_message(wrong, format);
        }
}

TEST(ReadMeshFile, EndsWithAMessageWhateverNumberOfATextIsWrong)
{
    std::mt19937 random(6);
    for (const auto& [content, format] : whole_files())
        for (int trial = 0; trial < 300; ++trial)
        {
            std::string wrong = content;
            const std::size_t at = wrong.find_first_of("0123456789", random() % wrong.size());
            if (at == std::string::npos) continue;
            static const std::array<const char*, 6> numbers{"-1",  "99999999999",          "1e300",
                                                            "nan", "18446744073709551615", "0"};
            wrong.replace(at, 1, numbers[random() % numbers.size()]);
            expect_a_mesh_or_a_message(wrong, format);
        }
}

TEST(ReadMeshFile, TellsKindsByTheirEnding)
{
    EXPECT_EQ(mesh_format_of("a/b.PLY"), MeshFormat::Ply);
    EXPECT_EQ(mesh_format_of("b.vtu"), MeshFormat::Vtk);
    EXPECT_EQ(mesh_format_of("b.stl"), MeshFormat::Stl);
    EXPECT_EQ(mesh_format_of("b"), MeshFormat::Stl);
}

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
