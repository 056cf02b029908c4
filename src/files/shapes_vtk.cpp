#include "files/vtk.h"
#include "fppg/files.h"

#include <fmt/format.h>
#include <cassert>

namespace fppg
{

namespace
{

/// The cells of one kind (VERTICES, LINES or POLYGONS) of all shapes.
struct CellPart
{
    std::string connectivity;
    std::uint64_t cells = 0;
    std::uint64_t numbers = 0; ///< indices and counts
    std::string mk;
    std::string object_id;
};

CellPart collect_cells(const std::vector<ShapePolygons>& shapes, std::size_t min_size,
                       std::size_t max_size)
{
    CellPart part;
    std::uint32_t first_vertex = 0;
    for (const ShapePolygons& shape : shapes)
    {
        for (const std::vector<std::uint32_t>& polygon : shape.polygons)
        {
            if (polygon.size() < min_size || polygon.size() > max_size) continue;
            append_big_endian(part.connectivity, static_cast<std::uint32_t>(polygon.size()));
            for (const std::uint32_t vertex : polygon)
            {
                assert(vertex < shape.vertices.size());
                append_big_endian(part.connectivity, first_vertex + vertex);
            }
            append_big_endian(part.mk, static_cast<std::uint32_t>(shape.mk));
            append_big_endian(part.object_id, shape.object_id);
            part.numbers += polygon.size() + 1;
            ++part.cells;
        }
        first_vertex += static_cast<std::uint32_t>(shape.vertices.size());
    }
    return part;
}

} // namespace

void write_shapes_vtk(OutputFile& file, const std::vector<ShapePolygons>& shapes)
{
    std::string points;
    std::uint64_t vertices = 0;
    for (const ShapePolygons& shape : shapes)
    {
        for (const Vec3& v : shape.vertices)
            for (int axis = 0; axis < 3; ++axis)
                append_big_endian(points, static_cast<float>(v[axis]));
        vertices += shape.vertices.size();
    }
    file.append(fmt::format("{}POINTS {} float\n", vtk_head, vertices));
    file.append(points);
    file.append("\n");

    // The values of cells stand in this order of kinds too, whatever the order of the shapes.
    std::string mk;
    std::string object_id;
    std::uint64_t cells = 0;
    const auto write_part = [&](const char* name, const CellPart& part)
    {
        if (part.cells == 0) return;
        file.append(fmt::format("{} {} {}\n", name, part.cells, part.numbers));
        file.append(part.connectivity);
        file.append("\n");
        mk += part.mk;
        object_id += part.object_id;
        cells += part.cells;
    };
    write_part("VERTICES", collect_cells(shapes, 1, 1));
    write_part("LINES", collect_cells(shapes, 2, 2));
    write_part("POLYGONS", collect_cells(shapes, 3, SIZE_MAX));

    file.append(fmt::format("CELL_DATA {}\nSCALARS Mk int\nLOOKUP_TABLE default\n", cells));
    file.append(mk);
    file.append(fmt::format("\nFIELD FieldData 1\nObjId 1 {} int\n", cells));
    file.append(object_id);
    file.append("\n");
}

} // namespace fppg
