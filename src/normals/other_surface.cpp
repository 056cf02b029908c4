#include "normals/other_surface.h"

#include "meshes/mesh_query.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <optional>
#include <utility>

namespace fppg
{
namespace
{

/// Polygons nearer to a surface than this are it, farther than that another thing, dp.
constexpr double same_dp = 0.05;
constexpr double other_dp = 2;

/// A triangle of a polygon: its middle, and its area.
struct Piece
{
    Vec3 middle;
    double area;
};

std::vector<Piece> pieces_of(const ShapePolygons& shape)
{
    std::vector<Piece> out;
    for (const std::vector<std::uint32_t>& polygon : shape.polygons)
        for (std::size_t k = 2; k < polygon.size(); ++k)
        {
            const Vec3& a = shape.vertices[polygon[0]];
            const Vec3& b = shape.vertices[polygon[k - 1]];
            const Vec3& c = shape.vertices[polygon[k]];
            out.push_back({(a + b + c) / 3, 0.5 * norm(cross(b - a, c - a))});
        }
    return out;
}

/// The distance, in metres, that half of the area of some pieces is within.
double median_distance(const std::vector<Piece>& pieces, const MeshQuery& surface)
{
    std::vector<std::pair<double, double>> by_distance;
    double all = 0;
    for (const Piece& piece : pieces)
    {
        by_distance.emplace_back(surface.closest_point(piece.middle).distance, piece.area);
        all += piece.area;
    }
    std::sort(by_distance.begin(), by_distance.end());
    double within = 0;
    for (const auto& [distance, area] : by_distance)
    {
        within += area;
        if (within >= 0.5 * all) return distance;
    }
    return 0;
}

} // namespace

std::optional<std::string> note_other_surfaces(const CaseDef& def,
                                               const std::vector<FittedBody>& bodies,
                                               const std::vector<ShapePolygons>& geometry,
                                               int threads)
{
    std::vector<char> has_layers(bodies.size(), 0);
    for (const FittedBody& body : bodies)
        if (body.is_layer()) has_layers[body.owner] = 1;
    std::map<std::uint16_t, TriangleSoup> surfaces;
    for (std::size_t b = 0; b < bodies.size(); ++b)
    {
        const FitSettings* settings = fit_settings(def.fit, bodies[b].mk);
        if (has_layers[b] == 0 || settings == nullptr || settings->depths_dp.empty() ||
            settings->depths_dp[0] <= 0 || bodies[b].is_inside)
            continue;
        const TriangleSoup soup = soup_of(bodies[b].mesh);
        std::vector<Vec3>& all = surfaces[bodies[b].mk].vertices;
        all.insert(all.end(), soup.vertices.begin(), soup.vertices.end());
    }
    std::vector<std::string> off;
    for (auto& [mk, soup] : surfaces)
    {
        std::vector<Piece> pieces;
        for (const ShapePolygons& shape : geometry)
            if (shape.mk == mk)
                for (const Piece& piece : pieces_of(shape)) pieces.push_back(piece);
        if (pieces.empty() || soup.vertices.empty()) continue;
        const double distance_dp =
            median_distance(pieces, MeshQuery(std::move(soup), threads)) / def.grid.dp;
        if (distance_dp > same_dp && distance_dp < other_dp)
            off.push_back(
                fmt::format("mkbound {}: {:.2g} dp", mk - def.mk_bound_first, distance_dp));
    }
    if (off.empty()) return std::nullopt;
    return fmt::format(
        "{}:{}: <norgeometry>: the surface in \"{}\" is not where the walls are "
        "drawn ({}). Body-fitted walls have theirs where they are drawn; to have it "
        "in the other place, draw them there.",
        def.file, def.normals.geometry->line, def.normals.geometry->file, fmt::join(off, ", "));
}

} // namespace fppg
