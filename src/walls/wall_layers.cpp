#include "walls/wall_layers.h"

#include "fppg/exclusion_band.h"

#include "core/parallel.h"
#include "fit/near_nodes.h"
#include "meshes/point_grid.h"
#include "nodes/cell_nodes.h"
#include "offset/offset_surface.h"
#include "walls/fit_shape.h"
#include "walls/layer_builder.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <tuple>
#include <utility>

namespace fppg
{
namespace
{

/// A node in a thin part stays where no particle of a layer is nearer than this, and it is so deep,
/// dp.
constexpr double gap_dp = 0.85;
constexpr double gap_depth_dp = 0.45;
/// In hollow bodies none is a neighbour of a node before the surface, from where a fill would take
/// it.
constexpr double gap_depth_of_hollow_dp = 1;

/// Adds spans to each slab.
void unite_with(std::vector<Spans>& slabs, const std::vector<Spans>& more, int threads)
{
    parallel_for(slabs.size(), threads,
                 [&](std::size_t x) { slabs[x] = unite(slabs[x], more[x]); });
}

/// The nodes in parts too thin for all layers that have no particle near: between layers of both
/// sides that are the innermost there.
Spans find_gaps(const Spans& nodes, std::size_t x, const PointGrid& taken, const LatticeGrid& grid,
                const FittedDraw& out)
{
    Spans found;
    if (out.layers.empty()) return found;
    const WallDepth& wall = *out.layers.front().wall;
    double deepest = 0;
    for (const FittedBody& layer : out.layers) deepest = std::max(deepest, layer.depth);
    const double enough = deepest + grid.dp;
    const double least_depth = out.body.is_solid ? gap_depth_dp : gap_depth_of_hollow_dp;
    for (const Span& span : nodes)
        for (std::uint32_t z = span.z_begin; z < span.z_end; ++z)
        {
            const Vec3 p = grid.place(
                {static_cast<double>(x), static_cast<double>(span.y), static_cast<double>(z)});
            if (taken.has_nearer(p, gap_dp * grid.dp)) continue;
            const DepthPlace here = wall.at(p);
            if (here.depth < least_depth * grid.dp) continue;
            // Thick enough for all layers and nodes under them: they are the ones to fill it.
            if (wall.at(here.foot + enough * here.direction).depth > enough * (1 - 1e-6)) continue;
            append_node(found, span.y, z);
        }
    return found;
}

/// Without the nodes that have a particle of a layer that two sides share so near that they would
/// stand between it and the layer before.
Spans without_crowded(const Spans& nodes, std::size_t x, const PointGrid& shared,
                      const LatticeGrid& grid)
{
    Spans found;
    for (const Span& span : nodes)
        for (std::uint32_t z = span.z_begin; z < span.z_end; ++z)
            if (!shared.has_nearer(grid.place({static_cast<double>(x), static_cast<double>(span.y),
                                               static_cast<double>(z)}),
                                   gap_dp * grid.dp))
                append_node(found, span.y, z);
    return found;
}

/// In 2D, of the nodes inside those half a step and more under the innermost layer, but for the
/// shallowest, up to a step, that the area of the body has no room for.
std::vector<Spans> deep_nodes_2d(const std::vector<Spans>& inside, const FittedBody& innermost,
                                 const LatticeGrid& grid, const FittedDraw& out,
                                 std::uint64_t& nodes)
{
    struct DeepNode
    {
        double depth;
        std::uint32_t x;
        Span span;
    };
    std::vector<DeepNode> found;
    for (std::uint32_t x = 0; x < inside.size(); ++x)
        for (const Span& span : inside[x])
            for (std::uint32_t z = span.z_begin; z < span.z_end; ++z)
            {
                const Vec3 p = grid.place({static_cast<double>(x), 0, static_cast<double>(z)});
                const double depth = innermost.wall->at(p).depth;
                if (depth >= innermost.depth + (0.5 - 1e-9) * grid.dp)
                    found.push_back({depth, x, {span.y, z, z + 1}});
            }
    std::sort(found.begin(), found.end(),
              [](const DeepNode& a, const DeepNode& b) {
                  return std::tuple(b.depth, a.x, a.span.z_begin) <
                         std::tuple(a.depth, b.x, b.span.z_begin);
              });
    const double wanted =
        out.body.measures.volume / std::pow(grid.dp, 3) - static_cast<double>(out.particles.size());
    while (!found.empty() && static_cast<double>(found.size()) > wanted + 0.5 &&
           found.back().depth < innermost.depth + grid.dp)
        found.pop_back();
    nodes = found.size();
    std::vector<Spans> deep(grid.n[0]);
    for (const DeepNode& node : found) deep[node.x].push_back(node.span);
    for (Spans& spans : deep) sort_and_join(spans);
    return deep;
}

/// Of the nodes inside, those under the innermost layer stay, and those in gaps between layers.
void take_nodes_between(const LatticeGrid& grid, int threads, FittedDraw& out)
{
    const bool is_hollow = !out.body.is_solid;
    std::vector<Spans>& inside = is_hollow ? out.hollow : out.volume;
    std::vector<Spans> deep(grid.n[0]);
    std::uint64_t nodes = 0;
    std::size_t last = out.layers.size();
    while (last > 0 && out.layers[last - 1].mesh.facets.empty()) --last;
    if (last > 0 && grid.is_2d && !inside.empty())
        deep = deep_nodes_2d(inside, out.layers[last - 1], grid, out, nodes);
    else if (last > 0)
    {
        const FittedBody& innermost = out.layers[last - 1];
        ExclusionBandOptions options;
        options.is_solid = true;
        for (const std::uint32_t b : out.particles.bodies)
            options.wall_particles += b == last ? 1 : 0;
        ExclusionBand band =
            exclusion_band(innermost.mesh, innermost.report, grid, options, threads);
        nodes = band.nodes;
        deep = by_slab(std::move(band.volume), grid);
    }
    if (inside.empty()) return;
    const PointGrid taken = grid_of(out.particles.positions, gap_dp * grid.dp);
    std::vector<Vec3> of_shared;
    for (std::size_t i = 0; i < out.particles.size(); ++i)
        if (out.particles.bodies[i] > 0 &&
            out.layers[out.particles.bodies[i] - 1].mesh.facets.empty())
            of_shared.push_back(out.particles.positions[i]);
    const PointGrid shared = grid_of(of_shared, gap_dp * grid.dp);
    std::vector<std::uint64_t> added(grid.n[0], 0);
    std::vector<std::uint64_t> dropped(grid.n[0], 0);
    const auto count = [](const Spans& spans)
    {
        std::uint64_t n = 0;
        for (const Span& s : spans) n += s.z_end - s.z_begin;
        return n;
    };
    parallel_for(grid.n[0], threads,
                 [&](std::size_t x)
                 {
                     deep[x] = intersect(deep[x], inside[x]);
                     dropped[x] = count(deep[x]);
                     deep[x] = without_crowded(deep[x], x, shared, grid);
                     dropped[x] -= count(deep[x]);
                     const Spans gaps =
                         find_gaps(subtract(inside[x], deep[x]), x, taken, grid, out);
                     added[x] = count(gaps);
                     deep[x] = unite(deep[x], gaps);
                     out.zone[x] = unite(out.zone[x], subtract(inside[x], deep[x]));
                 });
    inside = std::move(deep);
    for (std::uint32_t x = 0; x < grid.n[0]; ++x) nodes = nodes + added[x] - dropped[x];
    out.body.measures.node_volume = static_cast<double>(nodes) * grid.dp * grid.dp * grid.dp;
}

/// Covers the nodes of layers that lie in no body: those half a step around each, and what is
/// farther from it and in the wall, as where a layer goes round the edge of a wall that sticks out
/// into the fluid.
void cover_layers(const LatticeGrid& grid, int threads, FittedDraw& out)
{
    for (const FittedBody& layer : out.layers)
    {
        if (layer.mesh.facets.empty()) continue;
        unite_with(out.zone,
                   by_slab(exclusion_band(layer.mesh, layer.report, grid, {}, threads).zone, grid),
                   threads);
        const std::vector<std::vector<NearNode>> near =
            find_near_nodes(soup_of(layer.mesh), grid, threads);
        parallel_for(near.size(), threads,
                     [&](std::size_t x)
                     {
                         Spans inside;
                         for (const NearNode& node : near[x])
                         {
                             if (node.distance <= distance_units / 2) continue;
                             const DepthPlace at =
                                 layer.wall->at(grid.place(static_cast<double>(x), node.y, node.z));
                             if (at.depth > 0 && at.depth <= layer.depth && !at.is_beyond_rim)
                                 append_node(inside, node.y, node.z);
                         }
                         out.zone[x] = unite(out.zone[x], inside);
                     });
    }
}

} // namespace

void measure_layers(const LatticeGrid& grid, FittedDraw& out)
{
    const double dp3 = grid.dp * grid.dp * grid.dp;
    std::vector<double> counts(out.layers.size() + 1, 0);
    for (const std::uint32_t b : out.particles.bodies) ++counts[b];
    std::vector<double> dropped(out.layers.size() + 1, 0);
    for (const std::uint32_t b : out.second_sheet.bodies) ++dropped[b];
    FitMeasures& of_body = out.body.measures;
    const bool is_closed = of_body.volume > 0;
    for (std::size_t k = 0; k < out.layers.size(); ++k)
    {
        FitMeasures& measures = out.layers[k].measures;
        const double all = counts[k + 1] + dropped[k + 1];
        double area = 0;
        for (const double a : out.layers[k].mesh.areas) area += a;
        // In 2D the strip is two halves of a cell wide.
        if (grid.is_2d) area *= 1 / offset_cell_dp;
        // Those of a closed body end only where others take over.
        if (!is_closed) area += 0.5 * grid.dp * open_rims(out.layers[k].mesh, grid);
        if (out.layers[k].mesh.facets.empty()) area = counts[k + 1] * grid.dp * grid.dp;
        measures.area = all > 0 ? area * counts[k + 1] / all : 0;
        measures.second_sheet = area - measures.area;
        measures.wall_particles = counts[k + 1];
        of_body.wall_particles += counts[k + 1];
        of_body.layer_particles += counts[k + 1];
        of_body.wall_volume += counts[k + 1] * dp3;
    }
    out.body.settle_share(grid.dp);
}

void add_layers(const FitSettings& settings, const LatticeGrid& grid, int threads, FittedDraw& out)
{
    LayerBuilder builder(settings, grid, threads, out);
    LayerPlan plan;
    plan.depths_dp = settings.depths_dp;
    const bool has_volume = out.body.measures.volume > 0;
    // A closed surface that its draw does not fill can be a tank with fluid in it.
    const LayerSide side = out.body.is_solid && has_volume
                               ? LayerSide::Behind
                               : settings.side.value_or(builder.side_without_fluid());
    const bool is_closed = has_volume && side == LayerSide::Behind;
    out.body.has_layers_inside = is_closed && !out.body.is_solid;
    // Middles are looked for behind facets.
    if (side == LayerSide::Behind && plan.depths_dp[0] > 0)
        plan.middle_dp = plan.depths_dp[0] + 0.5 * merge_dp;
    // Under all layers, nodes fill what is left. Layers that begin on the surface stand for half a
    // dp before it on either side.
    const int beyond = plan.depths_dp[0] > 0 ? 0 : 1;
    if (is_closed)
        for (std::size_t k = 0; k + 1 < plan.depths_dp.size(); ++k)
            plan.gaps.push_back({plan.depths_dp[k] + 0.5 * least_gap_dp,
                                 plan.depths_dp[k + 1] + 0.5 * merge_dp,
                                 2 * static_cast<int>(k + 1) - beyond});
    if (side != LayerSide::Front) builder.build(WallSide::Behind, is_closed, plan);
    if (side != LayerSide::Behind) builder.build(WallSide::Front, is_closed, plan);
    if (is_closed)
        take_nodes_between(grid, threads, out);
    else
        cover_layers(grid, threads, out);
    measure_layers(grid, out);
}

} // namespace fppg
