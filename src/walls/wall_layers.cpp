#include "walls/wall_layers.h"

#include "fppg/exclusion_band.h"
#include "fppg/section.h"

#include "core/parallel.h"
#include "fit/wall_section.h"
#include "meshes/connect_mesh.h"
#include "meshes/crowded_points.h"
#include "meshes/point_grid.h"
#include "nodes/cell_nodes.h"
#include "offset/layer_place.h"
#include "offset/offset_surface.h"
#include "walls/fit_shape.h"
#include "walls/merged_sheet.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <memory>
#include <tuple>
#include <utility>

namespace fppg
{
namespace
{

/// Side of the cells that offset surfaces are cut from, dp.
constexpr double offset_cell_dp = 0.5;
/// No edge turns by more: all depths are distances.
constexpr double no_edge_deg = 180;
/// Layers of two sides that would be nearer than this merge, dp.
constexpr double merge_dp = 0.6;
/// Sides whose normals turn by more than 120 degrees face away from each other.
constexpr double opposing = -0.5;
/// No particle of a layer is so near to the middle of a thin part, which has its own, dp.
constexpr double off_middle_dp = 0.35;
/// A node in a thin part stays where no particle of a layer is nearer than this, and it is so deep,
/// dp.
constexpr double gap_dp = 0.85;
constexpr double gap_depth_dp = 0.45;

/// The lines in which a surface meets the plane of a 2D case, drawn out along y, so that distances
/// near the plane are those in it.
SurfaceMesh drawn_out(const SurfaceMesh& mesh, double plane_y, double half_width, int threads,
                      MeshReport& report)
{
    const WallSection section = wall_section(mesh, plane_y);
    SurfaceMesh out;
    std::map<std::tuple<double, double, double>, std::uint32_t> known;
    const auto vertex = [&](Vec3 p, double y)
    {
        p.y = y;
        const auto [at, is_new] =
            known.try_emplace({p.x, p.y, p.z}, static_cast<std::uint32_t>(out.vertices.size()));
        if (is_new) out.vertices.push_back(p);
        return at->second;
    };
    for (std::size_t i = 0; i < section.soup.size(); ++i)
    {
        Vec3 p = section.soup.vertices[3 * i];
        Vec3 q = section.soup.vertices[3 * i + 1];
        if (p == q) continue;
        // Seen from the side of the normal, p q and y turn counter-clockwise.
        if (dot(cross(q - p, Vec3{0, 1, 0}), section.normals[i]) < 0) std::swap(p, q);
        const std::array<std::uint32_t, 4> quad{
            vertex(p, plane_y - half_width), vertex(q, plane_y - half_width),
            vertex(q, plane_y + half_width), vertex(p, plane_y + half_width)};
        out.facets.push_back({quad[0], quad[1], quad[2]});
        out.facets.push_back({quad[0], quad[2], quad[3]});
    }
    connect_mesh(out, threads, report);
    return out;
}

/// Builds the layers of one draw on one side of its surface.
class LayerBuilder
{
public:
    LayerBuilder(const FitSettings& settings, const LatticeGrid& grid, int threads, FittedDraw& out)
        : settings_(settings), grid_(grid), threads_(threads), out_(out)
    {
    }

    /// Of a sheet: where the fluid nearest to it is not; behind, where there is no fluid.
    LayerSide side_without_fluid() const
    {
        if (settings_.fluid_places.empty()) return LayerSide::Behind;
        const auto wall = wall_of(WallSide::Behind, false, no_edge_deg);
        if (wall == nullptr) return LayerSide::Behind;
        double nearest = std::numeric_limits<double>::infinity();
        LayerSide side = LayerSide::Behind;
        for (const Vec3& p : settings_.fluid_places)
        {
            const double depth = wall->at(p).depth;
            if (std::fabs(depth) >= nearest) continue;
            nearest = std::fabs(depth);
            side = depth > 0 ? LayerSide::Front : LayerSide::Behind;
        }
        return side;
    }

    void build(WallSide side, bool is_closed)
    {
        std::shared_ptr<const WallDepth> wall =
            wall_of(side, is_closed, settings_.feature_angle_deg);
        std::shared_ptr<const WallDepth> rounded; // made where a mitre fails
        if (wall == nullptr) return;
        const bool may_merge = is_closed && settings_.depths_dp[0] > 0;
        if (may_merge) find_thin_parts(*wall);
        const std::string of_side = side == WallSide::Front ? " before the surface" : std::string();
        for (std::size_t k = 0; k < settings_.depths_dp.size(); ++k)
        {
            const double depth = settings_.depths_dp[k] * grid_.dp;
            if (!(depth > 0)) continue;
            OffsetOptions options;
            options.depth = depth;
            options.dp = grid_.dp;
            options.cell = offset_cell_dp * grid_.dp;
            options.feature_angle_deg = settings_.feature_angle_deg;
            if (grid_.is_2d) options.plane_y = grid_.origin.y;
            OffsetSurface surface = offset_surface(*wall, options, threads_);
            if (surface.mesh.facets.empty()) break;
            std::shared_ptr<const WallDepth> of_layer = wall;
            // Where faces beyond come nearer than the tip of a mitre its depth jumps, and the
            // surface tears; the plain distance has no jumps.
            if (is_closed && !grid_.is_2d && surface.report.open_edges > 0)
            {
                if (rounded == nullptr) rounded = wall_of(side, is_closed, no_edge_deg);
                of_layer = rounded;
                surface = offset_surface(*of_layer, options, threads_);
                if (surface.mesh.facets.empty()) break;
            }
            FittedBody body;
            body.name = fmt::format("layer {}{}", k + 1, of_side);
            body.is_solid = out_.body.is_solid;
            body.owner = 0;
            body.layer = static_cast<int>(k);
            body.depth = depth;
            body.wall = of_layer;
            body.features = offset_features(surface, feature_options(settings_, grid_));
            body.mesh = std::move(surface.mesh);
            body.report = std::move(surface.report);
            name_owners(*body.wall, body);
            add_particles(std::move(body));
        }
        if (!middle_.empty()) merge_sides(std::move(wall));
    }

private:
    std::shared_ptr<const WallDepth> wall_of(WallSide side, bool is_closed,
                                             double sharp_angle_deg) const
    {
        const FittedBody& body = out_.body;
        if (!grid_.is_2d)
        {
            auto wall = std::make_shared<WallDepth>(body.mesh, body.report, is_closed, side,
                                                    sharp_angle_deg, threads_);
            wall->take_round_surface(body.mesh, body.round, false);
            return wall;
        }
        MeshReport report;
        const double half_width = (settings_.depths_dp.back() + 4) * grid_.dp;
        SurfaceMesh mesh = drawn_out(body.mesh, grid_.origin.y, half_width, threads_, report);
        if (mesh.facets.empty()) return nullptr;
        auto wall =
            std::make_shared<WallDepth>(mesh, report, false, side, sharp_angle_deg, threads_);
        wall->take_round_surface(body.mesh, body.round, true);
        return wall;
    }

    /// Of a combination: each facet belongs to the part that is nearest to it.
    void name_owners(const WallDepth& wall, FittedBody& body) const
    {
        if (out_.body.facet_mk.empty() || grid_.is_2d) return;
        body.facet_mk.resize(body.mesh.facets.size());
        parallel_for(
            body.mesh.facets.size(), threads_,
            [&](std::size_t f)
            {
                Vec3 middle;
                for (const std::uint32_t v : body.mesh.facets[f])
                    middle = middle + body.mesh.vertices[v] / 3;
                body.facet_mk[f] = out_.body.facet_mk[wall.at(middle).facet];
            },
            256);
    }

    /// Whether the other side of a thin part is so near that its layer would crowd this one.
    bool meets_other_side(const FittedBody& body, const Vec3& p) const
    {
        const WallDepth& wall = *body.wall;
        const DepthPlace here = wall.at(p);
        const double reach = body.depth + 0.5 * merge_dp * grid_.dp;
        const DepthPlace there = wall.at(here.foot + reach * here.direction);
        return there.depth < reach * (1 - 1e-9) && dot(here.direction, there.direction) < opposing;
    }

    MergedSheetOptions sheet_options() const
    {
        MergedSheetOptions options;
        options.dp = grid_.dp;
        options.least_depth_dp = settings_.depths_dp[0] + 0.5 * merge_dp;
        if (grid_.is_2d) options.plane_y = grid_.origin.y;
        return options;
    }

    /// Where a part is too thin for a layer of each side.
    void find_thin_parts(const WallDepth& wall)
    {
        sharp_ = find_features(wall.mesh(), feature_options(settings_, grid_));
        middle_ = find_middle(wall, sharp_, sheet_options(), threads_);
        near_middle_ = std::make_unique<PointGrid>(off_middle_dp * grid_.dp, middle_.size());
        for (const MiddlePoint& p : middle_) near_middle_->add(p.position);
    }

    /// A layer in the middle of thin parts serves both sides.
    void merge_sides(std::shared_ptr<const WallDepth> wall)
    {
        SurfaceParticles sheet = merged_sheet(*wall, sharp_, middle_, out_.particles.positions,
                                              sheet_options(), threads_);
        FittedBody body;
        body.name = "shared layer";
        body.is_solid = out_.body.is_solid;
        body.owner = 0;
        body.wall = std::move(wall);
        if (!grid_.is_2d) body.facet_mk = out_.body.facet_mk;
        const auto index = static_cast<std::uint32_t>(out_.layers.size() + 1);
        for (std::size_t i = 0; i < sheet.positions.size(); ++i)
        {
            body.depth = std::max(body.depth, body.wall->at(sheet.positions[i]).depth);
            out_.particles.positions.push_back(sheet.positions[i]);
            out_.particles.kinds.push_back(FitKind::Surface);
            out_.particles.bodies.push_back(index);
            out_.particles.facets.push_back(sheet.facets[i]);
            out_.particles.mk.push_back(0);
            out_.particles.held.push_back(1);
        }
        out_.layers.push_back(std::move(body));
    }

    /// What is nearer than least_pair_dp to layers before, to corners or edges goes; of the ones
    /// that are left out for another side (is_out) what is near those that stay.
    void drop_crowded(const std::vector<char>& is_out, SurfaceParticles& particles,
                      std::vector<char>& goes)
    {
        std::vector<Vec3> points = particles.positions;
        std::vector<std::uint32_t> rank;
        for (std::size_t i = 0; i < points.size(); ++i)
            rank.push_back((is_out[i] != 0 ? 5 : 1) +
                           static_cast<std::uint32_t>(particles.kinds[i]));
        const std::size_t own = points.size();
        const std::vector<Vec3>& before = out_.particles.positions;
        points.insert(points.end(), before.begin(), before.end());
        rank.resize(points.size(), 0);
        const auto may_stay = [&](std::size_t i, std::size_t j)
        {
            const auto is_of_other_side = [&](std::size_t k) { return k < own && is_out[k] != 0; };
            return (i >= own && (j >= own || is_of_other_side(j))) ||
                   (j >= own && is_of_other_side(i));
        };
        goes = find_crowded(points, rank, least_pair_dp * grid_.dp, may_stay, threads_);
        goes.resize(own);
        for (std::size_t i = 0; i < own; ++i)
            if (goes[i] != 0 && is_out[i] == 0)
                ++out_.body.left_out[static_cast<std::size_t>(particles.kinds[i])];
    }

    void add_particles(FittedBody&& layer)
    {
        const auto index = static_cast<std::uint32_t>(out_.layers.size() + 1);
        SurfaceParticles particles = grid_.is_2d ? section_of(layer, settings_, grid_)
                                                 : surface_of(layer, settings_, grid_, threads_);
        for (std::size_t kind = 0; kind < layer.left_out.size(); ++kind)
            out_.body.left_out[kind] += std::exchange(layer.left_out[kind], 0);
        const LayerPlaces places(layer, grid_.dp);
        std::vector<char> is_out(particles.positions.size());
        parallel_for(
            particles.positions.size(), threads_,
            [&](std::size_t i)
            {
                Vec3& p = particles.positions[i];
                p = places.place(p, particles.kinds[i], particles.facets[i]);
                if (grid_.is_2d) p.y = grid_.origin.y;
                is_out[i] = meets_other_side(layer, p) ||
                            (near_middle_ && near_middle_->has_nearer(p, off_middle_dp * grid_.dp));
            },
            256);
        std::vector<char> goes;
        drop_crowded(is_out, particles, goes);
        for (std::size_t i = 0; i < is_out.size(); ++i)
        {
            if (goes[i] != 0) continue;
            WallParticles& to = is_out[i] != 0 ? out_.second_sheet : out_.particles;
            to.positions.push_back(particles.positions[i]);
            to.kinds.push_back(particles.kinds[i]);
            to.bodies.push_back(index);
            to.facets.push_back(particles.facets[i]);
            to.mk.push_back(0);
            to.held.push_back(0);
        }
        out_.layers.push_back(std::move(layer));
    }

private:
    const FitSettings& settings_;
    const LatticeGrid& grid_;
    int threads_;
    FittedDraw& out_;
    Features sharp_;
    std::vector<MiddlePoint> middle_; ///< of thin parts
    std::unique_ptr<PointGrid> near_middle_;
};

/// Adds spans to each slab.
void unite_with(std::vector<Spans>& slabs, const std::vector<Spans>& more, int threads)
{
    parallel_for(slabs.size(), threads,
                 [&](std::size_t x) { slabs[x] = unite(slabs[x], more[x]); });
}

PointGrid grid_of(const std::vector<Vec3>& points, double cell)
{
    PointGrid grid(cell, points.size());
    for (const Vec3& p : points) grid.add(p);
    return grid;
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
    for (const Span& span : nodes)
        for (std::uint32_t z = span.z_begin; z < span.z_end; ++z)
        {
            const Vec3 p =
                grid.origin + grid.dp * Vec3{static_cast<double>(x), static_cast<double>(span.y),
                                             static_cast<double>(z)};
            if (taken.has_nearer(p, gap_dp * grid.dp)) continue;
            const DepthPlace here = wall.at(p);
            if (here.depth < gap_depth_dp * grid.dp) continue;
            // Thick enough for all layers and nodes under them: they are the ones to fill it.
            if (wall.at(here.foot + enough * here.direction).depth > enough * (1 - 1e-6)) continue;
            if (!found.empty() && found.back().y == span.y && found.back().z_end == z)
                ++found.back().z_end;
            else
                found.push_back({span.y, z, z + 1});
        }
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
                const Vec3 p =
                    grid.origin + grid.dp * Vec3{static_cast<double>(x), 0, static_cast<double>(z)};
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
    while (static_cast<double>(found.size()) > wanted + 0.5 &&
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
    std::vector<std::uint64_t> added(grid.n[0], 0);
    parallel_for(grid.n[0], threads,
                 [&](std::size_t x)
                 {
                     deep[x] = intersect(deep[x], inside[x]);
                     const Spans gaps =
                         find_gaps(subtract(inside[x], deep[x]), x, taken, grid, out);
                     for (const Span& s : gaps) added[x] += s.z_end - s.z_begin;
                     deep[x] = unite(deep[x], gaps);
                     out.zone[x] = unite(out.zone[x], subtract(inside[x], deep[x]));
                 });
    inside = std::move(deep);
    for (const std::uint64_t n : added) nodes += n;
    out.body.measures.node_volume = static_cast<double>(nodes) * grid.dp * grid.dp * grid.dp;
}

/// The area of each layer and what the particles of all stand for.
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

} // namespace

void add_layers(const FitSettings& settings, const LatticeGrid& grid, int threads, FittedDraw& out)
{
    const bool is_closed = out.body.measures.volume > 0;
    LayerBuilder builder(settings, grid, threads, out);
    const LayerSide side =
        is_closed ? LayerSide::Behind : settings.side.value_or(builder.side_without_fluid());
    if (side != LayerSide::Front) builder.build(WallSide::Behind, is_closed);
    if (side != LayerSide::Behind) builder.build(WallSide::Front, is_closed);
    if (is_closed)
        take_nodes_between(grid, threads, out);
    else
    {
        for (const FittedBody& layer : out.layers)
            if (!layer.mesh.facets.empty())
                unite_with(
                    out.zone,
                    by_slab(exclusion_band(layer.mesh, layer.report, grid, {}, threads).zone, grid),
                    threads);
        if (!settings.side && settings.fluid_places.empty())
            out.warnings.push_back(
                "layers of this sheet stand behind it, where its facets do not look: "
                "side=\"front\" "
                "or \"both\" of <bodyfitted> changes that, side=\"behind\" says that it is meant.");
    }
    measure_layers(grid, out);
}

} // namespace fppg
