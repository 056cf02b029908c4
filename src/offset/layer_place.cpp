#include "offset/layer_place.h"

#include "offset/offset_surface.h"

#include <vector>

namespace fppg
{

Vec3 LayerPlaces::place(const Vec3& p, FitKind kind, std::uint32_t facet) const
{
    const WallDepth& wall = *layer_.wall;
    const SurfaceMesh& mesh = layer_.mesh;
    if (kind != FitKind::Edge && kind != FitKind::Corner)
        return project_to_depth(wall, p, layer_.depth);
    std::vector<Vec3> towards;
    const auto add = [&](std::uint32_t f)
    {
        Vec3 middle;
        for (const std::uint32_t v : mesh.facets[f]) middle = middle + mesh.vertices[v] / 3;
        towards.push_back(middle);
    };
    if (kind == FitKind::Corner)
    {
        const auto corner = static_cast<std::size_t>(around_.nearest_corner(facet, p));
        for (const std::uint32_t f : around_.facets_around(mesh.facets[facet][corner])) add(f);
    }
    else
    {
        const auto side = static_cast<std::size_t>(around_.nearest_side(facet, p));
        for (const std::uint32_t f : mesh.edge_facets[mesh.facet_edges[facet][side]])
            if (f != no_index) add(f);
    }
    return project_to_crease(wall, p, layer_.depth, dp_, towards);
}

} // namespace fppg
