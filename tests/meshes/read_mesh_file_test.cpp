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

std::string vertex_lines(const std::string& keyword, const std::string& behind)
{
    std::string text;
    for (const Vec3& c : corners)
        text += fmt::format("{}{} {} {}{}\n", keyword, c.x, c.y, c.z, behind);
    return text;
}

TEST(ReadObj, ReadsCornersWithTexturesAndNormalsAndCountedBackwards)
{
    const std::string vertices = "# a remark\r\nmtllib a.mtl\no part\n" + vertex_lines("v ", "") +
                                 "vt 0 0\nvn 0 0 1\ng one two\nusemtl red\ns off\n";
    for (const std::string faces :
         {"f 1 2 3 4\ng three\nf 2 5 3", "f 1/1 2/1 3/1 4/1 # four\nf 2/1 5/1 3/1\n",
          "f 1//1 2//1 3//1 4//1\nf 2/1/1 5/1/1 3/1/1\n", "f -5 -4 -3 -2\nf -4 -1 -3\n",
          "f 1 2 \\\n 3 4\nf 2 5 3\n"})
        expect_quad_and_triangle(read(vertices + faces, MeshFormat::Obj));
    expect_quad_and_triangle(
        read(vertex_lines("v ", " 0.1 0.2 0.3") + "f 1 2 3 4\nf 2 5 3\n", MeshFormat::Obj));
}

TEST(ReadObj, CutsWidePolygonsAndReadsLinesAndPoints)
{
    const std::string text = "v 0 0 0\nv 2 0 0\nv 2 2 0\nv 1 3 0\nv 0 2 0\n";
    EXPECT_EQ(read(text + "f 1 2 3 4 5\n", MeshFormat::Obj).soup.size(), 3U);
    const MeshFile mesh = read(text + "l 1 2 3\np 4\nf 1 2 3\n", MeshFormat::Obj);
    ASSERT_EQ(mesh.lines.size(), 1U);
    EXPECT_EQ(mesh.lines[0].size(), 3U);
    EXPECT_EQ(mesh.points.size(), 1U);
}

TEST(ReadObj, NamesTheLineOfWhatIsBrokenAndWhatWasExpected)
{
    const std::string vertices = vertex_lines("v ", "");
    const std::vector<std::pair<std::string, std::string>> broken{
        {"f 1 2 6", ":6: names vertex 6, expected 1 to 5"},
        {"f 1 2 -6", ":6: names vertex -6, expected 1 to 5, or -1 to -5"},
        {"f 0 1 2", ":6: names vertex 0"},
        {"f 1 2", ":6: a face of 2 corners, expected 3 or more"},
        {"f 1 2 x", ":6: expected a corner as v, v/vt, v//vn or v/vt/vn, found 'x'"},
        {"v 1 2", ":6: expected a number of z, found the end of the file"},
        {"v 1 b 2", ":6: expected a number of y, found 'b'"},
        {"surf 0 1 0 1 1 2", ":6: 'surf' belongs to a free-form surface, expected polygons"},
        {"solid cube", ":6: expected v, f, l, p or another keyword of an OBJ file, found 'solid'"}};
    for (const auto& [line, message] : broken)
        EXPECT_NE(message_of(vertices + line, MeshFormat::Obj).find(message), std::string::npos)
            << message_of(vertices + line, MeshFormat::Obj);
    EXPECT_NE(message_of(vertices, MeshFormat::Obj), "");
}

TEST(ReadOff, ReadsColoursAndNormalsAndRemarks)
{
    const std::string faces = "4 0 1 2 3 255 0 0\n# a remark\n3 1 4 2\n\n";
    for (const auto& [header, behind] : std::vector<std::pair<std::string, std::string>>{
             {"OFF", ""},
             {"# made by hand\noff", " # a corner"},
             {"COFF", " 255 0 0 255"},
             {"NOFF", " 0 0 1"},
             {"STCNOFF", " 0 0 1 255 0 0 255 0.5 0.5"}})
        expect_quad_and_triangle(
            read(fmt::format("{}\n5 2 0\n{}{}", header, vertex_lines("", behind), faces),
                 MeshFormat::Off));
    expect_quad_and_triangle(read("OFF 5 2 6\r\n" + vertex_lines("", "") + faces, MeshFormat::Off));
}

TEST(ReadOff, NamesTheLineOfWhatIsBrokenAndWhatWasExpected)
{
    const std::string head = "OFF\n5 2 0\n" + vertex_lines("", "");
    const std::vector<std::pair<std::string, std::string>> broken{
        {head + "4 0 1 2 3\n3 1 5 2\n", ":9: a face names vertex 5, expected 0 to 4"},
        {head + "4 0 1 2 3\n", "the file ends after 1 of 2 faces"},
        {head + "4 0 1 2 3\n3 1 4 2\n3 0 1 2\n", "has '3' after the last of 2 faces"},
        {head + "0\n3 1 4 2\n", ":8: a face has 0 corners, expected 1 or more"},
        {head + "3 0 1\n", ":9: expected a whole number of corners, found the end of the file"},
        {"OFF\n5 1 0\n0 0 0 255 0 0\n", ":3: a vertex has '255' after x, y and z"},
        {"OFF\n5 1 0\n0 0\n", "expected a number of z, found the end of the file"},
        {"4OFF\n1 1 0\n", ":1: expected OFF, COFF, NOFF or STOFF: vertices of three coordinates"},
        {"nOFF\n3\n1 1 0\n", ":1: is an nOFF file of more than three dimensions"},
        {"OFF BINARY\n", ":1: is a binary OFF file, expected one as text"},
        {"5 2 0\n", ":1: expected OFF, COFF, NOFF or STOFF, found '5'"},
        {"OFF\n-5 2 0\n", ":2: expected a count of vertices, 0 or more"}};
    for (const auto& [text, message] : broken)
        EXPECT_NE(message_of(text, MeshFormat::Off).find(message), std::string::npos)
            << message_of(text, MeshFormat::Off);
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
    AppendedZlib
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
              std::string::npos);
}

TEST(ReadVtkXml, RefusesASmallFileWhosePiecesReadOneBlockAgainAndAgain)
{
    std::string text = xml_vtp(Packing::AppendedRaw, true);
    const std::size_t at = text.find("<Piece"), size = text.find("</PolyData>") - at;
    const std::string piece = text.substr(at, size);
    while (text.size() < 300'000) text.insert(at, piece);
    EXPECT_NE(message_of(text, MeshFormat::Vtk).find("more than 16 times"), std::string::npos);
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
            {vertex_lines("v ", "") + "f 1 2 3 4\nf 2 5 3\n", MeshFormat::Obj},
            {"OFF\n5 2 0\n" + vertex_lines("", "") + "4 0 1 2 3\n3 1 4 2\n", MeshFormat::Off},
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
    EXPECT_EQ(mesh_format_of("b.Obj"), MeshFormat::Obj);
    EXPECT_EQ(mesh_format_of("b.off"), MeshFormat::Off);
    EXPECT_EQ(mesh_format_of("b.stl"), MeshFormat::Stl);
    EXPECT_EQ(mesh_format_of("b"), MeshFormat::Stl);
}

} // namespace

} // namespace fppg
