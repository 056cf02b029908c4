// Shape files in the formats other than legacy VTK, and files of points.

#include "files/corner_numbers.h"
#include "files/vtk.h"
#include "fppg/error.h"
#include "fppg/files.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <limits>

namespace fppg
{

namespace
{

template <typename T>
void append(std::string& out, T value)
{
    out.append(reinterpret_cast<const char*>(&value), sizeof value);
}

/// The cells of all shapes in the order points, lines, faces, as in the legacy files.
struct ShapeCells
{
    std::string points;
    std::uint64_t n_points = 0;
    std::string mk;
    std::string object_id;
    struct Part
    {
        std::string connectivity;
        std::string offsets; ///< ends of the cells
        std::string types;
        std::uint64_t cells = 0;
        std::int32_t end = 0;
    };
    std::array<Part, 3> parts; ///< points, lines, faces
};

std::uint8_t cell_type(std::size_t corners)
{
    constexpr std::array<std::uint8_t, 5> types{0, 1, 3, 5, 9};
    return corners < types.size() ? types[corners] : std::uint8_t{7};
}

ShapeCells cells_of(const std::vector<ShapePolygons>& shapes)
{
    ShapeCells out;
    const CornerNumbers corners = number_corners(shapes);
    out.n_points = corners.places.size();
    for (const std::array<float, 3>& place : corners.places)
        for (const float coordinate : place) append(out.points, coordinate);
    for (std::size_t kind = 0; kind < 3; ++kind)
    {
        ShapeCells::Part& part = out.parts[kind];
        for (std::size_t s = 0; s < shapes.size(); ++s)
            for (const std::vector<std::uint32_t>& cell : shapes[s].polygons)
            {
                const std::size_t n = cell.size();
                if (cell_kind(n) != kind) continue;
                for (const std::uint32_t v : cell)
                    append(part.connectivity, static_cast<std::int32_t>(corners.numbers[s][v]));
                part.end += static_cast<std::int32_t>(n);
                append(part.offsets, part.end);
                part.types += static_cast<char>(cell_type(n));
                ++part.cells;
                append(out.mk, static_cast<std::int32_t>(shapes[s].mk));
                append(out.object_id, static_cast<std::int32_t>(shapes[s].object_id));
            }
    }
    return out;
}

/// Collects arrays and the places where they stand.
class Appended
{
public:
    std::uint64_t add(const std::string& bytes)
    {
        const std::uint64_t place = data_.size();
        append(data_, static_cast<std::uint64_t>(bytes.size()));
        data_ += bytes;
        return place;
    }
    const std::string& data() const { return data_; }

private:
    std::string data_;
};

std::string array_line(const char* type, const char* name, std::uint64_t place)
{
    return fmt::format(
        "        <DataArray type=\"{}\" Name=\"{}\" format=\"appended\" offset=\"{}\"/>\n", type,
        name, place);
}

/// What both formats begin with, up to the points.
std::string shared_part(const ShapeCells& cells, Appended& appended)
{
    const auto array = [](const std::string& attributes, std::uint64_t place)
    {
        return fmt::format(
            "        <DataArray {} format=\"appended\" offset=\"{}\">\n"
            "        </DataArray>\n",
            attributes, place);
    };
    std::string out = "      <PointData>\n      </PointData>\n      <CellData Scalars=\"Mk\">\n";
    out += array("type=\"Int32\" Name=\"Mk\"", appended.add(cells.mk));
    out += array("type=\"Int32\" Name=\"ObjId\"", appended.add(cells.object_id));
    out += "      </CellData>\n      <Points>\n";
    out += array("type=\"Float32\" Name=\"Points\" NumberOfComponents=\"3\"",
                 appended.add(cells.points));
    return out + "      </Points>\n";
}

void write_file(OutputFile& file, const char* type, const std::string& piece,
                const Appended& appended)
{
    file.append(
        fmt::format("<VTKFile type=\"{}\" version=\"1.0\" byte_order=\"LittleEndian\" "
                    "header_type=\"UInt64\">\n  <{}>\n{}    </Piece>\n  </{}>\n"
                    "  <AppendedData encoding=\"raw\">\n_",
                    type, type, piece, type));
    file.append(appended.data());
    file.append("\n  </AppendedData>\n</VTKFile>\n");
}

} // namespace

void write_shapes_vtp(OutputFile& file, const std::vector<ShapePolygons>& shapes)
{
    const ShapeCells cells = cells_of(shapes);
    Appended appended;
    std::string piece = fmt::format(
        "    <Piece NumberOfPoints=\"{}\" NumberOfVerts=\"{}\" NumberOfLines=\"{}\" "
        "NumberOfStrips=\"0\" NumberOfPolys=\"{}\">\n",
        cells.n_points, cells.parts[0].cells, cells.parts[1].cells, cells.parts[2].cells);
    piece += shared_part(cells, appended);
    const auto add = [&](const char* name, const ShapeCells::Part& part)
    {
        piece += fmt::format("      <{}>\n", name);
        piece += array_line("Int32", "connectivity", appended.add(part.connectivity));
        piece += array_line("Int32", "offsets", appended.add(part.offsets));
        piece += fmt::format("      </{}>\n", name);
    };
    add("Verts", cells.parts[0]);
    add("Lines", cells.parts[1]);
    add("Strips", {});
    add("Polys", cells.parts[2]);
    write_file(file, "PolyData", piece, appended);
}

void write_shapes_vtu(OutputFile& file, const std::vector<ShapePolygons>& shapes)
{
    const ShapeCells cells = cells_of(shapes);
    ShapeCells::Part all;
    for (const ShapeCells::Part& part : cells.parts)
    {
        all.connectivity += part.connectivity;
        for (std::size_t i = 0; i < part.offsets.size(); i += sizeof(std::int32_t))
        {
            std::int32_t end = 0;
            std::memcpy(&end, part.offsets.data() + i, sizeof end);
            append(all.offsets, all.end + end);
        }
        all.end += part.end;
        all.types += part.types;
        all.cells += part.cells;
    }
    Appended appended;
    std::string piece = fmt::format("    <Piece NumberOfPoints=\"{}\" NumberOfCells=\"{}\">\n",
                                    cells.n_points, all.cells);
    piece += shared_part(cells, appended);
    piece += "      <Cells>\n";
    piece += array_line("Int32", "connectivity", appended.add(all.connectivity));
    piece += array_line("Int32", "offsets", appended.add(all.offsets));
    piece += array_line("UInt8", "types", appended.add(all.types));
    piece += "      </Cells>\n";
    write_file(file, "UnstructuredGrid", piece, appended);
}

namespace
{

/// A facet of a binary STL file.
void append_facet(std::string& facets, const std::array<Vec3, 3>& corners)
{
    Vec3 normal = cross(corners[1] - corners[0], corners[2] - corners[0]);
    if (const double length = norm(normal); length > 0) normal = normal / length;
    for (const Vec3& v : {normal, corners[0], corners[1], corners[2]})
        for (int axis = 0; axis < 3; ++axis) append(facets, static_cast<float>(v[axis]));
    append(facets, std::uint16_t{0});
}

} // namespace

std::uint64_t write_shapes_stl(OutputFile& file, const std::vector<ShapePolygons>& shapes)
{
    std::string facets;
    std::uint64_t n = 0;
    for (const ShapePolygons& shape : shapes)
        for (const std::vector<std::uint32_t>& polygon : shape.polygons)
            for (std::size_t i = 2; i < polygon.size(); ++i)
            {
                append_facet(facets, {shape.vertices[polygon[0]], shape.vertices[polygon[i - 1]],
                                      shape.vertices[polygon[i]]});
                ++n;
            }
    if (n > std::numeric_limits<std::uint32_t>::max())
        throw IoError(fmt::format("cannot write '{}': {} facets, but STL counts them with 32 bits",
                                  file.path(), n));
    std::string head = "Shapes of a case, by fppg";
    head.resize(80, '\0');
    append(head, static_cast<std::uint32_t>(n));
    file.append(head);
    file.append(facets);
    return n;
}

namespace
{

void append_vertices(OutputFile& file, std::size_t n)
{
    std::string cells;
    for (std::uint32_t i = 0; i < n; ++i)
    {
        append_big_endian(cells, std::uint32_t{1});
        append_big_endian(cells, i);
    }
    file.append(fmt::format("\nVERTICES {} {}\n", n, 2 * n));
    file.append(cells);
}

} // namespace

void write_points_vtk(OutputFile& file, const std::vector<Vec3>& points)
{
    const std::vector<Vec3> origin(1);
    const std::vector<Vec3>& shown = points.empty() ? origin : points;
    std::string bytes;
    for (const Vec3& p : shown)
        for (int axis = 0; axis < 3; ++axis) append_big_endian(bytes, static_cast<float>(p[axis]));
    file.append(fmt::format("{}POINTS {} float\n", vtk_head, shown.size()));
    file.append(bytes);
    append_vertices(file, shown.size());
    file.append("\n");
}

void write_off_lattice_points_vtk(OutputFile& file, const OffLatticePoints& points)
{
    const std::size_t n = points.positions.size();
    std::string bytes;
    for (const Vec3& p : points.positions)
        for (int axis = 0; axis < 3; ++axis) append_big_endian(bytes, p[axis]);
    file.append(fmt::format("{}POINTS {} double\n", vtk_head, n));
    file.append(bytes);
    append_vertices(file, n);
    const bool is_wide =
        std::any_of(points.mk.begin(), points.mk.end(), [](std::uint16_t mk) { return mk > 255; });
    std::string mk;
    std::string types;
    for (std::size_t i = 0; i < n; ++i)
    {
        if (is_wide)
            append_big_endian(mk, points.mk[i]);
        else
            mk.push_back(static_cast<char>(points.mk[i]));
        types.push_back(static_cast<char>(points.types[i]));
    }
    file.append(fmt::format("\nPOINT_DATA {}\nSCALARS Mk {}\nLOOKUP_TABLE default\n", n,
                            is_wide ? "unsigned_short" : "unsigned_char"));
    file.append(mk);
    file.append(fmt::format("\nFIELD FieldData 1\nType 1 {} unsigned_char\n", n));
    file.append(types);
    file.append("\n");
}

} // namespace fppg
