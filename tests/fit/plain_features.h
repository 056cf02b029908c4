#pragma once

#include "fit/neighbour_grid.h"
#include "fppg/features.h"

#include <algorithm>
#include <map>

namespace fppg
{

/// Plain versions of what the stages before the fitting do, for shapes that need no mending:
/// vertices with equal coordinates are one.
inline SurfaceMesh plain_mesh(const TriangleSoup& soup)
{
    SurfaceMesh mesh;
    std::map<std::array<double, 3>, std::uint32_t> names;
    for (std::size_t f = 0; f < soup.size(); ++f)
    {
        std::array<std::uint32_t, 3> facet{};
        for (std::size_t k = 0; k < 3; ++k)
        {
            const Vec3& p = soup.vertices[3 * f + k];
            const auto [at, is_new] = names.try_emplace(
                {p.x, p.y, p.z}, static_cast<std::uint32_t>(mesh.vertices.size()));
            if (is_new) mesh.vertices.push_back(p);
            facet[k] = at->second;
        }
        const Vec3& a = mesh.vertices[facet[0]];
        const Vec3 n = cross(mesh.vertices[facet[1]] - a, mesh.vertices[facet[2]] - a);
        if (facet[0] == facet[1] || facet[1] == facet[2] || facet[2] == facet[0] || norm(n) == 0)
            continue;
        mesh.facets.push_back(facet);
        mesh.normals.push_back(n / norm(n));
        mesh.areas.push_back(0.5 * norm(n));
    }
    std::map<std::array<std::uint32_t, 2>, std::vector<std::uint32_t>> facets_of;
    for (std::uint32_t f = 0; f < mesh.facets.size(); ++f)
        for (std::size_t s = 0; s < 3; ++s)
        {
            const std::uint32_t a = mesh.facets[f][s];
            const std::uint32_t b = mesh.facets[f][(s + 1) % 3];
            facets_of[{std::min(a, b), std::max(a, b)}].push_back(f);
        }
    mesh.facet_edges.resize(mesh.facets.size());
    mesh.neighbours.assign(mesh.facets.size(), {no_index, no_index, no_index});
    for (const auto& [ends, facets] : facets_of)
    {
        const auto edge = static_cast<std::uint32_t>(mesh.edges.size());
        mesh.edges.push_back(ends);
        mesh.edge_facets.push_back({facets[0], facets.size() > 1 ? facets[1] : no_index});
        mesh.is_manifold.push_back(facets.size() <= 2);
        for (const std::uint32_t f : facets)
            for (std::size_t s = 0; s < 3; ++s)
            {
                const std::uint32_t a = mesh.facets[f][s];
                const std::uint32_t b = mesh.facets[f][(s + 1) % 3];
                if (std::min(a, b) != ends[0] || std::max(a, b) != ends[1]) continue;
                mesh.facet_edges[f][s] = edge;
                if (facets.size() == 2)
                    mesh.neighbours[f][s] = facets[0] == f ? facets[1] : facets[0];
            }
    }
    return mesh;
}

inline Features plain_features(const SurfaceMesh& mesh, double angle_deg = 30,
                               double corner_angle_deg = 45)
{
    constexpr double degree = 3.14159265358979323846 / 180;
    Features features;
    features.is_feature_edge.assign(mesh.edges.size(), 0);
    std::vector<std::vector<std::uint32_t>> edges_at(mesh.vertices.size());
    for (std::uint32_t e = 0; e < mesh.edges.size(); ++e)
    {
        const auto& facets = mesh.edge_facets[e];
        const bool is_feature =
            !mesh.is_manifold[e] || facets[1] == no_index ||
            dot(mesh.normals[facets[0]], mesh.normals[facets[1]]) < std::cos(angle_deg * degree);
        if (!is_feature) continue;
        features.is_feature_edge[e] = 1;
        features.edges.push_back(e);
        for (const std::uint32_t v : mesh.edges[e]) edges_at[v].push_back(e);
    }
    const auto other_end = [&](std::uint32_t e, std::uint32_t v)
    { return mesh.edges[e][0] == v ? mesh.edges[e][1] : mesh.edges[e][0]; };
    std::vector<char> is_singular(mesh.vertices.size(), 0);
    for (std::uint32_t v = 0; v < mesh.vertices.size(); ++v)
    {
        const auto& edges = edges_at[v];
        if (edges.empty()) continue;
        bool is_end = edges.size() != 2;
        if (!is_end)
        {
            const Vec3 a = mesh.vertices[v] - mesh.vertices[other_end(edges[0], v)];
            const Vec3 b = mesh.vertices[other_end(edges[1], v)] - mesh.vertices[v];
            is_end = dot(a, b) < std::cos(corner_angle_deg * degree) * norm(a) * norm(b);
        }
        if (!is_end) continue;
        is_singular[v] = 1;
        features.singular.push_back(v);
    }
    std::vector<char> is_used(mesh.edges.size(), 0);
    const auto follow = [&](std::uint32_t start, std::uint32_t edge)
    {
        FeatureLine line;
        line.vertices.push_back(start);
        std::uint32_t v = start;
        while (edge != no_index)
        {
            is_used[edge] = 1;
            const std::uint32_t next = other_end(edge, v);
            line.length += norm(mesh.vertices[next] - mesh.vertices[v]);
            v = next;
            if (v == start && !is_singular[v])
            {
                line.is_closed = true;
                break;
            }
            line.vertices.push_back(v);
            edge = no_index;
            if (!is_singular[v])
                for (const std::uint32_t e : edges_at[v])
                    if (!is_used[e]) edge = e;
        }
        features.lines.push_back(line);
    };
    for (const std::uint32_t v : features.singular)
        for (const std::uint32_t e : edges_at[v])
            if (!is_used[e]) follow(v, e);
    for (const std::uint32_t e : features.edges)
        if (!is_used[e]) follow(mesh.edges[e][0], e);
    return features;
}

inline std::vector<FeatureParticle> plain_feature_particles(const SurfaceMesh& mesh,
                                                            const Features& features, double dp)
{
    std::vector<FeatureParticle> particles;
    NeighbourGrid grid;
    grid.start(dp);
    const auto is_free = [&](const Vec3& p, double radius)
    {
        bool result = true;
        grid.for_each_near(p, radius, [&](std::uint32_t, const Vec3&, double) { result = false; });
        return result;
    };
    const auto add = [&](const FeatureParticle& particle)
    {
        grid.add(particle.position);
        particles.push_back(particle);
    };
    for (const std::uint32_t v : features.singular)
        if (is_free(mesh.vertices[v], 0.5 * dp))
            add({mesh.vertices[v], true, no_index, v, no_index});
    std::vector<std::uint32_t> order(features.lines.size());
    for (std::uint32_t l = 0; l < order.size(); ++l) order[l] = l;
    std::stable_sort(order.begin(), order.end(),
                     [&](std::uint32_t a, std::uint32_t b)
                     { return features.lines[a].length > features.lines[b].length; });
    const auto at = [&](std::uint32_t l, double length)
    {
        const FeatureLine& line = features.lines[l];
        for (std::size_t i = 0;; ++i)
        {
            const std::uint32_t a = line.vertices[i];
            const std::uint32_t b = line.vertices[(i + 1) % line.vertices.size()];
            const Vec3 d = mesh.vertices[b] - mesh.vertices[a];
            const bool is_last = i + (line.is_closed ? 1 : 2) >= line.vertices.size();
            if (length > norm(d) && !is_last)
            {
                length -= norm(d);
                continue;
            }
            const std::array<std::uint32_t, 2> ends{std::min(a, b), std::max(a, b)};
            const auto edge = std::lower_bound(mesh.edges.begin(), mesh.edges.end(), ends);
            return FeatureParticle{mesh.vertices[a] + d * std::min(1.0, length / norm(d)), false, l,
                                   no_index, static_cast<std::uint32_t>(edge - mesh.edges.begin())};
        }
    };
    for (const std::uint32_t l : order)
    {
        const FeatureLine& line = features.lines[l];
        const double n = std::ceil(line.length / dp - 1e-9);
        for (double i = line.is_closed ? 0 : 1; i < n; ++i)
        {
            const FeatureParticle particle = at(l, i * line.length / n);
            if (is_free(particle.position, 0.45 * dp)) add(particle);
        }
    }
    for (const std::uint32_t l : order)
        for (double s = 0; s <= features.lines[l].length; s += 0.02 * dp)
        {
            if (!is_free(at(l, s).position, 0.5 * dp)) continue;
            const FeatureParticle ahead = at(l, std::min(s + 0.15 * dp, features.lines[l].length));
            add(is_free(ahead.position, 0.3 * dp) ? ahead : at(l, s));
        }
    return particles;
}

} // namespace fppg
