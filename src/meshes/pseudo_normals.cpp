#include "meshes/pseudo_normals.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace fppg
{
namespace
{

/// Squared distance from p to the segment a b.
double squared_to_segment(const Vec3& a, const Vec3& b, const Vec3& p)
{
    const Vec3 along = b - a;
    const double length = dot(along, along);
    const double t = length > 0 ? std::clamp(dot(p - a, along) / length, 0.0, 1.0) : 0;
    const Vec3 away = p - (a + t * along);
    return dot(away, away);
}

/// The angle of the facet at its corner v.
double angle_at(const SurfaceMesh& mesh, std::uint32_t facet, std::uint32_t v)
{
    const auto& corners = mesh.facets[facet];
    const std::size_t at = corners[0] == v ? 0 : corners[1] == v ? 1 : 2;
    const Vec3& origin = mesh.vertices[corners[at]];
    const Vec3 a = mesh.vertices[corners[(at + 1) % 3]] - origin;
    const Vec3 b = mesh.vertices[corners[(at + 2) % 3]] - origin;
    return angle_between(a, b);
}

} // namespace

PseudoNormals::PseudoNormals(const SurfaceMesh& mesh) : mesh_(mesh)
{
    begin_.assign(mesh.vertices.size() + 2, 0);
    for (const auto& facet : mesh.facets)
        for (const std::uint32_t v : facet) ++begin_[v + 2];
    for (std::size_t v = 2; v < begin_.size(); ++v) begin_[v] += begin_[v - 1];
    around_.resize(3 * mesh.facets.size());
    for (std::uint32_t f = 0; f < mesh.facets.size(); ++f)
        for (const std::uint32_t v : mesh.facets[f]) around_[begin_[v + 1]++] = f;
}

Vec3 PseudoNormals::at_vertex(std::uint32_t vertex) const
{
    Vec3 sum;
    for (std::uint64_t i = begin_[vertex]; i < begin_[vertex + 1]; ++i)
        sum = sum + angle_at(mesh_, around_[i], vertex) * mesh_.normals[around_[i]];
    return sum;
}

Vec3 PseudoNormals::at_side(std::uint32_t facet, int side) const
{
    Vec3 sum;
    const std::uint32_t edge = mesh_.facet_edges[facet][static_cast<std::size_t>(side)];
    for (const std::uint32_t f : mesh_.edge_facets[edge])
        if (f != no_index) sum = sum + mesh_.normals[f];
    return sum;
}

Vec3 PseudoNormals::at(std::uint32_t facet, const FacetPlace& place) const
{
    if (place.corner >= 0)
        return at_vertex(mesh_.facets[facet][static_cast<std::size_t>(place.corner)]);
    return place.side >= 0 ? at_side(facet, place.side) : mesh_.normals[facet];
}

FacetPlace PseudoNormals::place_on_facet(std::uint32_t facet, const Vec3& p, double room) const
{
    const auto& corners = mesh_.facets[facet];
    const double squared = room * room;
    const int corner = nearest_corner(facet, p);
    const Vec3 away = mesh_.vertices[corners[static_cast<std::size_t>(corner)]] - p;
    if (dot(away, away) <= squared) return {corner, -1};
    const int side = nearest_side(facet, p);
    const auto s = static_cast<std::size_t>(side);
    if (squared_to_segment(mesh_.vertices[corners[s]], mesh_.vertices[corners[(s + 1) % 3]], p) <=
        squared)
        return {-1, side};
    return {};
}

double PseudoNormals::side_of(const Vec3& p, std::uint32_t facet, const Vec3& foot, double room,
                              FacetPlace& place) const
{
    const Vec3 off = p - foot;
    const double height = dot(off, mesh_.normals[facet]);
    // Straight over the facet there is no doubt, and no need to look for edges.
    if (std::fabs(height) > (1 - 1e-12) * norm(off)) return height;
    place = place_on_facet(facet, foot, room);
    return dot(off, at(facet, place));
}

bool PseudoNormals::is_open_at(std::uint32_t facet, const FacetPlace& place) const
{
    const auto is_open = [&](std::uint32_t edge) { return mesh_.edge_facets[edge][1] == no_index; };
    if (place.side >= 0)
        return is_open(mesh_.facet_edges[facet][static_cast<std::size_t>(place.side)]);
    if (place.corner < 0) return false;
    const std::uint32_t v = mesh_.facets[facet][static_cast<std::size_t>(place.corner)];
    for (std::uint64_t i = begin_[v]; i < begin_[v + 1]; ++i)
        for (const std::uint32_t edge : mesh_.facet_edges[around_[i]])
            if ((mesh_.edges[edge][0] == v || mesh_.edges[edge][1] == v) && is_open(edge))
                return true;
    return false;
}

int PseudoNormals::nearest_corner(std::uint32_t facet, const Vec3& p) const
{
    int nearest = 0;
    double least = std::numeric_limits<double>::infinity();
    for (int c = 0; c < 3; ++c)
    {
        const Vec3 away = mesh_.vertices[mesh_.facets[facet][static_cast<std::size_t>(c)]] - p;
        if (dot(away, away) >= least) continue;
        least = dot(away, away);
        nearest = c;
    }
    return nearest;
}

int PseudoNormals::nearest_side(std::uint32_t facet, const Vec3& p) const
{
    const auto& corners = mesh_.facets[facet];
    int nearest = 0;
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t s = 0; s < 3; ++s)
    {
        const double d =
            squared_to_segment(mesh_.vertices[corners[s]], mesh_.vertices[corners[(s + 1) % 3]], p);
        if (d >= least) continue;
        least = d;
        nearest = static_cast<int>(s);
    }
    return nearest;
}

} // namespace fppg
