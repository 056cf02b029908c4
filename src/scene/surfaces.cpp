#include "scene/surfaces.h"

#include "fppg/error.h"

#include "meshes/mesh_library.h"
#include "scene/flat_shape.h"

#include <fmt/format.h>

#include <memory>
#include <utility>

namespace fppg
{
namespace
{

/// The whole of which setmknextauto draws this as the first part.
DrawOp whole_of(const DrawOp& draw)
{
    DrawOp whole = draw;
    auto state = std::make_shared<DrawState>(*draw.state);
    state->mk_next_auto = false;
    whole.state = std::move(state);
    if (auto* shape = std::get_if<Shape>(&whole.what))
        if (auto* polyhedron = std::get_if<PolyhedronOp>(shape)) polyhedron->part_count = 0;
    return whole;
}

} // namespace

const MeshFile* mesh_of(const Scene& scene, const DrawOp& draw, int threads)
{
    const auto* file = shape_as<MeshFileOp>(draw);
    if (file == nullptr) return nullptr;
    return &scene.meshes->read(draw.source, file->file, file->reading, threads).mesh;
}

std::vector<ShapeMesh> surfaces_of(const Scene& scene, const DrawOp& draw, PartsAs parts,
                                   int threads)
{
    const MeshFile* mesh = mesh_of(scene, draw, threads);
    if (mesh != nullptr && mesh->soup.vertices.empty()) return {};
    const LatticeGrid& grid = scene.def->grid;
    const auto* polyhedron = shape_as<PolyhedronOp>(draw);
    const bool is_part = polyhedron != nullptr && polyhedron->part_count > 0;
    const bool is_whole = parts == PartsAs::Drawn || (!is_part && !draw.state->mk_next_auto);
    if (!is_whole && is_part && polyhedron->part > 0) return {};
    std::vector<ShapeMesh> shapes = shape_meshes(is_whole ? draw : whole_of(draw), mesh, grid);
    give_section(shapes, grid);
    return shapes;
}

ShapeMesh surface_of_part(const Scene& scene, const Combination& combination, std::size_t part,
                          PartsAs parts, int threads)
{
    const DrawOp& draw = *combination.parts[part];
    const std::string place = place_of(*scene.def, draw.source);
    ShapeMesh joined;
    mesh_of(scene, draw, threads); // what is wrong with the file is said with its place
    try
    {
        for (const ShapeMesh& shape : surfaces_of(scene, draw, parts, threads))
        {
            joined.soup.vertices.insert(joined.soup.vertices.end(), shape.soup.vertices.begin(),
                                        shape.soup.vertices.end());
            joined.is_solid = joined.is_solid || shape.is_solid;
            if (shape.cad != nullptr) joined.cad = shape.cad;
        }
    }
    catch (const GeometryError& e)
    {
        throw GeometryError(fmt::format("{}: {}", place, e.what()));
    }
    if (joined.soup.vertices.empty())
        throw GeometryError(
            fmt::format("{}: has no surface, so that it cannot be a part of the <boolean> in "
                        "line {}",
                        place, combination.boolean->line));
    return joined;
}

std::string place_of(const CaseDef& def, const SourceRef& source)
{
    return fmt::format("{}:{}: <{}>", def.file, source.line, source.command);
}

std::string name_of(const SourceRef& source)
{
    return source.name.empty() ? fmt::format("<{}> in line {}", source.command, source.line)
                               : source.name;
}

} // namespace fppg
