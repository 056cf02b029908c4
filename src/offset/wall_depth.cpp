#include "offset/wall_depth.h"

#include "meshes/mesh_facets.h"

#include <algorithm>
#include <cmath>

namespace fppg
{

WallDepth::WallDepth(const SurfaceMesh& mesh, const MeshReport& report, bool is_solid,
                     WallSide side, int threads)
    : mesh_(mesh),
      normals_(mesh_),
      test_(soup_of(mesh_), threads),
      asks_inside_(is_solid && !report.is_watertight),
      sign_(side == WallSide::Behind ? 1 : -1)
{
    for (const Vec3& v : mesh_.vertices) size_ = std::max(size_, largest_coordinate(v));
}

bool WallDepth::is_behind(const Vec3& p, const ClosestPoint& foot, bool& is_on_rim) const
{
    const Vec3 out = p - foot.point;
    const Vec3& flat = mesh_.normals[foot.facet];
    const double height = dot(out, flat);
    // Straight over the facet there is no doubt, and no need to look for edges.
    const bool is_over = std::fabs(height) > (1 - 1e-12) * foot.distance;
    if (is_over) return height < 0;
    const FacetPlace place = normals_.place_on_facet(foot.facet, foot.point, 1e-12 * size_);
    is_on_rim = normals_.is_open_at(foot.facet, place);
    if (asks_inside_) return test_.is_inside(p);
    return dot(out, normals_.at(foot.facet, place)) < 0;
}

DepthPlace WallDepth::at(const Vec3& p, double within) const
{
    const ClosestPoint foot = query().closest_point(p, within);
    DepthPlace out;
    out.foot = foot.point;
    out.facet = foot.facet;
    const bool is_behind_it = is_behind(p, foot, out.is_beyond_rim);
    out.depth = sign_ * (is_behind_it ? foot.distance : -foot.distance);
    if (foot.distance > 1e-9 * size_)
        out.direction = (p - foot.point) / out.depth;
    else
        out.direction = -sign_ * mesh_.normals[foot.facet];
    return out;
}

} // namespace fppg
