#include "meshes/readers.h"

#include <array>

namespace fppg
{

bool add_vtk_cell(IndexedMesh& mesh, int type, std::span<const std::uint64_t> cell)
{
    switch (type)
    {
        case 0:
            return true; // an empty cell
        case 1:          // vertex
        case 2:          // several of them
            mesh.vertices.add(cell);
            return true;
        case 3: // line
        case 4: // polyline
            mesh.lines.add(cell);
            return true;
        case 6:
            mesh.strips.add(cell);
            return true;
        case 5: // triangle
        case 7: // polygon
        case 9: // quad
            mesh.polygons.add(cell);
            return true;
        case 8: // pixel: a quad whose last two corners are the other way round
            if (cell.size() == 4)
                mesh.polygons.add(std::array{cell[0], cell[1], cell[3], cell[2]});
            else
                mesh.polygons.add(cell);
            return true;
        default:
            return false;
    }
}

} // namespace fppg
