#include "meshes/inner_walls.h"

#include <algorithm>
#include <cstdint>
#include <unordered_map>
#include <utility>
#include <vector>

#include "meshes/edge_map.h"
#include "meshes/mesh_facets.h"
#include "meshes/mesh_query.h"

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

namespace
{

/// The patches that edges of more than two facets, and open ones, part: per facet its patch.
std::vector<std::uint32_t> find_patches(const SurfaceMesh& mesh, std::uint32_t& count)
{
    std::vector<std::uint32_t> patch_of(mesh.facets.size(), no_index);
    std::vector<std::uint32_t> found;
    count = 0;
    for (std::uint32_t seed = 0; seed < mesh.facets.size(); ++seed)
    {
        if (patch_of[seed] != no_index) continue;
        found.assign(1, seed);
        patch_of[seed] = count;
        for (std::size_t next = 0; next < found.size(); ++next)
            for (const std::uint32_t other : mesh.neighbours[found[next]])
                if (other != no_index && patch_of[other] == no_index)
                {
                    patch_of[other] = count;
                    found.push_back(other);
                }
        ++count;
    }
    return patch_of;
}

/// Whether a patch has one facet at each edge of its rim, and the other patches an even number.
std::vector<char> find_with_single_rims(const SurfaceMesh& mesh,
                                        const std::vector<std::uint32_t>& patch_of,
                                        std::uint32_t count)
{
    std::vector<std::pair<std::uint32_t, std::uint32_t>> sides; // edge, patch
    std::vector<char> is_candidate(count, 1), has_rim(count, 0);
    for (std::size_t f = 0; f < mesh.facets.size(); ++f)
        for (std::size_t s = 0; s < 3; ++s)
            if (mesh.neighbours[f][s] == no_index)
                sides.emplace_back(mesh.facet_edges[f][s], patch_of[f]);
    std::sort(sides.begin(), sides.end());
    for (std::size_t i = 0; i < sides.size();)
    {
        std::size_t end = i;
        while (end < sides.size() && sides[end].first == sides[i].first) ++end;
        for (std::size_t k = i; k < end; ++k)
        {
            const bool is_twice =
                (k > i && sides[k - 1] == sides[k]) || (k + 1 < end && sides[k + 1] == sides[k]);
            has_rim[sides[k].second] = 1;
            if (is_twice || end - i < 3 || (end - i) % 2 == 0) is_candidate[sides[k].second] = 0;
        }
        i = end;
    }
    for (std::uint32_t p = 0; p < count; ++p)
        if (has_rim[p] == 0) is_candidate[p] = 0;
    return is_candidate;
}

} // namespace

std::size_t drop_partitions(SurfaceMesh& mesh, int threads)
{
    if (std::find(mesh.is_manifold.begin(), mesh.is_manifold.end(), 0) == mesh.is_manifold.end())
        return 0;
    std::uint32_t count = 0;
    const std::vector<std::uint32_t> patch_of = find_patches(mesh, count);
    std::vector<char> is_wall = find_with_single_rims(mesh, patch_of, count);
    std::vector<std::uint32_t> largest(count, no_index);
    std::vector<double> area(count, 0);
    for (std::uint32_t f = 0; f < mesh.facets.size(); ++f)
    {
        const std::uint32_t p = patch_of[f];
        const double own = is_wall[p] != 0 ? measure(mesh, mesh.facets[f]).area : 0;
        if (own <= area[p]) continue;
        area[p] = own;
        largest[p] = f;
    }
    const MeshQuery query(soup_of(mesh), threads);
    for (std::uint32_t p = 0; p < count; ++p)
    {
        if (is_wall[p] == 0 || largest[p] == no_index) continue;
        const Facet& c = mesh.facets[largest[p]];
        const Vec3 middle = (mesh.vertices[c[0]] + mesh.vertices[c[1]] + mesh.vertices[c[2]]) / 3.0;
        int votes = 0;
        for (int axis = 0; axis < 3; ++axis)
        {
            std::size_t crossed = 0;
            for (const Crossing& crossing : query.crossings(middle, axis))
                crossed += patch_of[crossing.facet] != p ? 1 : 0;
            votes += crossed % 2 == 1 ? 1 : 0;
        }
        is_wall[p] = votes >= 2 ? 1 : 0;
    }
    std::vector<char> is_dropped(mesh.facets.size(), 0);
    std::size_t dropped = 0;
    for (std::size_t f = 0; f < mesh.facets.size(); ++f)
        dropped += static_cast<std::size_t>(is_dropped[f] = is_wall[patch_of[f]]);
    if (dropped == 0) return 0;
    erase_facets(is_dropped, mesh);
    build_edges(mesh, threads);
    return dropped;
}

} // namespace fppg
