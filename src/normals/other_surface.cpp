#include "normals/other_surface.h"

#include "meshes/surface_distance.h"

#include <fmt/format.h>

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

/// The polygons of a shape in triangles.
void add_triangles(const ShapePolygons& shape, TriangleSoup& out)
{
    for (const std::vector<std::uint32_t>& polygon : shape.polygons)
        for (std::size_t k = 2; k < polygon.size(); ++k)
            for (const std::size_t corner : {std::size_t{0}, k - 1, k})
                out.vertices.push_back(shape.vertices[polygon[corner]]);
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
        TriangleSoup drawn;
        for (const ShapePolygons& shape : geometry)
            if (shape.mk == mk) add_triangles(shape, drawn);
        if (def.grid.is_2d)
            for (TriangleSoup* facets : {&drawn, &soup})
                *facets = pressed_to_plane(*facets, def.grid.origin.y);
        if (drawn.vertices.empty() || soup.vertices.empty()) continue;
        const double distance_dp =
            distance_of_share(drawn, MeshQuery(std::move(soup), threads), 0.5) / def.grid.dp;
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
