// Tables of heights.
#include "lattice/paint_mesh.h"
#include "lattice/paint_off_lattice.h"
#include "nodes/snap.h"
#include "shapes/file_polygons.h"
#include "shapes/off_lattice_parts.h"
#include "shapes/plane_shapes.h"

namespace fppg
{
namespace
{

using Corners = std::vector<std::uint32_t>;

bool is_parallelogram(const TriangleSoup& soup, const Corners& quad, double dp)
{
    const auto corner = [&](std::size_t i) { return soup.vertices[quad[i]]; };
    return quad_kind({corner(0), corner(1), corner(2), corner(3)}, dp) != QuadKind::Other;
}

/// The triangles of one cell, on the lattice.
void add_cell(const TriangleSoup& soup, const Corners& corners, const LatticeGrid& grid,
              std::vector<SnappedTriangle>& triangles)
{
    const auto node = [&](std::size_t i) { return snap(soup.vertices[corners[i]], grid); };
    for (std::size_t i = 2; i < corners.size(); ++i)
        triangles.push_back({node(0), node(i - 1), node(i)});
}

/// One cell that is a part of its own.
void paint_cell(Painting& painting, const Brush& brush, const TriangleSoup& moved,
                const Corners& corners)
{
    const bool is_bent = corners.size() == 3;
    if (is_bent || !brush.state->off_lattice ||
        !is_parallelogram(moved, corners, painting.grid().dp))
    {
        std::vector<SnappedTriangle> triangles;
        add_cell(moved, corners, painting.grid(), triangles);
        paint_triangles(painting, brush, std::move(triangles));
        return;
    }
    PolyhedronOp cell;
    for (const std::uint32_t v : corners) cell.vertices.push_back(moved.vertices[v]);
    cell.faces.push_back({{0, 1, 2, 3}, true, {}, 0, {}});
    paint(painting, brush, cell);
}

} // namespace

void paint_off_lattice_heights(Painting& painting, const Brush& brush, const MeshFileOp& op,
                               const MeshFile& file)
{
    const LatticeGrid& grid = painting.grid();
    const bool is_wire = brush.state->mode == DrawMode::Wire;
    const TriangleSoup moved = moved_soup(file.soup, op.transform, painting.canvas.threads());
    PolyhedronOp cells;
    cells.vertices = moved.vertices;
    std::vector<SnappedTriangle> others;
    const auto paint_cells = [&]
    {
        if (cells.faces.empty()) return;
        if (is_wire)
            paint_off_lattice_wire(painting, brush, cells);
        else
            paint_off_lattice_pieces(painting, brush,
                                     off_lattice_pieces(cells, brush.state->matrix, grid));
        cells.faces.clear();
    };
    const auto paint_others = [&]
    {
        if (!others.empty()) paint_triangles(painting, brush, std::move(others));
        others.clear();
    };
    for_each_polygon(
        file, op, grid.dp,
        [&](Corners corners)
        {
            if (corners.size() == 4 && (is_wire || is_parallelogram(moved, corners, grid.dp)))
            {
                paint_others();
                cells.faces.push_back({std::move(corners), true, {}, 0, {}});
            }
            else
            {
                paint_cells();
                add_cell(moved, corners, grid, others);
            }
        });
    paint_cells();
    paint_others();
}

void paint_heights_in_parts(Painting& painting, const Brush& brush, const MeshFileOp& op,
                            const MeshFile& file)
{
    const bool is_wire = brush.state->mode == DrawMode::Wire;
    const TriangleSoup moved = moved_soup(file.soup, op.transform, painting.canvas.threads());
    std::uint32_t part = 0;
    for_each_polygon(
        file, op, painting.grid().dp,
        [&](const Corners& corners)
        {
            const bool is_bent = corners.size() == 3;
            if (!is_wire || is_bent)
            {
                paint_cell(painting, brush.of_part(is_bent ? part : part++), moved, corners);
                return;
            }
            for (std::size_t i = 0; i < 4; ++i)
                paint(
                    painting, brush.of_part(part++),
                    LinesOp{{{moved.vertices[corners[i]], moved.vertices[corners[(i + 1) % 4]]}}});
        });
}

} // namespace fppg
