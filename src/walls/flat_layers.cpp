#include "walls/flat_layers.h"

#include "meshes/point_grid.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <utility>
#include <vector>

namespace fppg
{
namespace
{

/// Of the normal of a flat facet across an axis, less one; of one beside such a facet, as vertices
/// of layers near their corners are up to 0.004 dp off; and its distance from nodes, dp.
constexpr double tilt_of_flats = 1e-6;
constexpr double tilt_beside_flats = 1e-4;
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
/// From nodes to edges that do not fit to them, where others do, dp: so far particles are evened
/// out. And how many of a plane's nodes must be left.
constexpr double clear_of_borders_dp = 3;
constexpr double least_left = 0.5;
/// Planes fewer of whose edges fit take no nodes at all: along a sine particles would crowd, and
/// boxes of which one side in two fits had 3 % more than one a dp^2. Of lines in 2D one end does.
constexpr double least_partly_matched = 0.6;
constexpr double least_partly_matched_2d = 0.5;

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
/// tilt  how far its normal may be off
/// room  how far it may be off, steps
std::optional<int> axis_of(const SurfaceMesh& mesh, std::size_t facet, const LatticeGrid& grid,
                           double tilt, double room)
{
    const Vec3& normal = mesh.normals[facet];
    for (int axis = 0; axis < 3; ++axis)
    {
        if ((grid.is_2d && axis == 1) || !(std::abs(normal[axis]) > 1 - tilt)) continue;
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
    const auto nodes_along = [&](int along)
    {
        const auto [low, high] = std::minmax({c[0][along], c[1][along], c[2][along]});
        std::pair<double, double> range{std::ceil(low - node_rounding),
                                        std::floor(high + node_rounding)};
        if (grid.is_2d && along == 1)
            range = {std::max(range.first, 0.0), std::min(range.second, 0.0)};
        return range;
    };
    const auto [first_u, last_u] = nodes_along(u);
    const auto [first_v, last_v] = nodes_along(v);
    for (double pu = first_u; pu <= last_u; ++pu)
        for (double pv = first_v; pv <= last_v; ++pv)
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
    std::size_t edges = 0; ///< particles on them; in 2D corners
    std::size_t matched = 0;
    std::size_t left = 0; ///< nodes that are far enough from edges that do not fit

    bool fits(double least_matched) const
    {
        return static_cast<double>(matched) >= least_matched * static_cast<double>(edges);
    }
};

using PlaneFits = std::map<Plane, PlaneFit>;

/// How planes fit to their edges, whose particles are a step from the outermost nodes.
///
/// room   how far particles on edges may be off a plane of nodes, steps
/// loose  filled: particles on edges that do not fit
PlaneFits fit_planes(const LatticeGrid& grid, double room, const SurfaceParticles& particles,
                     const Flats& flats, PointGrid& loose)
{
    const auto [least, most] = std::minmax({grid.stretch.x, grid.stretch.y, grid.stretch.z});
    const double nearest_border = nearest_border_steps * least * grid.dp;
    const double far_border = far_border_steps * most * grid.dp;
    const FitKind border = grid.is_2d ? FitKind::Corner : FitKind::Edge;
    PlaneFits fits;
    for (const auto& [node, facet] : flats.nodes)
        fits.try_emplace(flats.plane_of.at(facet),
                         PlaneFit{PointGrid(farthest_border_dp * grid.dp, 64)})
            .first->second.nodes.add(place_of(node, grid));
    for (std::size_t i = 0; i < particles.positions.size(); ++i)
    {
        if (particles.kinds[i] != border) continue;
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
            else
                loose.add(p);
        }
    }
    return fits;
}

/// Of planes too few of whose particles on edges are a step from the outermost nodes, the nodes
/// near the edges that do not fit go: there they would leave gaps, or crowd.
void keep_matched(const LatticeGrid& grid, double room, double least_matched,
                  const SurfaceParticles& particles, Flats& flats)
{
    const double clear = clear_of_borders_dp * grid.dp;
    PointGrid loose(clear, 256);
    const double least_partly = grid.is_2d ? least_partly_matched_2d : least_partly_matched;
    PlaneFits fits = fit_planes(grid, room, particles, flats, loose);
    const auto fit_of = [&](std::uint32_t facet) -> PlaneFit&
    { return fits.at(flats.plane_of.at(facet)); };
    std::erase_if(flats.nodes,
                  [&](const auto& node)
                  {
                      PlaneFit& fit = fit_of(node.second);
                      const bool goes = !fit.fits(least_matched) &&
                                        loose.has_nearer(place_of(node.first, grid), clear);
                      fit.left += goes ? 0 : 1;
                      return goes;
                  });
    for (const auto& [facet, plane] : flats.plane_of)
    {
        const auto found = fits.find(plane);
        flats.is_flat[facet] =
            found != fits.end() && found->second.fits(least_partly) &&
            static_cast<double>(found->second.left) >=
                least_left * static_cast<double>(found->second.nodes.points().size());
    }
    std::erase_if(flats.nodes, [&](const auto& node) { return flats.is_flat[node.second] == 0; });
}

/// The planes of nodes that facets lie on: of flat ones, and of those of a layer beside them.
std::map<std::uint32_t, Plane> find_planes(const FittedBody& layer, const LatticeGrid& grid,
                                           double room)
{
    const SurfaceMesh& mesh = layer.mesh;
    std::map<std::uint32_t, Plane> planes;
    std::vector<std::optional<Plane>> of_vertex(mesh.vertices.size());
    const auto plane_of = [&](std::uint32_t facet, double tilt)
    {
        std::optional<Plane> plane;
        if (const std::optional<int> axis = axis_of(mesh, facet, grid, tilt, room))
        {
            const Vec3 at = grid.steps_to(mesh.vertices[mesh.facets[facet][0]]);
            plane = {*axis, std::llround(at[*axis])};
        }
        return plane;
    };
    for (std::uint32_t f = 0; f < mesh.facets.size(); ++f)
        if (const std::optional<Plane> plane = plane_of(f, tilt_of_flats))
        {
            planes[f] = *plane;
            for (const std::uint32_t v : mesh.facets[f]) of_vertex[v] = *plane;
        }
    if (!layer.is_layer()) return planes;
    for (std::uint32_t f = 0; f < mesh.facets.size(); ++f)
    {
        const std::optional<Plane> plane = plane_of(f, tilt_beside_flats);
        if (plane && std::any_of(mesh.facets[f].begin(), mesh.facets[f].end(),
                                 [&](std::uint32_t v) { return of_vertex[v] == plane; }))
            planes.emplace(f, *plane);
    }
    return planes;
}

/// The facets of a surface or layer on planes of nodes, with these.
Flats find_flats(const FittedBody& layer, const LatticeGrid& grid, double room)
{
    Flats flats;
    flats.is_flat.resize(layer.mesh.facets.size(), 0);
    flats.plane_of = find_planes(layer, grid, room);
    for (const auto& [facet, plane] : flats.plane_of)
    {
        flats.is_flat[facet] = 1;
        add_nodes(layer.mesh, facet, plane.first, grid, flats.nodes);
    }
    // Of the facets that meet at a node the first one holds it.
    std::sort(flats.nodes.begin(), flats.nodes.end());
    flats.nodes.erase(std::unique(flats.nodes.begin(), flats.nodes.end(),
                                  [](const auto& a, const auto& b) { return a.first == b.first; }),
                      flats.nodes.end());
    return flats;
}

/// A particle on a line of nodes of a 2D case.
struct OnLine
{
    double along = 0; ///< metres
    std::uint32_t particle = 0;
    bool is_node = false, is_corner = false;
};

/// Spreads the particles of a line between its nodes and corners evenly, as many as are a dp apart.
class LineSpreader
{
public:
    LineSpreader(const Plane& line, double dp, SurfaceParticles& particles)
        : axis_(2 - line.first), dp_(dp), particles_(particles)
    {
    }

    /// on  all of the line, in its order
    void spread(const std::vector<OnLine>& on)
    {
        std::size_t begin = 0;
        for (std::size_t k = 1; k < on.size(); ++k)
        {
            if (!on[k].is_node && !on[k].is_corner) continue;
            spread_between(on[begin], on[k], std::span(on).subspan(begin + 1, k - begin - 1));
            begin = k;
        }
    }
    /// Of particles, which go.
    std::vector<std::uint32_t> surplus;

private:
    void spread_between(const OnLine& a, const OnLine& b, std::span<const OnLine> between)
    {
        const bool is_gap = between.empty() && a.is_node && b.is_node; // something stands there
        if (is_gap || !(a.is_node || b.is_node)) return;
        const double length = b.along - a.along;
        const auto count = static_cast<std::size_t>(std::max(0.0, std::round(length / dp_) - 1));
        for (std::size_t k = 0; k < count; ++k)
        {
            const double at =
                a.along + length * static_cast<double>(k + 1) / static_cast<double>(count + 1);
            if (k < between.size())
                particles_.positions[between[k].particle][axis_] = at;
            else
                add(a.is_node ? a : b, at);
        }
        for (std::size_t k = count; k < between.size(); ++k) surplus.push_back(between[k].particle);
    }

    void add(const OnLine& beside, double at)
    {
        Vec3 place = particles_.positions[beside.particle];
        place[axis_] = at;
        particles_.positions.push_back(place);
        particles_.kinds.push_back(FitKind::Surface);
        particles_.facets.push_back(particles_.facets[beside.particle]);
    }

    int axis_;
    double dp_;
    SurfaceParticles& particles_;
};

/// In 2D, where walls are not relaxed: spreads particles between nodes and the corners that do not
/// fit to them.
///
/// is_node  of particles; with those that are put in
void even_out_lines(const LatticeGrid& grid, double room, const Flats& flats,
                    SurfaceParticles& particles, std::vector<char>& is_node)
{
    std::map<Plane, std::vector<OnLine>> lines;
    for (const auto& [node, facet] : flats.nodes) lines[flats.plane_of.at(facet)];
    for (std::uint32_t i = 0; i < particles.positions.size(); ++i)
    {
        const Vec3 at = grid.steps_to(particles.positions[i]);
        for (const int axis : {0, 2})
        {
            const auto line = lines.find({axis, std::llround(at[axis])});
            const bool is_corner = particles.kinds[i] == FitKind::Corner;
            if (line == lines.end() || std::abs(at[axis] - std::round(at[axis])) > room) continue;
            const auto of_facet = flats.plane_of.find(particles.facets[i]);
            if (!is_corner && (of_facet == flats.plane_of.end() || of_facet->second != line->first))
                continue;
            line->second.push_back(
                {particles.positions[i][2 - axis], i, is_node[i] != 0, is_corner});
        }
    }
    std::vector<char> goes;
    for (auto& [line, on] : lines)
    {
        std::sort(on.begin(), on.end(),
                  [](const OnLine& a, const OnLine& b) { return a.along < b.along; });
        LineSpreader spreader(line, grid.dp, particles);
        spreader.spread(on);
        goes.resize(particles.positions.size(), 0);
        for (const std::uint32_t i : spreader.surplus) goes[i] = 1;
    }
    is_node.resize(particles.positions.size(), 0);
    std::size_t kept = 0;
    for (std::size_t i = 0; i < goes.size(); ++i)
    {
        if (goes[i] != 0) continue;
        particles.positions[kept] = particles.positions[i];
        particles.kinds[kept] = particles.kinds[i];
        particles.facets[kept] = particles.facets[i];
        is_node[kept++] = is_node[i];
    }
    if (goes.empty()) return;
    particles.positions.resize(kept);
    particles.kinds.resize(kept);
    particles.facets.resize(kept);
    is_node.resize(kept);
}

/// Whether two particles lie on parallel lines of nodes: such are rows one behind the other.
bool are_in_rows(const Flats& flats, std::uint32_t facet, std::uint32_t other)
{
    const auto line = flats.plane_of.find(facet);
    const auto other_line = flats.plane_of.find(other);
    return line != flats.plane_of.end() && other_line != flats.plane_of.end() &&
           line->second.first == other_line->second.first &&
           line->second.second != other_line->second.second;
}

/// Whether a place between two neighbours among particles before is far from all of those now, in
/// 2D: where lines bend, corners are left out or layers come together, nodes do not always reach to
/// the next particle, and nothing fills such a gap. Through one of 1.4 dp fluid goes. Between rows
/// of layers there is none, however they stand to one another.
bool leaves_gaps(const Flats& flats, const SurfaceParticles& before, const std::vector<Vec3>& now,
                 double dp)
{
    constexpr double farthest_neighbour = 1.2; // dp
    constexpr double farthest = 0.66;          // dp
    PointGrid old(farthest_neighbour * dp, before.positions.size());
    PointGrid present(farthest * dp, now.size());
    for (const Vec3& p : before.positions) old.add(p);
    for (const Vec3& p : now) present.add(p);
    bool has_gap = false;
    for (std::size_t i = 0; i < before.positions.size(); ++i)
    {
        const Vec3& p = before.positions[i];
        old.for_each_near(p, farthest_neighbour * dp,
                          [&](std::uint32_t other, double)
                          {
                              if (are_in_rows(flats, before.facets[i], before.facets[other]))
                                  return;
                              const Vec3 way = before.positions[other] - p;
                              for (const double t : {0.0, 0.1, 0.2, 0.3, 0.4, 0.5})
                                  has_gap =
                                      has_gap || !present.has_nearer(p + t * way, farthest * dp);
                          });
    }
    return has_gap;
}

} // namespace

std::vector<char> take_nodes_on_flats(const FittedBody& layer, const LatticeGrid& grid,
                                      double least_matched, SurfaceParticles& particles)
{
    const double room = off_nodes(layer, grid);
    Flats flats = find_flats(layer, grid, room);
    if (flats.nodes.empty() && !grid.is_2d) return std::vector<char>(particles.positions.size(), 0);
    if (!flats.nodes.empty())
    {
        keep_off_others(grid, particles, flats);
        keep_matched(grid, room, least_matched, particles, flats);
    }
    PointGrid taken(off_others_dp * grid.dp, flats.nodes.size());
    for (const auto& [node, facet] : flats.nodes) taken.add(place_of(node, grid));
    std::vector<char> stays(particles.positions.size());
    for (std::size_t i = 0; i < stays.size(); ++i)
        stays[i] = particles.kinds[i] != FitKind::Surface ||
                   flats.is_flat[particles.facets[i]] == 0 ||
                   !taken.has_nearer(particles.positions[i], off_others_dp * grid.dp);
    const auto kept = static_cast<std::size_t>(std::count(stays.begin(), stays.end(), 1));
    SurfaceParticles out;
    out.positions.reserve(kept + flats.nodes.size());
    out.kinds.reserve(kept + flats.nodes.size());
    out.facets.reserve(kept + flats.nodes.size());
    const auto add = [&](const Vec3& place, FitKind kind, std::uint32_t facet)
    {
        out.positions.push_back(place);
        out.kinds.push_back(kind);
        out.facets.push_back(facet);
    };
    for (std::size_t i = 0; i < stays.size(); ++i)
        if (stays[i] != 0) add(particles.positions[i], particles.kinds[i], particles.facets[i]);
    std::vector<char> is_node(kept, 0);
    for (const auto& [node, facet] : flats.nodes)
    {
        Vec3 place = place_of(node, grid);
        const int axis = flats.plane_of.at(facet).first;
        place[axis] = layer.mesh.vertices[layer.mesh.facets[facet][0]][axis];
        add(place, FitKind::Surface, facet);
    }
    is_node.resize(out.positions.size(), 1);
    if (grid.is_2d)
    {
        even_out_lines(grid, room, flats, out, is_node);
        if (leaves_gaps(flats, particles, out.positions, grid.dp))
            return std::vector<char>(particles.positions.size(), 0);
    }
    particles = std::move(out);
    return is_node;
}

} // namespace fppg
