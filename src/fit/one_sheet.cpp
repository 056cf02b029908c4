#include "fppg/one_sheet.h"

#include "core/parallel.h"
#include "meshes/mesh_query.h"
#include "meshes/point_grid.h"

#include <cmath>
#include <tuple>
#include <vector>

namespace fppg
{
namespace
{

/// Two particles on either side of a plate lie up to this far apart, dp: its thickness and half a
/// spacing along it.
constexpr double reach_dp = 1.2;
/// Tells the sides of a surface that faces itself; no plane of a drawing is likely to contain it.
constexpr Vec3 staying_side{0.36, 0.48, 0.8};
/// A corner of a plate lies this far from the nearest particle on its sides, dp.
constexpr double rim_reach_dp = 2;

/// Smooth parts of a surface: facets joined by edges that are no features.
struct SmoothParts
{
    std::vector<std::uint32_t> of_facet;
    std::vector<double> areas;
};

SmoothParts smooth_parts(const SurfaceMesh& mesh, const Features& features)
{
    SmoothParts parts;
    parts.of_facet.assign(mesh.facets.size(), no_index);
    std::vector<std::uint32_t> open;
    for (std::uint32_t first = 0; first < mesh.facets.size(); ++first)
    {
        if (parts.of_facet[first] != no_index) continue;
        const auto part = static_cast<std::uint32_t>(parts.areas.size());
        parts.areas.push_back(0);
        parts.of_facet[first] = part;
        open.push_back(first);
        while (!open.empty())
        {
            const std::uint32_t f = open.back();
            open.pop_back();
            parts.areas[part] += mesh.areas[f];
            for (std::size_t side = 0; side < 3; ++side)
            {
                const std::uint32_t next = mesh.neighbours[f][side];
                if (next == no_index || parts.of_facet[next] != no_index ||
                    features.is_feature_edge[mesh.facet_edges[f][side]])
                    continue;
                parts.of_facet[next] = part;
                open.push_back(next);
            }
        }
    }
    return parts;
}

} // namespace

SurfaceParticles keep_one_sheet(const SurfaceMesh& mesh, const Features& features,
                                const OneSheetOptions& options, SurfaceParticles& particles,
                                int threads)
{
    const double dp = options.dp;
    const std::size_t n = particles.positions.size();
    const SmoothParts parts = smooth_parts(mesh, features);
    const auto part_of = [&](std::size_t i) { return parts.of_facet[particles.facets[i]]; };
    const auto side_of = [&](std::size_t i)
    { return dot(mesh.normals[particles.facets[i]], staying_side); };
    const auto gives_way = [&](std::size_t i, std::size_t j)
    {
        const std::uint32_t a = part_of(i), b = part_of(j);
        if (a == b) return side_of(i) < side_of(j);
        return std::tuple(parts.areas[a], b) < std::tuple(parts.areas[b], a);
    };
    PointGrid grid(reach_dp * dp, n);
    for (const Vec3& p : particles.positions) grid.add(p);

    std::vector<char> is_taken(n, 0);
    std::vector<std::uint32_t> stays(n, no_index); ///< the part that a taken particle gave way to
    parallel_for(
        n, threads,
        [&](std::size_t i)
        {
            if (particles.kinds[i] != FitKind::Surface) return;
            const Vec3& normal = mesh.normals[particles.facets[i]];
            grid.for_each_near(particles.positions[i], reach_dp * dp,
                               [&](std::uint32_t j, double squared)
                               {
                                   if (particles.kinds[j] != FitKind::Surface ||
                                       dot(normal, mesh.normals[particles.facets[j]]) > -0.5)
                                       return;
                                   // Behind this particle, through the plate, and not farther than
                                   // it is thick.
                                   const double depth =
                                       dot(particles.positions[i] - particles.positions[j], normal);
                                   if (depth <= 0 || depth >= options.thickness * dp ||
                                       squared - depth * depth > dp * dp)
                                       return;
                                   if (!gives_way(i, j)) return;
                                   is_taken[i] = 1;
                                   stays[i] = std::min(stays[i], part_of(j));
                               });
        },
        1024);

    // Rims and narrow sides: what is near a taken particle and near the sheet that stays, but not
    // on it.
    std::vector<char> is_winner(parts.areas.size(), 0);
    PointGrid taken(rim_reach_dp * dp, 64);
    for (std::size_t i = 0; i < n; ++i)
    {
        if (!is_taken[i]) continue;
        is_winner[stays[i]] = 1;
        taken.add(particles.positions[i]);
    }
    TriangleSoup sheet;
    for (std::size_t f = 0; f < mesh.facets.size(); ++f)
        if (is_winner[parts.of_facet[f]])
            for (const std::uint32_t v : mesh.facets[f]) sheet.vertices.push_back(mesh.vertices[v]);
    if (sheet.vertices.empty()) return {};
    const MeshQuery query(std::move(sheet), threads);
    std::vector<char> is_rim(n, 0);
    parallel_for(
        n, threads,
        [&](std::size_t i)
        {
            if (is_taken[i] || !taken.has_nearer(particles.positions[i], rim_reach_dp * dp)) return;
            const double distance = query.closest_point(particles.positions[i]).distance;
            is_rim[i] = distance > 1e-6 * dp && distance < dp;
        },
        1024);

    SurfaceParticles out;
    std::size_t kept = 0;
    for (std::size_t i = 0; i < n; ++i)
    {
        if (is_taken[i] || is_rim[i])
        {
            out.positions.push_back(particles.positions[i]);
            out.kinds.push_back(particles.kinds[i]);
            out.facets.push_back(particles.facets[i]);
            continue;
        }
        particles.positions[kept] = particles.positions[i];
        particles.kinds[kept] = particles.kinds[i];
        particles.facets[kept] = particles.facets[i];
        ++kept;
    }
    particles.positions.resize(kept);
    particles.kinds.resize(kept);
    particles.facets.resize(kept);
    return out;
}

} // namespace fppg
