#include "files/corner_numbers.h"
#include "files/vtk_cells.h"
#include "fppg/files.h"

#include <fmt/format.h>

namespace fppg
{

namespace
{

/// Of all shapes.
struct LegacyShapeCells : VtkCells
{
    std::string object_id;
};

LegacyShapeCells collect_cells(const std::vector<ShapePolygons>& shapes,
                               const CornerNumbers& corners, std::size_t kind)
{
    LegacyShapeCells part;
    for (std::size_t s = 0; s < shapes.size(); ++s)
        for (const std::vector<std::uint32_t>& cell : shapes[s].polygons)
        {
            if (cell_kind(cell.size()) != kind) continue;
            part.begin(cell.size(), static_cast<std::uint32_t>(shapes[s].mk));
            for (const std::uint32_t v : cell)
                append_big_endian(part.connectivity, corners.numbers[s][v]);
            append_big_endian(part.object_id, shapes[s].object_id);
        }
    return part;
}

} // namespace

void write_shapes_vtk(OutputFile& file, const std::vector<ShapePolygons>& shapes)
{
    const CornerNumbers corners = number_corners(shapes);
    std::string points;
    for (const std::array<float, 3>& place : corners.places)
        for (const float coordinate : place) append_big_endian(points, coordinate);
    file.append(fmt::format("{}POINTS {} float\n", vtk_head, corners.places.size()));
    file.append(points);
    file.append("\n");

    // The values of cells stand in this order of kinds too, whatever the order of the shapes.
    std::string mk;
    std::string object_id;
    std::uint64_t cells = 0;
    const auto write_part = [&](const char* name, const LegacyShapeCells& part)
    {
        part.write(file, name);
        mk += part.mk;
        object_id += part.object_id;
        cells += part.cells;
    };
    write_part("VERTICES", collect_cells(shapes, corners, 0));
    write_part("LINES", collect_cells(shapes, corners, 1));
    write_part("POLYGONS", collect_cells(shapes, corners, 2));

    file.append(fmt::format("CELL_DATA {}\nSCALARS Mk int\nLOOKUP_TABLE default\n", cells));
    file.append(mk);
    file.append(fmt::format("\nFIELD FieldData 1\nObjId 1 {} int\n", cells));
    file.append(object_id);
    file.append("\n");
}

void write_heights_vtk(OutputFile& file, const std::vector<Vec3>& points,
                       const std::vector<std::vector<std::uint32_t>>& cells)
{
    std::string places;
    std::string heights;
    for (const Vec3& p : points)
    {
        for (int axis = 0; axis < 3; ++axis) append_big_endian(places, p[axis]);
        append_big_endian(heights, static_cast<float>(p.z));
    }
    std::string connectivity;
    for (const std::vector<std::uint32_t>& cell : cells)
    {
        append_big_endian(connectivity, static_cast<std::uint32_t>(cell.size()));
        for (const std::uint32_t corner : cell) append_big_endian(connectivity, corner);
    }
    const bool are_points = !cells.empty() && cells[0].size() == 1;
    file.append(fmt::format("{}POINTS {} double\n", vtk_head, points.size()));
    file.append(places);
    file.append(fmt::format("\n{} {} {}\n", are_points ? "VERTICES" : "POLYGONS", cells.size(),
                            connectivity.size() / sizeof(std::uint32_t)));
    file.append(connectivity);
    file.append(fmt::format("\nPOINT_DATA {}\nSCALARS Height float\nLOOKUP_TABLE default\n",
                            points.size()));
    file.append(heights);
    file.append("\n");
}

} // namespace fppg
