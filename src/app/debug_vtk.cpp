#include "app/debug_vtk.h"

#include "core/float32.h"
#include "meshes/mesh_library.h"
#include "meshes/readers.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <utility>

namespace fppg
{
namespace
{

ShapePolygons box_and_seed(const DebugBox& picture, double dp)
{
    ShapePolygons shape;
    shape.mk = picture.mk;
    shape.vertices.assign(picture.corners.begin(), picture.corners.end());
    // Bottom, top, front, back, right, left; corners by bits x, y, z.
    shape.polygons = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4},
                      {3, 2, 6, 7}, {1, 3, 7, 5}, {0, 4, 6, 2}};
    if (!picture.seed) return shape;
    for (int axis = 0; axis < 3; ++axis)
    {
        // Sums of float32.
        Vec3 reach;
        reach[axis] = as_float32(dp);
        const Vec3 seed = as_float32(*picture.seed);
        const auto first = static_cast<std::uint32_t>(shape.vertices.size());
        shape.vertices.push_back(seed - reach);
        shape.vertices.push_back(seed + reach);
        shape.polygons.push_back({first, first + 1});
    }
    return shape;
}

void add_boxes(const CaseDef& def, std::vector<DebugVtk>& out)
{
    for (const char* command : {"fillbox", "redrawbox", "redrawnearbox"})
    {
        std::vector<ShapePolygons> shapes;
        for (const DebugBox& picture : def.debug_boxes)
            if (picture.command == command) shapes.push_back(box_and_seed(picture, def.grid.dp));
        if (!shapes.empty())
            out.push_back({fmt::format("_dbg-{}.vtk", command),
                           [shapes = std::move(shapes)](OutputFile& file)
                           { write_shapes_vtk(file, shapes); }});
    }
}

void add_bathymetry(const CaseDef& def, const DrawOp& op, int threads, std::vector<DebugVtk>& out)
{
    const MeshFileOp& mesh = *shape_as<MeshFileOp>(op);
    const IndexedMesh grid = read_bathymetry_file(def.meshes->find(op.source, mesh.file),
                                                  *mesh.reading.bathymetry, threads);
    const std::string stem = "_Dbg_" + std::filesystem::path(mesh.file).stem().string();
    const auto add = [&](const char* ending, std::vector<std::vector<std::uint32_t>> cells)
    {
        std::string name = stem + ending;
        std::erase_if(out, [&](const DebugVtk& p) { return p.name == name; });
        out.push_back({std::move(name),
                       [points = grid.points, cells = std::move(cells)](OutputFile& file)
                       { write_heights_vtk(file, points, cells); }});
    };
    std::vector<std::vector<std::uint32_t>> cells;
    if (mesh.saves_points)
    {
        for (std::uint32_t i = 0; i < grid.points.size(); ++i) cells.push_back({i});
        add("_BthPoints.vtk", std::move(cells));
    }
    if (!mesh.saves_grid) return;
    cells.clear();
    for (std::size_t i = 0; i < grid.polygons.size(); ++i)
        cells.emplace_back(grid.polygons[i].begin(), grid.polygons[i].end());
    add("_BthGrid.vtk", std::move(cells));
}

} // namespace

std::vector<DebugVtk> debug_vtk(const CaseDef& def, int threads)
{
    std::vector<DebugVtk> out;
    add_boxes(def, out);
    for (const DrawOp& op : def.ops)
        if (const auto* mesh = shape_as<MeshFileOp>(op);
            mesh != nullptr && (mesh->saves_points || mesh->saves_grid))
            add_bathymetry(def, op, threads, out);
    return out;
}

} // namespace fppg
