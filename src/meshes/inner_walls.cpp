#include "meshes/inner_walls.h"

#include <cstdint>
#include <unordered_map>

#include "meshes/edge_map.h"
#include "meshes/mesh_facets.h"

namespace fppg
{

void keep_inner_walls(const SurfaceMesh& mesh, std::vector<char>& is_twin)
{
    std::unordered_map<std::uint32_t, std::vector<std::uint32_t>> sides_at; // 3 * facet + side
    for (std::size_t f = 0; f < mesh.facets.size(); ++f)
        if (is_twin[f] != 0)
            for (const std::uint32_t e : mesh.facet_edges[f]) sides_at[e];
    for (std::size_t f = 0; f < mesh.facets.size(); ++f)
        for (std::size_t s = 0; s < 3; ++s)
            if (const auto at = sides_at.find(mesh.facet_edges[f][s]); at != sides_at.end())
                at->second.push_back(static_cast<std::uint32_t>(3 * f + s));

    const auto ends_well = [&](std::uint32_t f, std::size_t s)
    {
        const std::vector<std::uint32_t>& sides = sides_at.at(mesh.facet_edges[f][s]);
        if (sides.size() != 3) return false;
        const Vec3 normal = measure(mesh, mesh.facets[f]).normal;
        int way = 0;
        for (const std::uint32_t side : sides)
        {
            const std::uint32_t other = side / 3;
            if (other == f) continue;
            if (is_twin[other] != 0) return false;
            const bool goes_on = runs_upwards(mesh, other, side % 3) != runs_upwards(mesh, f, s);
            const Vec3 away = mesh.vertices[mesh.facets[other][(side % 3 + 2) % 3]] -
                              mesh.vertices[mesh.facets[f][s]];
            const double ahead = dot(normal, away);
            if (goes_on ? !(ahead < 0) : !(ahead > 0)) return false;
            way += goes_on ? 1 : -1;
        }
        return way == 0;
    };
    std::vector<char> is_seen(mesh.facets.size(), 0);
    std::vector<std::uint32_t> patch;
    for (std::size_t seed = 0; seed < mesh.facets.size(); ++seed)
    {
        if (is_twin[seed] == 0 || is_seen[seed] != 0) continue;
        patch.assign(1, static_cast<std::uint32_t>(seed));
        is_seen[seed] = 1;
        bool is_wall = true, has_rim = false;
        for (std::size_t next = 0; next < patch.size(); ++next)
            for (std::size_t s = 0; s < 3; ++s)
            {
                const std::uint32_t f = patch[next], other = mesh.neighbours[f][s];
                if (other == no_index || is_twin[other] == 0)
                {
                    has_rim = true;
                    is_wall = is_wall && ends_well(f, s);
                    continue;
                }
                if (is_seen[other] == 0) patch.push_back(other);
                is_seen[other] = 1;
            }
        if (is_wall && has_rim) continue;
        for (const std::uint32_t f : patch) is_twin[f] = 0;
    }
}

} // namespace fppg
