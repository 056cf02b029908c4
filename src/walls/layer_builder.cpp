#include "walls/layer_builder.h"

#include "fppg/section.h"

#include "core/parallel.h"
#include "fit/wall_section.h"
#include "meshes/cad_surface.h"
#include "meshes/connect_mesh.h"
#include "meshes/crowded_points.h"
#include "meshes/measure_facets.h"
#include "offset/layer_place.h"
#include "offset/offset_surface.h"
#include "walls/fit_shape.h"
#include "walls/flat_layers.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <tuple>
#include <utility>

namespace fppg
{
namespace
{

/// No edge turns by more: all depths are distances.
constexpr double no_edge_deg = 180;
/// Sides whose normals turn by more than 120 degrees face away from each other.
constexpr double opposing = -0.5;
/// Fluid that is drawn in the wall, so near, decides no side, dp.
constexpr double in_wall_dp = 0.25;
/// No particle of a layer is so near to the middle of a thin part, which has its own, dp.
constexpr double off_middle_dp = 0.35;
/// As take_nodes_on_flats() takes it.
constexpr double least_matched_of_layers = 0.6;

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
    connect_mesh(out, high_where_exact * half_width, threads, report);
    return out;
}

} // namespace

double layer_cell_dp(const SurfaceMesh& wall, double dp)
{
    return turn_per_metre(wall) * dp < few_turns ? coarse_cell_dp : offset_cell_dp;
}

LayerSide LayerBuilder::side_without_fluid() const
{
    if (settings_.fluid_places.empty()) return LayerSide::Behind;
    // A closed surface may cross itself: the nearest facet alone does not say on which side of it
    // a place is.
    const auto wall = wall_of(WallSide::Behind, out_.body.measures.volume > 0, no_edge_deg, 0);
    if (wall == nullptr) return LayerSide::Behind;
    double nearest = std::numeric_limits<double>::infinity();
    LayerSide side = LayerSide::Behind;
    for (const Vec3& p : settings_.fluid_places)
    {
        const double depth = wall->at(p).depth;
        if (std::fabs(depth) >= nearest || std::fabs(depth) < in_wall_dp * grid_.dp) continue;
        nearest = std::fabs(depth);
        side = depth > 0 ? LayerSide::Front : LayerSide::Behind;
    }
    return side;
}

OffsetSurface LayerBuilder::surface_at(double depth, double cell_dp, WallSide side, bool is_closed,
                                       std::shared_ptr<const WallDepth>& wall)
{
    OffsetOptions options;
    options.depth = depth;
    options.dp = grid_.dp;
    options.cell = cell_dp * grid_.dp;
    options.feature_angle_deg = settings_.feature_angle_deg;
    options.keeps_facets = !out_.body.facet_mk.empty();
    if (grid_.is_2d) options.plane_y = grid_.origin.y;
    OffsetSurface surface = offset_surface(*wall, options, threads_);
    // Where faces beyond come nearer than the tip of a mitre its depth jumps, and the
    // surface tears; the plain distance has no jumps.
    if (is_closed && !grid_.is_2d && !surface.mesh.facets.empty() && surface.report.open_edges > 0)
    {
        if (rounded_ == nullptr) rounded_ = wall_of(side, is_closed, no_edge_deg, depth / grid_.dp);
        wall = rounded_;
        surface = offset_surface(*wall, options, threads_);
    }
    return surface;
}

void LayerBuilder::build(WallSide side, bool is_closed, const LayerPlan& plan)
{
    plan_ = plan;
    rounded_ = nullptr;
    thin_ = {};
    near_middle_.reset();
    const double deepest = plan.depths_dp.empty() ? 0 : plan.depths_dp.back();
    wall_ = wall_of(side, is_closed, settings_.feature_angle_deg, deepest);
    if (wall_ == nullptr) return;
    if (plan.middle_dp > 0 || !plan.gaps.empty()) look_for_thin_parts(*wall_);
    // The number of particles inside a body is measured by its layers' facets.
    const double cell_dp =
        grid_.is_2d || out_.body.is_inside ? plan.cell_dp : layer_cell_dp(wall_->mesh(), grid_.dp);
    const std::string of_side = side == WallSide::Front ? " before the surface" : std::string();
    for (std::size_t k = 0; k < plan.depths_dp.size(); ++k)
    {
        const double depth = plan.depths_dp[k] * grid_.dp;
        if (!(depth > 0)) continue;
        std::shared_ptr<const WallDepth> of_layer = wall_;
        OffsetSurface surface = surface_at(depth, cell_dp, side, is_closed, of_layer);
        if (surface.mesh.facets.empty()) break;
        FittedBody body;
        body.name = fmt::format("layer {}{}", k + 1, of_side);
        body.is_solid = out_.body.is_solid;
        body.is_inside = out_.body.is_inside;
        body.spacing_dp = plan.spacing_dp;
        body.owner = 0;
        body.layer = static_cast<int>(k);
        body.depth = depth;
        body.wall = of_layer;
        body.features = offset_features(surface, feature_options(settings_, grid_));
        body.mesh = std::move(surface.mesh);
        body.report = std::move(surface.report);
        name_owners(*body.wall, body);
        const auto index = static_cast<std::uint32_t>(out_.layers.size() + 1);
        add_particles(body, index);
        out_.layers.push_back(std::move(body));
    }
    if (plan_.number == 0) merge_sides();
}

void LayerBuilder::lay_again(double spacing_dp, bool is_trial)
{
    is_trial_ = is_trial;
    plan_.spacing_dp = spacing_dp;
    out_.particles = {};
    out_.second_sheet = {};
    out_.body.left_out = {};
    while (!out_.layers.empty() && out_.layers.back().mesh.facets.empty()) out_.layers.pop_back();
    for (std::size_t l = 0; l < out_.layers.size(); ++l)
    {
        out_.layers[l].spacing_dp = spacing_dp;
        add_particles(out_.layers[l], static_cast<std::uint32_t>(l + 1));
    }
    if (plan_.number == 0) merge_sides();
}

std::shared_ptr<const WallDepth> LayerBuilder::wall_of(WallSide side, bool is_closed,
                                                       double sharp_angle_deg,
                                                       double deepest_dp) const
{
    const FittedBody& body = out_.body;
    if (!grid_.is_2d)
    {
        auto wall = std::make_shared<WallDepth>(body.mesh, body.report, is_closed, side,
                                                sharp_angle_deg, threads_);
        wall->take_round_surface(body.mesh, body.round, false);
        wall->take_cad_surface(body.mesh, body.cad, false, threads_);
        return wall;
    }
    MeshReport report;
    const double half_width = (deepest_dp + 4) * grid_.dp;
    SurfaceMesh mesh = drawn_out(body.mesh, grid_.origin.y, half_width, threads_, report);
    if (mesh.facets.empty()) return nullptr;
    auto wall = std::make_shared<WallDepth>(mesh, report, false, side, sharp_angle_deg, threads_);
    wall->take_round_surface(body.mesh, body.round, true);
    wall->take_cad_surface(body.mesh, body.cad, true, threads_);
    return wall;
}

/// Of a combination: each facet belongs to the part that is nearest to it.
void LayerBuilder::name_owners(const WallDepth& wall, FittedBody& body) const
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
bool LayerBuilder::meets_other_side(const FittedBody& body, const Vec3& p) const
{
    const WallDepth& wall = *body.wall;
    const DepthPlace here = wall.at(p);
    const double reach = body.depth + 0.5 * merge_dp * grid_.dp;
    const DepthPlace there = wall.at(here.foot + reach * here.direction);
    return there.depth < reach * (1 - 1e-9) && dot(here.direction, there.direction) < opposing;
}

MergedSheetOptions LayerBuilder::sheet_options() const
{
    MergedSheetOptions options;
    options.dp = grid_.dp;
    options.least_depth_dp = plan_.middle_dp;
    options.gaps = plan_.gaps;
    options.parts = plan_.parts;
    options.evens_out = !is_trial_;
    options.off_edges_dp = plan_.off_edges_dp;
    if (plan_.number > 0)
        options.wanted =
            plan_.number > out_.particles.size() ? plan_.number - out_.particles.size() : 0;
    else if (plan_.parts == 1 && thin_.volume > 0)
        options.wanted =
            static_cast<std::size_t>(std::lround(thin_.volume / std::pow(grid_.dp, 3)));
    if (grid_.is_2d) options.plane_y = grid_.origin.y;
    return options;
}

/// Where a part is too thin for a layer of each side.
void LayerBuilder::look_for_thin_parts(const WallDepth& wall)
{
    sharp_ = find_features(wall.mesh(), feature_options(settings_, grid_), {},
                           grid_.is_2d ? bends_of(nullptr) : bends_of(out_.body.cad));
    thin_ = find_thin_parts(wall, sharp_, sheet_options(), threads_);
    near_middle_ = std::make_unique<PointGrid>(off_middle_dp * grid_.dp, thin_.middle.size());
    for (const MiddlePoint& p : thin_.middle)
        if (!p.is_in_gap()) near_middle_->add(p.position);
}

void LayerBuilder::merge_sides()
{
    if (thin_.middle.empty()) return;
    SurfaceParticles sheet = merged_sheet(*wall_, sharp_, thin_.middle, out_.particles.positions,
                                          sheet_options(), threads_);
    // Between layers it is the next of both sides.
    std::vector<std::size_t> numbers;
    std::vector<double> depths;
    for (Vec3& p : sheet.positions)
    {
        if (grid_.is_2d) p.y = grid_.origin.y;
        depths.push_back(wall_->at(p).depth);
        const double depth_dp = depths.back() / grid_.dp;
        numbers.push_back(static_cast<std::size_t>(std::count_if(
            plan_.gaps.begin(), plan_.gaps.end(),
            [&](const SheetGap& gap) { return depth_dp > gap.from_dp - 0.25 * least_gap_dp; })));
    }
    for (std::size_t number = 0; number <= plan_.gaps.size(); ++number)
        add_shared(number, numbers, depths, sheet);
}

/// Those of a sheet on the middle that have a number as their layer.
void LayerBuilder::add_shared(std::size_t number, const std::vector<std::size_t>& numbers,
                              const std::vector<double>& depths, const SurfaceParticles& sheet)
{
    if (std::find(numbers.begin(), numbers.end(), number) == numbers.end()) return;
    FittedBody body;
    body.name = "shared layer";
    body.is_solid = out_.body.is_solid;
    body.is_inside = out_.body.is_inside;
    body.spacing_dp = plan_.spacing_dp;
    body.owner = 0;
    body.layer = static_cast<int>(number);
    body.wall = wall_;
    if (!grid_.is_2d) body.facet_mk = out_.body.facet_mk;
    const auto index = static_cast<std::uint32_t>(out_.layers.size() + 1);
    for (std::size_t i = 0; i < sheet.positions.size(); ++i)
    {
        if (numbers[i] != number) continue;
        body.depth = std::max(body.depth, depths[i]);
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
void LayerBuilder::drop_crowded(const std::vector<char>& is_out, SurfaceParticles& particles,
                                std::vector<char>& goes)
{
    std::vector<Vec3> points = particles.positions;
    std::vector<std::uint32_t> rank;
    for (std::size_t i = 0; i < points.size(); ++i)
        rank.push_back((is_out[i] != 0 ? 5 : 1) + static_cast<std::uint32_t>(particles.kinds[i]));
    const std::size_t own = points.size();
    const std::vector<Vec3>& before = out_.particles.positions;
    points.insert(points.end(), before.begin(), before.end());
    rank.resize(points.size(), 0);
    const auto may_stay = [&](std::size_t i, std::size_t j)
    {
        const auto is_of_other_side = [&](std::size_t k) { return k < own && is_out[k] != 0; };
        return (i >= own || is_of_other_side(i)) && (j >= own || is_of_other_side(j));
    };
    goes = find_crowded(points, rank, least_pair_dp * grid_.dp, may_stay, threads_);
    goes.resize(own);
    for (std::size_t i = 0; i < own; ++i)
        if (goes[i] != 0 && is_out[i] == 0)
            ++out_.body.left_out[static_cast<std::size_t>(particles.kinds[i])];
}

void LayerBuilder::add_particles(FittedBody& layer, std::uint32_t index)
{
    LatticeGrid spaced = grid_;
    spaced.dp *= plan_.spacing_dp;
    SurfaceParticles particles = grid_.is_2d ? section_of(layer, settings_, spaced)
                                             : surface_of(layer, settings_, spaced, threads_);
    for (std::size_t kind = 0; kind < layer.left_out.size(); ++kind)
        out_.body.left_out[kind] += std::exchange(layer.left_out[kind], 0);
    // Bodies with Placement::Inside need not fit to fluid.
    std::vector<char> is_node(particles.positions.size(), 0);
    if (!layer.is_inside)
        is_node = take_nodes_on_flats(layer, grid_, least_matched_of_layers, particles);
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
        to.held.push_back(is_node[i]);
    }
}

} // namespace fppg
