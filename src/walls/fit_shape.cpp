#include "walls/fit_shape.h"

#include "fppg/exclusion_band.h"
#include "fppg/one_sheet.h"
#include "fppg/section.h"

#include "core/parallel.h"
#include "fit/inside_angles.h"
#include "meshes/cad_surface.h"
#include "meshes/crowded_points.h"
#include "meshes/round_surface.h"
#include "nodes/cell_nodes.h"
#include "nodes/domain.h"
#include "walls/flat_layers.h"
#include "walls/inside_body.h"
#include "walls/touching_shells.h"
#include "walls/wall_layers.h"

#include <algorithm>
#include <utility>

namespace fppg
{
namespace
{

constexpr std::size_t particles_per_chunk = 4096;
/// Of the distance of particles on lines of bodies with Placement::Inside.
constexpr double line_room = 0.02;
/// As take_nodes_on_flats() takes it. With 0.6, walls of a tank of 16.3 x 14.6 x 30 dp were less
/// even (coefficient of variation 0.047 instead of 0.032).
constexpr double least_matched_of_surfaces = 0.95;

bool is_kept_by(const std::vector<ClipPlane>& clips, const Vec3& p, double dp)
{
    return std::all_of(clips.begin(), clips.end(),
                       [&](const ClipPlane& clip)
                       {
                           const double length = norm(clip.normal);
                           return dot(p - clip.point, clip.normal) <= 1e-9 * dp * length;
                       });
}

/// A closed surface that holds no node is as good as solid: its particles stand for all of it.
void take_measures(const ExclusionBand& zone, const ExclusionBandOptions& options,
                   std::size_t second_sheet, const LatticeGrid& grid, FittedBody& body)
{
    const double dp = grid.dp;
    const double dp3 = dp * dp * dp;
    const auto n = static_cast<double>(options.wall_particles);
    FitMeasures& measures = body.measures;
    measures.area = zone.area + 0.5 * dp * open_rims(body.mesh, grid);
    if (second_sheet > 0)
        measures.second_sheet = measures.area * (1 - n / (n + static_cast<double>(second_sheet)));
    measures.area -= measures.second_sheet;
    measures.wall_particles = n;
    if (!zone.has_inside) return;
    measures.volume = zone.body_volume;
    measures.sheet_volume = zone.sheet_area * dp;
    measures.node_volume = static_cast<double>(zone.nodes) * dp3;
    measures.wall_volume = n * zone.wall_share_inside * dp3;
    measures.filled = body.is_solid || zone.nodes == 0 ? 1 : 0;
    body.settle_share(dp);
}

/// The nodes inside a body and around its surface, and the clearances.
void find_nodes(const FitSettings& settings, const LatticeGrid& grid, int threads, FittedDraw& out)
{
    FittedBody& body = out.body;
    ExclusionBandOptions options;
    options.clearance_dp = settings.clearance_dp;
    options.wall_particles = out.particles.size();
    options.share_inside = mean_share_inside(
        body.mesh, {out.particles.positions, out.particles.kinds, out.particles.facets},
        grid.is_2d);
    options.is_solid = body.is_solid;
    options.is_before_layers = !settings.depths_dp.empty() && settings.depths_dp[0] > 0;
    ExclusionBand zone = exclusion_band(body.mesh, body.report, grid, options, threads);
    out.warnings.insert(out.warnings.end(), zone.warnings.begin(), zone.warnings.end());
    if (body.is_solid && !zone.has_inside && zone.warnings.empty())
        out.warnings.emplace_back(
            "the shape has no inside that could be filled: only its surface has particles");
    body.clearance_inside = zone.clearance_inside_dp * grid.dp;
    body.clearance_outside = zone.clearance_outside_dp * grid.dp;
    take_measures(zone, options, out.second_sheet.size(), grid, body);
    if (zone.has_inside && body.measures.filled == 0)
        out.hollow = by_slab(SpanSet{zone.volume}, grid);
    out.zone = by_slab(std::move(zone.zone), grid);
    out.volume = by_slab(body.is_solid ? std::move(zone.volume) : SpanSet{}, grid);
}

/// Keeps the particles in the domain and within the clips; the places of the others are cut.
void keep_particles(const LatticeGrid& grid, const std::vector<ClipPlane>& clips, int threads,
                    FittedDraw& out)
{
    WallParticles& particles = out.particles;
    const std::size_t n = particles.size();
    std::vector<char> is_out(n);
    parallel_for(
        n, threads,
        [&](std::size_t i)
        {
            const Vec3& p = particles.positions[i];
            is_out[i] = !is_in_domain(p, grid, beyond_period_dp) || !is_kept_by(clips, p, grid.dp);
        },
        particles_per_chunk);
    for (std::size_t i = 0; i < n; ++i)
    {
        if (!is_out[i]) continue;
        out.cut.push_back(particles.positions[i]);
        out.cut_bodies.push_back(particles.bodies[i]);
    }
    if (!out.cut.empty()) particles.erase(is_out);
}

/// As particles of the body itself; mks come when it is painted.
WallParticles of_body(SurfaceParticles&& surface)
{
    WallParticles out;
    const std::size_t n = surface.positions.size();
    out.positions = std::move(surface.positions);
    out.kinds = std::move(surface.kinds);
    out.facets = std::move(surface.facets);
    out.bodies.assign(n, 0);
    out.mk.assign(n, 0);
    out.held.assign(n, 0);
    return out;
}

/// In 2D, where lines run close to one another: corners stay first. The sheets of a plate stay both
/// where its settings say so.
void drop_crowded_in_plane(const FitSettings& settings, double dp, int threads,
                           SurfaceParticles& surface, FittedBody& body)
{
    const auto are_sheets = [&](std::size_t i, std::size_t j)
    {
        const std::vector<Vec3>& normals = body.mesh.normals;
        return settings.one_sheet_dp == 0 &&
               dot(normals[surface.facets[i]], normals[surface.facets[j]]) < -0.5;
    };
    std::vector<std::uint32_t> rank;
    for (const FitKind kind : surface.kinds) rank.push_back(static_cast<std::uint32_t>(kind));
    const std::vector<char> goes =
        find_crowded(surface.positions, rank, least_pair_dp * dp, are_sheets, threads);
    SurfaceParticles kept;
    for (std::size_t i = 0; i < goes.size(); ++i)
    {
        if (goes[i] != 0)
        {
            ++body.left_out[static_cast<std::size_t>(surface.kinds[i])];
            continue;
        }
        kept.positions.push_back(surface.positions[i]);
        kept.kinds.push_back(surface.kinds[i]);
        kept.facets.push_back(surface.facets[i]);
    }
    surface = std::move(kept);
}

/// On the surface, but for walls all of whose layers are behind it.
void add_surface(const FitSettings& settings, const LatticeGrid& grid, int threads, FittedDraw& out)
{
    FittedBody& body = out.body;
    if (!settings.depths_dp.empty() && settings.depths_dp[0] > 0) return;
    SurfaceParticles surface =
        grid.is_2d ? section_of(body, settings, grid) : surface_of(body, settings, grid, threads);
    if (settings.one_sheet_dp > 0)
        out.second_sheet = of_body(keep_one_sheet(
            body.mesh, body.features, {grid.dp, settings.one_sheet_dp}, surface, threads));
    if (grid.is_2d) drop_crowded_in_plane(settings, grid.dp, threads, surface, body);
    if (body.round != nullptr || body.cad != nullptr)
        parallel_for(
            surface.positions.size(), threads,
            [&](std::size_t i)
            { project_to_exact(body, surface.positions[i], surface.facets[i], grid.is_2d); },
            particles_per_chunk);
    std::vector<char> is_node(surface.positions.size(), 0);
    if (out.second_sheet.size() == 0)
        is_node = take_nodes_on_flats(body, grid, least_matched_of_surfaces, surface);
    out.particles = of_body(std::move(surface));
    out.particles.held = std::move(is_node);
}

FittedDraw nothing_of(FittedBody&& body, const LatticeGrid& grid)
{
    FittedDraw out;
    out.warnings = body.report.warnings;
    out.body = std::move(body);
    out.zone.resize(grid.n[0]);
    out.volume.resize(grid.n[0]);
    return out;
}

/// A blob smaller than a cell, or a clip, can leave a particle without a node of the zone.
void give_nodes_to_lone_particles(const LatticeGrid& grid, int threads, FittedDraw& out)
{
    const std::vector<Vec3>& positions = out.particles.positions;
    std::vector<char> is_alone(positions.size());
    parallel_for(
        positions.size(), threads,
        [&](std::size_t i)
        {
            const Vec3& p = positions[i];
            is_alone[i] = !find_node_in(out.zone, p, grid) && cell_corners(p, grid).count > 0;
        },
        1024);
    std::vector<Spans> added(grid.n[0]);
    for (std::size_t i = 0; i < positions.size(); ++i)
    {
        if (!is_alone[i]) continue;
        const Node c = cell_corners(positions[i], grid).nodes[0];
        added[static_cast<std::size_t>(c.x)].push_back({static_cast<std::uint32_t>(c.y),
                                                        static_cast<std::uint32_t>(c.z),
                                                        static_cast<std::uint32_t>(c.z) + 1});
    }
    for (std::size_t x = 0; x < added.size(); ++x)
    {
        if (added[x].empty()) continue;
        sort_and_join(added[x]);
        out.zone[x] = unite(out.zone[x], added[x]);
        out.volume[x] = subtract(out.volume[x], added[x]);
    }
}

/// Whether particles of dp^3 in a body are near enough to one another to hold fluid: those of a
/// plate thinner than this, dp, are not.
bool has_room_inside(const FittedBody& body, double dp)
{
    constexpr double thinnest_dp = 0.75;
    const FitMeasures& of = body.measures;
    return body.is_solid && of.volume > 0 && 2 * of.volume > thinnest_dp * dp * of.area;
}

} // namespace

FitSettings of_open_body(const FitSettings& settings)
{
    FitSettings out = settings;
    out.place = Placement::Surface;
    out.may_be_open = false;
    out.depths_dp.clear();
    return out;
}

double open_rims(const SurfaceMesh& mesh, const LatticeGrid& grid)
{
    double length = 0;
    for (std::size_t e = 0; e < mesh.edges.size(); ++e)
    {
        if (mesh.edge_facets[e][1] != no_index) continue;
        const Vec3& a = mesh.vertices[mesh.edges[e][0]];
        const Vec3& b = mesh.vertices[mesh.edges[e][1]];
        if (!grid.is_2d)
            length += norm(b - a);
        else if ((a.y < grid.origin.y) != (b.y < grid.origin.y))
            length += grid.dp;
    }
    return length;
}

SurfaceParticles surface_of(FittedBody& body, const FitSettings& settings, const LatticeGrid& grid,
                            int threads)
{
    FitOptions options;
    options.dp = grid.dp;
    options.lattice_origin = grid.origin;
    options.density = settings.density;
    FeaturesLeftOut left_out;
    FeatureOptions on_lines = feature_options(settings, grid);
    // A line a little longer than n dp has n parts: its particles stand for dp^3.
    if (body.is_inside) on_lines.dp *= 1 + line_room;
    const std::vector<FeatureParticle> on_features =
        place_feature_particles(body.mesh, body.features, on_lines, &left_out);
    body.left_out[0] += left_out.corners;
    body.left_out[1] += left_out.edges;
    return fit_surface(body.mesh, body.features, on_features, options, threads);
}

/// In 2D the wall is where the surface meets the plane of the particles.
SurfaceParticles section_of(const FittedBody& body, const FitSettings& settings,
                            const LatticeGrid& grid)
{
    SectionOptions options;
    options.y = grid.origin.y;
    options.dp = grid.dp;
    options.feature_angle_deg = settings.feature_angle_deg;
    SectionParticles section = section_particles(body.mesh, options);
    return {std::move(section.positions), std::move(section.kinds), std::move(section.facets)};
}

FeatureOptions feature_options(const FitSettings& settings, const LatticeGrid& grid)
{
    FeatureOptions options;
    options.angle_deg = settings.feature_angle_deg;
    options.cad_angle_deg = settings.cad_angle_deg;
    options.dp = grid.dp;
    return options;
}

FittedDraw fit_shape(ShapeMesh shape, const FitSettings& settings, const LatticeGrid& grid,
                     const std::vector<ClipPlane>& clips, BodyExtent extent, int threads)
{
    FittedBody body;
    body.is_solid = shape.is_solid;
    body.round = shape.round;
    body.mesh = repair_mesh(shape.soup,
                            {.dp = grid.dp,
                             .is_exact = shape.round != nullptr || shape.cad != nullptr,
                             .is_solid = shape.is_solid,
                             .warns_of_folds = true},
                            threads, body.report);
    shape.soup = {};
    unite_touching_shells(body.mesh, body.report, grid.dp, threads);
    std::vector<std::uint32_t> seams;
    if (extent == BodyExtent::NearDomain) seams = cut_to_domain(body, settings, grid, threads);
    if (body.mesh.facets.empty()) return nothing_of(std::move(body), grid);
    if (shape.cad != nullptr)
        body.cad = std::make_shared<const CadSurface>(body.mesh, std::vector{*shape.cad}, threads);
    body.features =
        find_features(body.mesh, feature_options(settings, grid), seams, bends_of(body.cad));
    return fit_body(std::move(body), settings, grid, clips, threads);
}

FittedDraw fit_body(FittedBody&& given, const FitSettings& settings, const LatticeGrid& grid,
                    const std::vector<ClipPlane>& clips, int threads)
{
    Box3 bounds;
    for (const Vec3& v : given.mesh.vertices) bounds.add(v);
    expect_near(bounds, grid);
    FittedDraw out;
    out.body = std::move(given);
    out.warnings = out.body.report.warnings;
    add_surface(settings, grid, threads, out);
    find_nodes(settings, grid, threads, out);
    if (settings.may_be_open && !has_room_inside(out.body, grid.dp))
        return fit_body(std::move(out.body), of_open_body(settings), grid, clips, threads);
    if (settings.place == Placement::Inside)
        fill_inside(settings, grid, threads, out);
    else if (!settings.depths_dp.empty())
        add_layers(settings, grid, threads, out);
    for (const ClipPlane& clip : clips)
        parallel_for(grid.n[0], threads,
                     [&](std::size_t x)
                     {
                         apply_clip(out.zone[x], static_cast<std::uint32_t>(x), clip, grid);
                         apply_clip(out.volume[x], static_cast<std::uint32_t>(x), clip, grid);
                     });
    keep_particles(grid, clips, threads, out);
    give_nodes_to_lone_particles(grid, threads, out);
    return out;
}

} // namespace fppg
