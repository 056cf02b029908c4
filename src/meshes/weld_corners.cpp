#include "meshes/weld_corners.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <unordered_map>
#include <utility>
#include <vector>

#include "core/parallel_sort.h"
#include "meshes/mesh_facets.h"

namespace fppg
{

namespace
{

bool is_before(const Vec3& a, const Vec3& b)
{
    if (a.x != b.x) return a.x < b.x;
    return a.y != b.y ? a.y < b.y : a.z < b.z;
}

} // namespace

void weld_equal(const TriangleSoup& soup, int threads, SurfaceMesh& mesh)
{
    const std::size_t n = soup.vertices.size();
    std::vector<std::uint32_t> order(n);
    for (std::size_t i = 0; i < n; ++i) order[i] = static_cast<std::uint32_t>(i);
    const std::vector<Vec3>& p = soup.vertices;
    parallel_sort(order, threads,
                  [&p](std::uint32_t a, std::uint32_t b)
                  {
                      if (is_before(p[a], p[b])) return true;
                      if (is_before(p[b], p[a])) return false;
                      return a < b;
                  });
    // The first corner of each place stands for it; places are numbered in the order of the file.
    std::vector<std::uint32_t> first(n);
    for (std::size_t i = 0; i < n; ++i)
        first[order[i]] =
            i > 0 && !is_before(p[order[i - 1]], p[order[i]]) ? first[order[i - 1]] : order[i];
    std::vector<std::uint32_t>& index = order;
    for (std::size_t i = 0; i < n; ++i)
    {
        if (first[i] == i)
        {
            index[i] = static_cast<std::uint32_t>(mesh.vertices.size());
            mesh.vertices.push_back({p[i].x + 0.0, p[i].y + 0.0, p[i].z + 0.0});
        }
        else
            index[i] = index[first[i]];
    }
    mesh.facets.resize(soup.size());
    for (std::size_t i = 0; i < n; ++i) mesh.facets[i / 3][i % 3] = index[i];
}

void weld_near(double distance, const std::vector<char>& may_move, SurfaceMesh& mesh)
{
    const auto cell_of = [&](const Vec3& p, int axis)
    { return static_cast<std::int64_t>(std::floor(std::clamp(p[axis] / distance, -9e18, 9e18))); };
    const auto key_of = [](std::int64_t i, std::int64_t j, std::int64_t k)
    {
        return static_cast<std::uint64_t>(i) * 0x9E3779B97F4A7C15 ^
               static_cast<std::uint64_t>(j) * 0xC2B2AE3D27D4EB4F ^
               static_cast<std::uint64_t>(k) * 0x165667B19E3779F9;
    };
    std::unordered_map<std::uint64_t, std::vector<std::uint32_t>> places;
    std::vector<std::uint32_t> index(mesh.vertices.size());
    std::vector<Vec3> kept;
    for (std::size_t v = 0; v < mesh.vertices.size(); ++v)
    {
        const Vec3& p = mesh.vertices[v];
        if (!may_move.empty() && may_move[v] == 0)
        {
            index[v] = static_cast<std::uint32_t>(kept.size());
            kept.push_back(p);
            continue;
        }
        const std::int64_t i = cell_of(p, 0), j = cell_of(p, 1), k = cell_of(p, 2);
        std::uint32_t best = no_index;
        double best_distance = distance;
        for (std::int64_t cell = 0; cell < 27; ++cell)
        {
            const auto found =
                places.find(key_of(i + cell % 3 - 1, j + cell / 3 % 3 - 1, k + cell / 9 - 1));
            if (found == places.end()) continue;
            for (const std::uint32_t other : found->second)
            {
                const double d = norm(kept[other] - p);
                if (d < best_distance || (d == best_distance && other < best))
                {
                    best = other;
                    best_distance = d;
                }
            }
        }
        if (best == no_index)
        {
            best = static_cast<std::uint32_t>(kept.size());
            places[key_of(i, j, k)].push_back(best);
            kept.push_back(p);
        }
        index[v] = best;
    }
    mesh.vertices = std::move(kept);
    for (Facet& facet : mesh.facets)
        for (std::uint32_t& corner : facet) corner = index[corner];
}

} // namespace fppg
