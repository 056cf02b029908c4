#include "offset/wall_depth.h"

#include "meshes/mesh_facets.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace fppg
{
namespace
{

/// A mitre is cut off where it is so much farther from its edge than deep: that of a corner of a
/// box is not, 1.73.
constexpr double longest_mitre = 1.8;

} // namespace

WallDepth::WallDepth(const SurfaceMesh& mesh, const MeshReport& report, bool is_solid,
                     WallSide side, double sharp_angle_deg, int threads)
    : mesh_(mesh),
      normals_(mesh_),
      test_(soup_of(mesh_), threads),
      asks_inside_(is_solid && !report.is_watertight),
      sign_(side == WallSide::Behind ? 1 : -1)
{
    for (const Vec3& v : mesh_.vertices) size_ = std::max(size_, largest_coordinate(v));
    const double turn = std::cos(sharp_angle_deg * std::numbers::pi / 180);
    is_sharp_.resize(mesh_.edges.size(), 0);
    for (std::size_t e = 0; e < mesh_.edges.size(); ++e)
    {
        const auto& facets = mesh_.edge_facets[e];
        if (facets[1] != no_index && mesh_.is_manifold[e] != 0)
            is_sharp_[e] = dot(mesh_.normals[facets[0]], mesh_.normals[facets[1]]) < turn ? 1 : 0;
    }
}

bool WallDepth::is_behind(const Vec3& p, const ClosestPoint& foot, FacetPlace& place) const
{
    const Vec3 out = p - foot.point;
    const double height = dot(out, mesh_.normals[foot.facet]);
    // Straight over the facet there is no doubt, and no need to look for edges.
    if (std::fabs(height) > (1 - 1e-12) * foot.distance) return height < 0;
    place = normals_.place_on_facet(foot.facet, foot.point, 1e-12 * size_);
    if (asks_inside_) return test_.is_inside(p);
    return dot(out, normals_.at(foot.facet, place)) < 0;
}

DepthPlace WallDepth::at(const Vec3& p, double within) const
{
    const ClosestPoint foot = query().closest_point(p, within);
    DepthPlace out;
    out.nearest = foot.point;
    out.foot = foot.point;
    out.facet = foot.facet;
    FacetPlace place;
    const bool is_behind_it = is_behind(p, foot, place);
    out.is_beyond_rim = normals_.is_open_at(foot.facet, place);
    out.depth = sign_ * (is_behind_it ? foot.distance : -foot.distance);
    if (foot.distance > 1e-9 * size_)
        out.direction = (p - foot.point) / out.depth;
    else
        out.direction = -sign_ * mesh_.normals[foot.facet];
    if (out.depth > 0 && (place.side >= 0 || place.corner >= 0)) mitre(p, foot.facet, place, out);
    return out;
}

void WallDepth::mitre(const Vec3& p, std::uint32_t facet, const FacetPlace& place,
                      DepthPlace& out) const
{
    double deepest = 0;
    std::uint32_t of = no_index;
    const auto look = [&](std::uint32_t edge)
    {
        if (is_sharp_[edge] == 0) return;
        for (const std::uint32_t f : mesh_.edge_facets[edge])
        {
            const double depth = -sign_ * dot(p - out.nearest, mesh_.normals[f]);
            if (depth < deepest || (depth == deepest && f >= of)) continue;
            deepest = depth;
            of = f;
        }
    };
    if (place.side >= 0)
        look(mesh_.facet_edges[facet][static_cast<std::size_t>(place.side)]);
    else
    {
        const std::uint32_t v = mesh_.facets[facet][static_cast<std::size_t>(place.corner)];
        for (const std::uint32_t f : normals_.facets_around(v))
            for (const std::uint32_t edge : mesh_.facet_edges[f])
                if (mesh_.edges[edge][0] == v || mesh_.edges[edge][1] == v) look(edge);
    }
    if (of == no_index) return;
    if (deepest < out.depth / longest_mitre)
    {
        out.depth /= longest_mitre;
        out.foot = p - out.depth * out.direction;
        return;
    }
    out.depth = deepest;
    out.direction = -sign_ * mesh_.normals[of];
    out.foot = p - deepest * out.direction;
    out.facet = of;
}

} // namespace fppg
