#include "fit/plane_cut.h"

namespace fppg
{

std::vector<PlanePiece> cut_with_plane(const SurfaceMesh& mesh, double y)
{
    std::vector<char> has_below;
    for (std::size_t f = 0; f < mesh.facets.size(); ++f)
    {
        if (mesh.shells[f] >= has_below.size()) has_below.resize(mesh.shells[f] + 1, 0);
        for (const std::uint32_t v : mesh.facets[f])
            if (mesh.vertices[v].y < y) has_below[mesh.shells[f]] = 1;
    }
    std::vector<PlanePiece> pieces;
    for (std::uint32_t f = 0; f < mesh.facets.size(); ++f)
    {
        const bool level_is_above = has_below[mesh.shells[f]] != 0;
        const auto is_above = [&](std::size_t corner)
        {
            const double height = mesh.vertices[mesh.facets[f][corner]].y;
            return height > y || (height == y && level_is_above);
        };
        PlanePiece piece{f, no_index, no_index};
        for (std::size_t side = 0; side < 3; ++side)
        {
            const bool from = is_above(side);
            const bool to = is_above((side + 1) % 3);
            if (from && !to) piece.from_edge = mesh.facet_edges[f][side];
            if (!from && to) piece.to_edge = mesh.facet_edges[f][side];
        }
        if (piece.from_edge != no_index) pieces.push_back(piece);
    }
    return pieces;
}

Vec3 plane_crossing(const SurfaceMesh& mesh, std::uint32_t edge, double y)
{
    const Vec3& a = mesh.vertices[mesh.edges[edge][0]];
    const Vec3& b = mesh.vertices[mesh.edges[edge][1]];
    if (a.y == y) return a;
    if (b.y == y) return b;
    const double share = (y - a.y) / (b.y - a.y);
    return {a.x + (b.x - a.x) * share, y, a.z + (b.z - a.z) * share};
}

} // namespace fppg
