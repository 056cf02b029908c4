#include "fit/wall_section.h"

#include "fit/plane_cut.h"

namespace fppg
{

WallSection wall_section(const SurfaceMesh& mesh, double plane_y)
{
    WallSection section;
    for (const PlanePiece& piece : cut_with_plane(mesh, plane_y))
    {
        const Vec3 p = plane_crossing(mesh, piece.from_edge, plane_y);
        const Vec3 q = plane_crossing(mesh, piece.to_edge, plane_y);
        if (p == q) continue;
        const Vec3 side{p.z - q.z, 0, q.x - p.x};
        const double length = norm(side);
        const double sign = dot(side, mesh.normals[piece.facet]) < 0 ? -1 : 1;
        section.soup.vertices.insert(section.soup.vertices.end(), {p, q, q});
        section.normals.push_back(side * (sign / length));
        section.lengths.push_back(length);
        section.facets.push_back(piece.facet);
    }
    return section;
}

} // namespace fppg
