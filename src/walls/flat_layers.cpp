#include "walls/flat_layers.h"

#include "meshes/point_grid.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <optional>
#include <utility>
#include <vector>

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
/// From nodes to the edges around them, dp: how far to look.
constexpr double farthest_border_dp = 1.6;
/// Edges a step away that run between two nodes are 1.12 steps from these.
constexpr double nearest_border_steps = 0.96;
constexpr double far_border_steps = 1.13;
constexpr double node_rounding = 1e-9;

/// How far a layer may be off a plane of nodes, steps. Layers are dp apart: where steps are no dp,
/// those behind one on nodes are beside others.
double off_nodes(const FittedBody& layer, const LatticeGrid& grid)
{
    double most = 0;
    for (int axis = 0; axis < 3; ++axis) most = std::max(most, std::abs(grid.stretch[axis] - 1));
    return off_nodes_dp + most * layer.depth / grid.dp;
}

/// The axis across which a facet lies on a plane of nodes.
///
/// room  how far it may be off, steps
std::optional<int> axis_of(const SurfaceMesh& mesh, std::size_t facet, const LatticeGrid& grid,
                           double room)
{
    const Vec3& normal = mesh.normals[facet];
    for (int axis = 0; axis < 3; ++axis)
    {
        if (!(std::abs(normal[axis]) > 1 - tilt_of_flats)) continue;
        for (const std::uint32_t v : mesh.facets[facet])
        {
            const double at = grid.steps_to(mesh.vertices[v])[axis];
            if (std::abs(at - std::round(at)) > room) return std::nullopt;
        }
        return axis;
    }
    return std::nullopt;
}

/// Nodes on flat parts: their indices, and a facet that holds them.
using FlatNodes = std::vector<std::pair<std::array<std::int64_t, 3>, std::uint32_t>>;

void add_nodes(const SurfaceMesh& mesh, std::uint32_t facet, int axis, const LatticeGrid& grid,
               FlatNodes& nodes)
{
    std::array<Vec3, 3> c;
    for (std::size_t k = 0; k < 3; ++k) c[k] = grid.steps_to(mesh.vertices[mesh.facets[facet][k]]);
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
            nodes.emplace_back(node, facet);
        }
}

/// A plane of nodes.
using Plane = std::pair<int, std::int64_t>;

Vec3 place_of(const std::array<std::int64_t, 3>& node, const LatticeGrid& grid)
{
    return grid.place(static_cast<double>(node[0]), static_cast<double>(node[1]),
                      static_cast<double>(node[2]));
}

/// What lies on planes of nodes.
struct Flats
{
    std::vector<char> is_flat;               ///< per facet
    std::map<std::uint32_t, Plane> plane_of; ///< of facets
    FlatNodes nodes;
};

/// Leaves nodes out that are too near to particles which stay.
void keep_off_others(const LatticeGrid& grid, const SurfaceParticles& particles, Flats& flats)
{
    PointGrid features(off_features_dp * grid.dp, particles.positions.size() / 4);
    PointGrid others(off_others_dp * grid.dp, particles.positions.size() / 4);
    for (std::size_t i = 0; i < particles.positions.size(); ++i)
        if (particles.kinds[i] != FitKind::Surface)
            features.add(particles.positions[i]);
        else if (flats.is_flat[particles.facets[i]] == 0)
            others.add(particles.positions[i]);
    std::erase_if(flats.nodes,
                  [&](const auto& node)
                  {
                      const Vec3 place = place_of(node.first, grid);
                      return features.has_nearer(place, off_features_dp * grid.dp) ||
                             others.has_nearer(place, off_others_dp * grid.dp);
                  });
}

/// How the edges around a plane fit to its nodes.
struct PlaneFit
{
    PointGrid nodes;
    std::size_t edges = 0; ///< particles on them
    std::size_t matched = 0;
};

/// Gives planes up too few of whose particles on edges are a step from the outermost nodes: there
/// these would leave gaps along the edges, or crowd.
///
/// room  how far particles on edges may be off a plane of nodes, steps
void keep_matched(const LatticeGrid& grid, double room, double least_matched,
                  const SurfaceParticles& particles, Flats& flats)
{
    const auto [least, most] = std::minmax({grid.stretch.x, grid.stretch.y, grid.stretch.z});
    const double nearest_border = nearest_border_steps * least * grid.dp;
    const double far_border = far_border_steps * most * grid.dp;
    std::map<Plane, PlaneFit> fits;
    for (const auto& [node, facet] : flats.nodes)
        fits.try_emplace(flats.plane_of.at(facet),
                         PlaneFit{PointGrid(farthest_border_dp * grid.dp, 64)})
            .first->second.nodes.add(place_of(node, grid));
    for (std::size_t i = 0; i < particles.positions.size(); ++i)
    {
        if (particles.kinds[i] != FitKind::Edge) continue;
        const Vec3& p = particles.positions[i];
        for (int axis = 0; axis < 3; ++axis)
        {
            const double at = grid.steps_to(p)[axis];
            if (std::abs(at - std::round(at)) > room) continue;
            const auto found = fits.find({axis, std::llround(at)});
            if (found == fits.end()) continue;
            PlaneFit& fit = found->second;
            if (!fit.nodes.has_nearer(p, farthest_border_dp * grid.dp)) continue;
            ++fit.edges;
            if (fit.nodes.has_nearer(p, far_border) && !fit.nodes.has_nearer(p, nearest_border))
                ++fit.matched;
        }
    }
    for (const auto& [facet, plane] : flats.plane_of)
    {
        const auto found = fits.find(plane);
        flats.is_flat[facet] =
            found != fits.end() && static_cast<double>(found->second.matched) >=
                                       least_matched * static_cast<double>(found->second.edges);
    }
    std::erase_if(flats.nodes, [&](const auto& node) { return flats.is_flat[node.second] == 0; });
}

/// The facets of a surface or layer on planes of nodes, with these.
Flats find_flats(const SurfaceMesh& mesh, const LatticeGrid& grid, double room)
{
    Flats flats;
    flats.is_flat.resize(mesh.facets.size(), 0);
    for (std::uint32_t f = 0; f < mesh.facets.size(); ++f)
        if (const std::optional<int> axis = axis_of(mesh, f, grid, room))
        {
            flats.is_flat[f] = 1;
            const Vec3 at = grid.steps_to(mesh.vertices[mesh.facets[f][0]]);
            flats.plane_of[f] = {*axis, std::llround(at[*axis])};
            add_nodes(mesh, f, *axis, grid, flats.nodes);
        }
    // Of the facets that meet at a node the first one holds it.
    std::sort(flats.nodes.begin(), flats.nodes.end());
    flats.nodes.erase(std::unique(flats.nodes.begin(), flats.nodes.end(),
                                  [](const auto& a, const auto& b) { return a.first == b.first; }),
                      flats.nodes.end());
    return flats;
}

} // namespace

std::vector<char> take_nodes_on_flats(const FittedBody& layer, const LatticeGrid& grid,
                                      double least_matched, SurfaceParticles& particles)
{
    const double room = off_nodes(layer, grid);
    Flats flats = find_flats(layer.mesh, grid, room);
    if (!flats.nodes.empty())
    {
        keep_off_others(grid, particles, flats);
        keep_matched(grid, room, least_matched, particles, flats);
    }
    PointGrid taken(off_others_dp * grid.dp, flats.nodes.size());
    for (const auto& [node, facet] : flats.nodes) taken.add(place_of(node, grid));
    SurfaceParticles out;
    const auto add = [&](const Vec3& place, FitKind kind, std::uint32_t facet)
    {
        out.positions.push_back(place);
        out.kinds.push_back(kind);
        out.facets.push_back(facet);
    };
    for (std::size_t i = 0; i < particles.positions.size(); ++i)
        if (particles.kinds[i] != FitKind::Surface || flats.is_flat[particles.facets[i]] == 0 ||
            !taken.has_nearer(particles.positions[i], off_others_dp * grid.dp))
            add(particles.positions[i], particles.kinds[i], particles.facets[i]);
    std::vector<char> is_node(out.positions.size(), 0);
    for (const auto& [node, facet] : flats.nodes)
    {
        Vec3 place = place_of(node, grid);
        const int axis = flats.plane_of.at(facet).first;
        place[axis] = layer.mesh.vertices[layer.mesh.facets[facet][0]][axis];
        add(place, FitKind::Surface, facet);
    }
    is_node.resize(out.positions.size(), 1);
    particles = std::move(out);
    return is_node;
}

} // namespace fppg
