#include "walls/flat_layers.h"

#include "meshes/point_grid.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <optional>

namespace fppg
{
namespace
{

/// Of the normal of a flat facet across an axis, less one, and its distance from nodes, dp.
constexpr double tilt_of_flats = 1e-6;
constexpr double off_nodes_dp = 0.01;
/// From nodes to particles on edges and corners, and to those of other parts, dp.
constexpr double off_features_dp = 0.7;
constexpr double off_others_dp = 0.75;
constexpr double node_rounding = 1e-9;

/// The axis across which a facet lies on a plane of nodes.
std::optional<int> axis_of(const SurfaceMesh& mesh, std::size_t facet, const LatticeGrid& grid)
{
    const Vec3& normal = mesh.normals[facet];
    for (int axis = 0; axis < 3; ++axis)
    {
        if (!(std::abs(normal[axis]) > 1 - tilt_of_flats)) continue;
        for (const std::uint32_t v : mesh.facets[facet])
        {
            const double at = (mesh.vertices[v][axis] - grid.origin[axis]) / grid.dp;
            if (std::abs(at - std::round(at)) > off_nodes_dp) return std::nullopt;
        }
        return axis;
    }
    return std::nullopt;
}

/// A node on a flat part: its indices, and a facet that holds it.
using FlatNodes = std::map<std::array<std::int64_t, 3>, std::uint32_t>;

void add_nodes(const SurfaceMesh& mesh, std::uint32_t facet, int axis, const LatticeGrid& grid,
               FlatNodes& nodes)
{
    std::array<Vec3, 3> c;
    for (std::size_t k = 0; k < 3; ++k)
        c[k] = (mesh.vertices[mesh.facets[facet][k]] - grid.origin) / grid.dp;
    const int u = (axis + 1) % 3;
    const int v = (axis + 2) % 3;
    const auto turn = [&](const Vec3& a, const Vec3& b, double pu, double pv)
    { return (b[u] - a[u]) * (pv - a[v]) - (b[v] - a[v]) * (pu - a[u]); };
    const double sense = turn(c[0], c[1], c[2][u], c[2][v]) < 0 ? -1 : 1;
    const auto [low_u, high_u] = std::minmax({c[0][u], c[1][u], c[2][u]});
    const auto [low_v, high_v] = std::minmax({c[0][v], c[1][v], c[2][v]});
    for (double pu = std::ceil(low_u - node_rounding); pu <= high_u + node_rounding; ++pu)
        for (double pv = std::ceil(low_v - node_rounding); pv <= high_v + node_rounding; ++pv)
        {
            bool is_in = true;
            for (std::size_t k = 0; k < 3; ++k)
                is_in = is_in && sense * turn(c[k], c[(k + 1) % 3], pu, pv) >= -node_rounding;
            if (!is_in) continue;
            std::array<std::int64_t, 3> node{};
            node[static_cast<std::size_t>(axis)] = std::llround(c[0][axis]);
            node[static_cast<std::size_t>(u)] = std::llround(pu);
            node[static_cast<std::size_t>(v)] = std::llround(pv);
            nodes.try_emplace(node, facet);
        }
}

} // namespace

std::vector<char> take_nodes_on_flats(const FittedBody& layer, const LatticeGrid& grid,
                                      SurfaceParticles& particles)
{
    const SurfaceMesh& mesh = layer.mesh;
    std::vector<char> is_flat(mesh.facets.size(), 0);
    FlatNodes nodes;
    for (std::uint32_t f = 0; f < mesh.facets.size(); ++f)
        if (const std::optional<int> axis = axis_of(mesh, f, grid))
        {
            is_flat[f] = 1;
            add_nodes(mesh, f, *axis, grid, nodes);
        }
    std::vector<char> is_node(particles.positions.size(), 0);
    if (nodes.empty()) return is_node;
    PointGrid features(off_features_dp * grid.dp, particles.positions.size() / 4);
    PointGrid others(off_others_dp * grid.dp, particles.positions.size() / 4);
    for (std::size_t i = 0; i < particles.positions.size(); ++i)
        if (particles.kinds[i] != FitKind::Surface)
            features.add(particles.positions[i]);
        else if (is_flat[particles.facets[i]] == 0)
            others.add(particles.positions[i]);
    PointGrid taken(off_others_dp * grid.dp, nodes.size());
    SurfaceParticles found;
    for (const auto& [node, facet] : nodes)
    {
        const Vec3 place =
            grid.origin + grid.dp * Vec3{static_cast<double>(node[0]), static_cast<double>(node[1]),
                                         static_cast<double>(node[2])};
        if (features.has_nearer(place, off_features_dp * grid.dp) ||
            others.has_nearer(place, off_others_dp * grid.dp))
            continue;
        taken.add(place);
        found.positions.push_back(place);
        found.kinds.push_back(FitKind::Surface);
        found.facets.push_back(facet);
    }
    std::size_t kept = 0;
    for (std::size_t i = 0; i < particles.positions.size(); ++i)
    {
        if (particles.kinds[i] == FitKind::Surface && is_flat[particles.facets[i]] != 0 &&
            taken.has_nearer(particles.positions[i], off_others_dp * grid.dp))
            continue;
        particles.positions[kept] = particles.positions[i];
        particles.kinds[kept] = particles.kinds[i];
        particles.facets[kept++] = particles.facets[i];
    }
    const auto replace = [&](auto& array, const auto& more)
    {
        array.resize(kept);
        array.insert(array.end(), more.begin(), more.end());
    };
    replace(particles.positions, found.positions);
    replace(particles.kinds, found.kinds);
    replace(particles.facets, found.facets);
    is_node.assign(kept, 0);
    is_node.resize(particles.positions.size(), 1);
    return is_node;
}

} // namespace fppg
