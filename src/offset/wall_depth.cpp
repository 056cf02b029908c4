#include "offset/wall_depth.h"

#include "meshes/mesh_facets.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace fppg
{
namespace
{

/// Facets whose normals' cosine is so near to 1 lie in a plane; to -1, at an edge that they share,
/// on one another.
constexpr double near_one = 1 - 1e-6;

/// The facets that may lie on others, face to face: those at the edge of a fold, and what lies in
/// a plane with them.
std::vector<char> find_folded(const SurfaceMesh& mesh)
{
    std::vector<char> is_folded(mesh.facets.size(), 0);
    std::vector<std::uint32_t> next;
    const auto add = [&](std::uint32_t f)
    {
        if (std::exchange(is_folded[f], 1) == 0) next.push_back(f);
    };
    const auto cosine = [&](std::uint32_t e)
    {
        const auto& facets = mesh.edge_facets[e];
        return facets[1] == no_index ? 0 : dot(mesh.normals[facets[0]], mesh.normals[facets[1]]);
    };
    for (std::uint32_t e = 0; e < mesh.edges.size(); ++e)
        if (cosine(e) < -near_one)
            for (const std::uint32_t f : mesh.edge_facets[e]) add(f);
    while (!next.empty())
    {
        const std::uint32_t f = next.back();
        next.pop_back();
        for (const std::uint32_t e : mesh.facet_edges[f])
            if (std::fabs(cosine(e)) > near_one)
                for (const std::uint32_t g : mesh.edge_facets[e]) add(g);
    }
    return is_folded;
}

} // namespace

WallDepth::WallDepth(const SurfaceMesh& mesh, const MeshReport& report, bool is_solid,
                     WallSide side, double sharp_angle_deg, int threads)
    : mesh_(mesh),
      normals_(mesh_),
      test_(soup_of(mesh_), threads),
      is_solid_(is_solid),
      asks_inside_(is_solid && !report.is_watertight),
      sign_(side == WallSide::Behind ? 1 : -1),
      is_folded_(is_solid ? find_folded(mesh_) : std::vector<char>(mesh_.facets.size(), 0)),
      turn_(std::cos(sharp_angle_deg * std::numbers::pi / 180))
{
    query().prepare_nearest();
    for (const Vec3& v : mesh_.vertices) size_ = std::max(size_, largest_coordinate(v));
    is_sharp_.resize(mesh_.edges.size(), 0);
    TriangleSoup mitred;
    for (std::size_t e = 0; e < mesh_.edges.size(); ++e)
    {
        const auto& facets = mesh_.edge_facets[e];
        if (facets[1] == no_index || mesh_.is_manifold[e] == 0) continue;
        const Vec3& begin = mesh_.vertices[mesh_.edges[e][0]];
        const Vec3& end = mesh_.vertices[mesh_.edges[e][1]];
        is_sharp_[e] = dot(mesh_.normals[facets[0]], mesh_.normals[facets[1]]) < turn_ ? 1 : 0;
        if (is_sharp_[e] == 0) continue;
        double rise = 0; // of one facet over the plane of the other
        for (const std::uint32_t v : mesh_.facets[facets[1]])
            rise += dot(mesh_.vertices[v] - begin, mesh_.normals[facets[0]]);
        if (sign_ * rise > 0) mitred.vertices.insert(mitred.vertices.end(), {begin, end, end});
    }
    if (!mitred.vertices.empty()) mitres_ = std::make_unique<MeshQuery>(std::move(mitred), threads);
}

void WallDepth::take_round_surface(const SurfaceMesh& body,
                                   std::shared_ptr<const RoundSurface> round, bool is_2d)
{
    // Where the inside is in doubt, so is the side of the exact surface.
    if (round != nullptr && !asks_inside_)
        round_ = std::make_unique<RoundWall>(body, std::move(round), is_2d);
}

void WallDepth::take_cad_surface(const SurfaceMesh& body, std::shared_ptr<const CadSurface> cad,
                                 bool is_2d, int threads)
{
    if (cad == nullptr || asks_inside_) return;
    cad_ = std::move(cad);
    if (is_2d)
        cad_body_ = std::make_unique<CadBody>(CadBody{body, MeshQuery(soup_of(body), threads)});
}

/// Nothing where the facets are asked.
std::optional<ExactPlace> WallDepth::exact_place(const Vec3& p, const ClosestPoint& foot) const
{
    if (round_ != nullptr)
        if (auto exact = round_->at(p, foot.point)) return exact;
    if (cad_body_ != nullptr)
        return cad_->in_plane(cad_body_->mesh, p, foot.point,
                              cad_body_->query.closest_point(foot.point).facet);
    if (cad_ != nullptr) return cad_->at(mesh_, p, foot.point, foot.facet);
    return std::nullopt;
}

double WallDepth::chord() const
{
    return round_ != nullptr ? round_->chord() : cad_ != nullptr ? cad_->chord() : 0;
}

DepthPlace WallDepth::seen_from(const ExactPlace& place, const Vec3& p, std::uint32_t facet) const
{
    DepthPlace out;
    out.nearest = place.nearest;
    out.foot = place.nearest;
    out.facet = facet;
    out.is_beyond_rim = place.is_beyond_rim;
    const Vec3 way = p - place.nearest;
    const double distance = norm(way);
    const bool is_on_rim = place.face_count == 2;
    const Vec3 normal = is_on_rim ? place.faces[0] + place.faces[1] : place.faces[0];
    out.depth = sign_ * (dot(way, normal) < 0 ? distance : -distance);
    if (distance > 1e-9 * size_)
        out.direction = way / out.depth;
    else
        out.direction = -sign_ * unit(normal);
    // A mitre, as behind edges of facets.
    if (!is_on_rim || !(out.depth > 0) || dot(place.faces[0], place.faces[1]) >= turn_) return out;
    const double of_first = -sign_ * dot(way, place.faces[0]);
    const double of_second = -sign_ * dot(way, place.faces[1]);
    const double deepest = std::max(of_first, of_second);
    if (deepest < out.depth / longest_mitre)
    {
        out.depth /= longest_mitre;
        out.foot = p - out.depth * out.direction;
        return out;
    }
    out.depth = deepest;
    out.direction = -sign_ * place.faces[of_first >= of_second ? 0 : 1];
    out.foot = p - out.depth * out.direction;
    return out;
}

bool WallDepth::is_behind(const Vec3& p, const ClosestPoint& foot, FacetPlace& place) const
{
    const double side = normals_.side_of(p, foot.facet, foot.point, 1e-12 * size_, place);
    const bool is_beside = place.side >= 0 || place.corner >= 0;
    const bool is_doubtful = (asks_inside_ && is_beside) || is_folded_[foot.facet] != 0;
    return is_doubtful ? test_.is_inside(p) : side < 0;
}

DepthPlace WallDepth::at(const Vec3& p, double within) const
{
    ClosestPoint foot = query().closest_point(p, within);
    // The facets of a round body may be farther than the exact surface that the bound is of.
    if (foot.facet >= mesh_.facets.size()) foot = query().closest_point(p);
    if (const auto exact = exact_place(p, foot)) return seen_from(*exact, p, foot.facet);
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
