#include "batch/wall_geometry.h"

#include "fppg/shapes.h"

#include "casedef/mesh_path.h"
#include "lattice/shape_mesh.h"

#include <variant>

namespace fppg
{

TriangleSoup wall_geometry(const std::string& path, const CaseOptions& options, int threads)
{
    const CaseDef def = read_case(path, options);
    TriangleSoup out;
    for (const DrawOp& op : def.ops)
    {
        if (!op.state || op.state->mk.kind != MkKind::Bound || !op.state->draw_points) continue;
        MeshFile file;
        if (const auto* mesh = std::get_if<MeshFileOp>(&op.what))
        {
            file =
                read_mesh_file(find_mesh_file(def, op.source, mesh->file), mesh->reading, threads);
            if (file.soup.size() == 0) continue;
        }
        for (const ShapeMesh& shape : shape_meshes(op, &file.soup, def.grid.dp))
            out.vertices.insert(out.vertices.end(), shape.soup.vertices.begin(),
                                shape.soup.vertices.end());
    }
    return out;
}

} // namespace fppg
