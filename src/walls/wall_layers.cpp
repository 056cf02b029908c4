#include "walls/wall_layers.h"

#include "fppg/exclusion_band.h"
#include "fppg/section.h"

#include "core/parallel.h"
#include "fit/wall_section.h"
#include "meshes/connect_mesh.h"
#include "nodes/cell_nodes.h"
#include "offset/layer_place.h"
#include "offset/offset_surface.h"
#include "walls/fit_shape.h"

#include <fmt/format.h>

#include <algorithm>
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
/// Layers of two sides that would be nearer than this merge, dp.
constexpr double merge_dp = 0.6;
/// Sides whose normals turn by more than 120 degrees face away from each other.
constexpr double opposing = -0.5;

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
        const auto [at, is_new] = known.try_emplace(
            {p.x, p.y, p.z}, static_cast<std::uint32_t>(out.vertices.size()));
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

    void build(WallSide side, bool is_closed)
    {
        std::shared_ptr<const WallDepth> wall = wall_of(side, is_closed);
        if (wall == nullptr) return;
        const std::string of_side =
            side == WallSide::Front ? " before the surface" : std::string();
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
            FittedBody body;
            body.name = fmt::format("layer {}{}", k + 1, of_side);
            body.is_solid = out_.body.is_solid;
            body.owner = 0;
            body.layer = static_cast<int>(k);
            body.depth = depth;
            body.wall = wall;
            body.features = offset_features(surface, feature_options(settings_, grid_));
            body.mesh = std::move(surface.mesh);
            body.report = std::move(surface.report);
            name_owners(*wall, body);
            add_particles(std::move(body));
        }
    }

private:
    std::shared_ptr<const WallDepth> wall_of(WallSide side, bool is_closed) const
    {
        const FittedBody& body = out_.body;
        if (!grid_.is_2d)
            return std::make_shared<WallDepth>(body.mesh, body.report, is_closed, side,
                                               settings_.feature_angle_deg, threads_);
        MeshReport report;
        const double half_width = (settings_.depths_dp.back() + 4) * grid_.dp;
        SurfaceMesh mesh = drawn_out(body.mesh, grid_.origin.y, half_width, threads_, report);
        if (mesh.facets.empty()) return nullptr;
        return std::make_shared<WallDepth>(mesh, report, false, side,
                                           settings_.feature_angle_deg, threads_);
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

    void add_particles(FittedBody&& layer)
    {
        const auto index = static_cast<std::uint32_t>(out_.layers.size() + 1);
        SurfaceParticles particles =
            grid_.is_2d ? section_of(layer, settings_, grid_)
                        : surface_of(layer, settings_, grid_, threads_);
        const LayerPlaces places(layer, grid_.dp);
        std::vector<char> is_out(particles.positions.size());
        parallel_for(
            particles.positions.size(), threads_,
            [&](std::size_t i)
            {
                Vec3& p = particles.positions[i];
                p = places.place(p, particles.kinds[i], particles.facets[i]);
                if (grid_.is_2d) p.y = grid_.origin.y;
                is_out[i] = meets_other_side(layer, p) ? 1 : 0;
            },
            256);
        for (std::size_t i = 0; i < is_out.size(); ++i)
        {
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
};

/// Adds spans to each slab.
void unite_with(std::vector<Spans>& slabs, const std::vector<Spans>& more, int threads)
{
    parallel_for(slabs.size(), threads, [&](std::size_t x) { slabs[x] = unite(slabs[x], more[x]); });
}

/// Of the nodes inside, those under the innermost layer stay.
void take_nodes_between(const LatticeGrid& grid, int threads, FittedDraw& out)
{
    const bool is_hollow = !out.body.is_solid;
    std::vector<Spans>& inside = is_hollow ? out.hollow : out.volume;
    std::vector<Spans> deep(grid.n[0]);
    std::uint64_t nodes = 0;
    if (!out.layers.empty())
    {
        const FittedBody& innermost = out.layers.back();
        ExclusionBandOptions options;
        options.is_solid = true;
        for (const std::uint32_t b : out.particles.bodies)
            options.wall_particles += b == out.layers.size() ? 1 : 0;
        ExclusionBand band =
            exclusion_band(innermost.mesh, innermost.report, grid, options, threads);
        nodes = band.nodes;
        deep = by_slab(std::move(band.volume), grid);
    }
    if (inside.empty()) return;
    parallel_for(grid.n[0], threads,
                 [&](std::size_t x)
                 {
                     deep[x] = intersect(deep[x], inside[x]);
                     out.zone[x] = unite(out.zone[x], subtract(inside[x], deep[x]));
                 });
    inside = std::move(deep);
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
    for (std::size_t k = 0; k < out.layers.size(); ++k)
    {
        FitMeasures& measures = out.layers[k].measures;
        const double all = counts[k + 1] + dropped[k + 1];
        double area = 0;
        for (const double a : out.layers[k].mesh.areas) area += a;
        // In 2D the strip is two halves of a cell wide.
        if (grid.is_2d) area *= 1 / offset_cell_dp;
        measures.area = all > 0 ? area * counts[k + 1] / all : 0;
        measures.second_sheet = area - measures.area;
        measures.wall_particles = counts[k + 1];
        of_body.wall_particles += counts[k + 1];
        of_body.wall_volume += counts[k + 1] * dp3;
    }
    out.body.settle_share(grid.dp);
}

} // namespace

void add_layers(const FitSettings& settings, const LatticeGrid& grid, int threads, FittedDraw& out)
{
    const bool is_closed = out.body.measures.volume > 0;
    LayerBuilder builder(settings, grid, threads, out);
    const LayerSide side = is_closed ? LayerSide::Behind : settings.side.value_or(LayerSide::Behind);
    if (side != LayerSide::Front) builder.build(WallSide::Behind, is_closed);
    if (side != LayerSide::Behind) builder.build(WallSide::Front, is_closed);
    if (is_closed)
        take_nodes_between(grid, threads, out);
    else
    {
        for (const FittedBody& layer : out.layers)
            unite_with(out.zone,
                       by_slab(exclusion_band(layer.mesh, layer.report, grid, {}, threads).zone,
                               grid),
                       threads);
        if (!settings.side)
            out.warnings.push_back(
                "layers of this sheet stand behind it, where its facets do not look: side=\"front\" "
                "or \"both\" of <bodyfitted> changes that, side=\"behind\" says that it is meant.");
    }
    measure_layers(grid, out);
}

} // namespace fppg
