#include "lattice/wall_painter.h"

#include "fppg/one_sheet.h"
#include "fppg/section.h"
#include "fppg/wall_zone.h"

#include "core/parallel.h"
#include "lattice/snap.h"
#include "shapes/mesh_query.h"
#include "shapes/point_grid.h"
#include "shapes/round_surface.h"

#include <algorithm>
#include <optional>
#include <tuple>
#include <utility>

namespace fppg
{
namespace
{

/// Later fitted bodies cut the particles of earlier ones within this distance of their surface, dp.
constexpr double cut_distance_dp = 0.5;
/// Mark of a particle that a later body cuts although its place is not inside it.
constexpr char touched = 2;
/// Deeper in a later body than this a place is inside it, dp.
constexpr double touching_dp = 1e-6;
/// Particles this near to a cut one are held in place, dp.
constexpr double held_distance_dp = 2;

std::vector<Spans> by_slab(SpanSet&& set, const LatticeGrid& grid)
{
    std::vector<Spans> out(grid.n[0]);
    for (std::size_t i = 0; i < set.slabs.size(); ++i)
        out[set.x_begin + i] = std::move(set.slabs[i]);
    return out;
}

bool contains(const Spans& spans, std::uint32_t y, std::uint32_t z)
{
    const auto after =
        std::upper_bound(spans.begin(), spans.end(), std::pair(y, z),
                         [](const std::pair<std::uint32_t, std::uint32_t>& at, const Span& s)
                         { return at.first < s.y || (at.first == s.y && at.second < s.z_begin); });
    return after != spans.begin() && std::prev(after)->y == y && z < std::prev(after)->z_end;
}

/// The corners of the lattice cell around a point that lie in the lattice, nearest first; corners
/// equally near in the order of x, y, z.
struct CellCorners
{
    std::array<Node, 8> nodes;
    int count = 0;
};

CellCorners cell_corners(const Vec3& p, const LatticeGrid& grid)
{
    const auto floor_of = [&](int axis)
    {
        const double index = (p[axis] - grid.origin[axis]) / grid.dp;
        return static_cast<std::int64_t>(std::floor(std::clamp(index, -4e9, 4e9)));
    };
    const Node low{floor_of(0), floor_of(1), floor_of(2)};
    CellCorners out;
    std::array<double, 8> squared;
    for (int corner = 0; corner < 8; ++corner)
    {
        const Node n{low.x + (corner >> 2), low.y + (corner >> 1 & 1), low.z + (corner & 1)};
        if (!is_inside(n, grid)) continue;
        const Vec3 away = position(n, grid) - p;
        const double d = dot(away, away);
        auto at = static_cast<std::size_t>(out.count++);
        for (; at > 0 && d < squared[at - 1]; --at)
        {
            squared[at] = squared[at - 1];
            out.nodes[at] = out.nodes[at - 1];
        }
        squared[at] = d;
        out.nodes[at] = n;
    }
    return out;
}

/// The corner of the lattice cell around a point that is nearest to it.
Node nearest_node(const Vec3& p, const LatticeGrid& grid)
{
    const auto round_of = [&](int axis)
    {
        const double index = (p[axis] - grid.origin[axis]) / grid.dp;
        return static_cast<std::int64_t>(std::ceil(std::clamp(index, -4e9, 4e9) - 0.5));
    };
    return {round_of(0), round_of(1), round_of(2)};
}

/// Of the corners of the lattice cell around a point the nearest one that the spans of the
/// lattice's slabs hold.
std::optional<Node> find_node_in(const std::vector<Spans>& slabs, const Vec3& p,
                                 const LatticeGrid& grid)
{
    const auto is_held = [&](const Node& n)
    {
        return contains(slabs[static_cast<std::size_t>(n.x)], static_cast<std::uint32_t>(n.y),
                        static_cast<std::uint32_t>(n.z));
    };
    // Mostly it is the nearest of all.
    const Node nearest = nearest_node(p, grid);
    if (is_inside(nearest, grid) && is_held(nearest)) return nearest;
    const CellCorners corners = cell_corners(p, grid);
    const auto* end = corners.nodes.begin() + corners.count;
    const auto* found = std::find_if(corners.nodes.begin(), end, is_held);
    return found == end ? std::nullopt : std::optional(*found);
}
/// Between the first and the last nodes of the lattice, with room for rounding.
bool is_in_domain(const Vec3& p, const LatticeGrid& grid)
{
    for (int axis = 0; axis < 3; ++axis)
    {
        const double index = (p[axis] - grid.origin[axis]) / grid.dp;
        if (!(index >= -1e-6 && index <= grid.n[static_cast<std::size_t>(axis)] - 1 + 1e-6))
            return false;
    }
    return true;
}

/// Whether a point is in a box that is widened by `reach`.
bool is_within(const Vec3& p, const Box3& box, double reach)
{
    for (int axis = 0; axis < 3; ++axis)
        if (p[axis] < box.min[axis] - reach || p[axis] > box.max[axis] + reach) return false;
    return true;
}

bool is_kept_by(const std::vector<ClipPlane>& clips, const Vec3& p, double dp)
{
    return std::all_of(clips.begin(), clips.end(),
                       [&](const ClipPlane& clip)
                       {
                           const double length = norm(clip.normal);
                           return dot(p - clip.point, clip.normal) <= 1e-9 * dp * length;
                       });
}

/// The slab's runs that belong to the zone of a wall.
Spans zone_of(const std::vector<Run>& runs)
{
    Spans out;
    for (const Run& r : runs)
        if ((r.mk & wall_zone_bit) != 0) out.push_back({r.y, r.z_begin, r.z_end});
    sort_and_join(out);
    return out;
}

std::uint64_t count_nodes(const Spans& spans)
{
    std::uint64_t count = 0;
    for (const Span& s : spans) count += s.z_end - s.z_begin;
    return count;
}

/// Inside by the sum of signed crossings along each axis, two of three. Used away from the surface.
bool is_inside_mesh(const MeshQuery& query, const Vec3& p)
{
    int votes = 0;
    for (int axis = 0; axis < 3; ++axis)
    {
        int sum = 0;
        for (const Crossing& c : query.crossings(p, axis)) sum -= c.step;
        votes += sum > 0 ? 1 : 0;
    }
    return votes >= 2;
}

SurfaceParticles surface_of(const FittedBody& body, const FitSettings& settings,
                            const LatticeGrid& grid, int threads)
{
    FitOptions options;
    options.dp = grid.dp;
    options.lattice_origin = grid.origin;
    options.density = settings.density;
    return fit_surface(
        body.mesh, body.features,
        place_feature_particles(body.mesh, body.features, feature_options(settings, grid)), options,
        threads);
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

/// Of open edges, metres; in 2D of those that meet the plane of the particles, dp each.
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

/// A closed surface that holds no node is as good as solid: its particles stand for all of it.
void take_figures(const WallZone& zone, const WallZoneOptions& options, std::size_t second_sheet,
                  const LatticeGrid& grid, FittedBody& body)
{
    const double dp = grid.dp;
    const double dp3 = dp * dp * dp;
    const auto n = static_cast<double>(options.wall_particles);
    FitFigures& figures = body.figures;
    figures.area = zone.area + 0.5 * dp * open_rims(body.mesh, grid);
    if (second_sheet > 0)
        figures.second_sheet = figures.area * (1 - n / (n + static_cast<double>(second_sheet)));
    figures.area -= figures.second_sheet;
    figures.wall_particles = n;
    if (!zone.has_inside) return;
    figures.volume = zone.body_volume;
    figures.sheet_volume = zone.sheet_area * dp;
    figures.node_volume = static_cast<double>(zone.nodes) * dp3;
    figures.wall_volume = n * zone.wall_share_inside * dp3;
    figures.filled = body.is_solid || zone.nodes == 0 ? 1 : 0;
    body.settle_share(dp);
}

} // namespace

FeatureOptions feature_options(const FitSettings& settings, const LatticeGrid& grid)
{
    FeatureOptions options;
    options.angle_deg = settings.feature_angle_deg;
    options.dp = grid.dp;
    return options;
}

FittedDraw fit_shape(const ShapeMesh& shape, const FitSettings& settings, const LatticeGrid& grid,
                     const std::vector<ClipPlane>& clips, int threads)
{
    FittedBody body;
    body.is_solid = shape.is_solid;
    body.round = shape.round;
    body.p0 = shape.p0;
    body.p1 = shape.p1;
    body.radius = shape.radius;
    body.mesh = take_in_mesh(shape.soup, {}, threads, body.report);
    body.features = find_features(body.mesh, feature_options(settings, grid));
    return fit_body(std::move(body), settings, grid, clips, threads);
}

FittedDraw fit_body(FittedBody&& given, const FitSettings& settings, const LatticeGrid& grid,
                    const std::vector<ClipPlane>& clips, int threads)
{
    FittedDraw out;
    out.body = std::move(given);
    FittedBody& body = out.body;
    out.warnings = body.report.warnings;
    SurfaceParticles surface =
        grid.is_2d ? section_of(body, settings, grid) : surface_of(body, settings, grid, threads);
    if (settings.one_sheet_dp > 0)
        out.second_sheet = keep_one_sheet(body.mesh, body.features,
                                          {grid.dp, settings.one_sheet_dp}, surface, threads);
    if (body.round != RoundShape::None)
        parallel_for(
            surface.positions.size(), threads,
            [&](std::size_t i)
            { project_to_round(body, surface.positions[i], surface.facets[i], grid.is_2d); },
            4096);

    WallZoneOptions zone_options;
    zone_options.clearance_dp = settings.clearance_dp;
    zone_options.wall_particles = surface.positions.size();
    zone_options.is_solid = body.is_solid;
    WallZone zone = wall_zone(body.mesh, body.report, grid, zone_options, threads);
    out.warnings.insert(out.warnings.end(), zone.warnings.begin(), zone.warnings.end());
    if (body.is_solid && !zone.has_inside && zone.warnings.empty())
        out.warnings.emplace_back(
            "the shape has no inside that could be filled: only its surface has particles");
    body.clearance_inside = zone.clearance_inside_dp * grid.dp;
    body.clearance_outside = zone.clearance_outside_dp * grid.dp;
    take_figures(zone, zone_options, out.second_sheet.positions.size(), grid, body);
    if (zone.has_inside && body.figures.filled == 0)
        out.hollow = by_slab(SpanSet{zone.volume}, grid);
    out.zone = by_slab(std::move(zone.zone), grid);
    out.volume = by_slab(body.is_solid ? std::move(zone.volume) : SpanSet{}, grid);
    for (const ClipPlane& clip : clips)
        parallel_for(grid.n[0], threads,
                     [&](std::size_t x)
                     {
                         apply_clip(out.zone[x], static_cast<std::uint32_t>(x), clip, grid);
                         apply_clip(out.volume[x], static_cast<std::uint32_t>(x), clip, grid);
                     });

    const std::size_t n = surface.positions.size();
    std::vector<char> is_kept(n);
    parallel_for(
        n, threads,
        [&](std::size_t i)
        {
            const Vec3& p = surface.positions[i];
            is_kept[i] = is_in_domain(p, grid) && is_kept_by(clips, p, grid.dp);
        },
        4096);
    WallParticles& particles = out.particles;
    std::size_t kept = 0;
    for (const char k : is_kept) kept += k != 0;
    particles.positions.reserve(kept);
    particles.kinds.reserve(kept);
    particles.facets.reserve(kept);
    for (std::size_t i = 0; i < n; ++i)
    {
        if (!is_kept[i])
        {
            out.cut.push_back(surface.positions[i]);
            continue;
        }
        particles.positions.push_back(surface.positions[i]);
        particles.kinds.push_back(surface.kinds[i]);
        particles.facets.push_back(surface.facets[i]);
    }
    particles.bodies.assign(kept, 0);
    particles.mk.assign(kept, 0);
    particles.held.assign(kept, 0);

    // A blob smaller than a cell, or a clip, can leave a particle without a node of the zone.
    std::vector<char> is_alone(kept);
    parallel_for(
        kept, threads,
        [&](std::size_t i)
        {
            const Vec3& p = particles.positions[i];
            is_alone[i] = !find_node_in(out.zone, p, grid) && cell_corners(p, grid).count > 0;
        },
        1024);
    std::vector<Spans> added(grid.n[0]);
    for (std::size_t i = 0; i < kept; ++i)
    {
        if (!is_alone[i]) continue;
        const Node c = cell_corners(particles.positions[i], grid).nodes[0];
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
    return out;
}

void WallPainter::add(FittedDraw&& draw)
{
    if (has_walls()) cut_by(draw);
    FittedWalls& walls = field_->walls;
    const auto body = static_cast<std::uint32_t>(walls.bodies.size());
    const std::uint16_t mk = draw.body.mk;
    parallel_for(
        field_->slabs.size(), threads_,
        [&](std::size_t x)
        {
            paint(field_->slabs[x], draw.volume[x], mk);
            paint(field_->slabs[x], draw.zone[x], static_cast<std::uint16_t>(mk | wall_zone_bit));
            for (const NodeShare& share : draw.shares)
            {
                paint(field_->slabs[x], intersect(draw.volume[x], share.nodes[x]), share.mk);
                paint(field_->slabs[x], intersect(draw.zone[x], share.nodes[x]),
                      static_cast<std::uint16_t>(share.mk | wall_zone_bit));
            }
        });
    walls.bodies.push_back(std::move(draw.body));
    const std::size_t first = walls.particles.size();
    std::fill(draw.particles.bodies.begin(), draw.particles.bodies.end(), body);
    std::fill(draw.particles.mk.begin(), draw.particles.mk.end(), mk);
    const std::vector<std::uint16_t>& facet_mk = walls.bodies.back().facet_mk;
    if (!facet_mk.empty())
        for (std::size_t i = 0; i < draw.particles.size(); ++i)
            draw.particles.mk[i] = facet_mk[draw.particles.facets[i]];
    if (first == 0)
        walls.particles = std::move(draw.particles);
    else
        walls.particles.append(draw.particles);
    walls.cut.insert(walls.cut.end(), draw.cut.begin(), draw.cut.end());
    walls.cut_bodies.resize(walls.cut.size(), body);
    const SurfaceParticles& second = draw.second_sheet;
    for (std::size_t i = 0; i < second.positions.size(); ++i)
    {
        walls.second_sheets.positions.push_back(second.positions[i]);
        walls.second_sheets.kinds.push_back(second.kinds[i]);
        walls.second_sheets.bodies.push_back(body);
        walls.second_sheets.facets.push_back(second.facets[i]);
        walls.second_sheets.mk.push_back(mk);
        walls.second_sheets.held.push_back(0);
    }
    is_cut_.resize(walls.particles.size(), 0);
    if (!draw.hollow.empty()) hollows_.push_back({body, std::move(draw.hollow)});
    anchor(first, draw.zone);
}

void WallPainter::anchor(std::size_t first_particle, const std::vector<Spans>& zone)
{
    const LatticeGrid& grid = field_->grid;
    const std::vector<Vec3>& positions = field_->walls.particles.positions;
    anchors_.resize(field_->slabs.size());
    std::vector<Node> nodes(positions.size() - first_particle);
    parallel_for(
        nodes.size(), threads_,
        [&](std::size_t i)
        { nodes[i] = find_node_in(zone, positions[first_particle + i], grid).value_or(Node{}); },
        1024);
    std::vector<char> touched(anchors_.size(), 0);
    for (std::size_t i = 0; i < nodes.size(); ++i)
    {
        const auto x = static_cast<std::size_t>(nodes[i].x);
        anchors_[x].push_back({static_cast<std::uint32_t>(nodes[i].y),
                               static_cast<std::uint32_t>(nodes[i].z),
                               static_cast<std::uint32_t>(first_particle + i)});
        touched[x] = 1;
    }
    parallel_for(anchors_.size(), threads_,
                 [&](std::size_t x)
                 {
                     if (!touched[x]) return;
                     std::sort(anchors_[x].begin(), anchors_[x].end(),
                               [](const Anchor& a, const Anchor& b) {
                                   return std::tuple(a.y, a.z, a.particle) <
                                          std::tuple(b.y, b.z, b.particle);
                               });
                 });
}

void WallPainter::cut_by(const FittedDraw& draw)
{
    const double reach = cut_distance_dp * field_->grid.dp;
    Box3 bounds;
    for (const auto& f : draw.body.mesh.facets)
        for (const std::uint32_t v : f) bounds.add(draw.body.mesh.vertices[v]);
    const auto is_near = [&](const Vec3& p) { return is_within(p, bounds, reach); };
    std::optional<MeshQuery> query;
    const std::vector<Vec3>& positions = field_->walls.particles.positions;
    if (std::none_of(positions.begin(), positions.end(), is_near)) return;
    query.emplace(soup_of(draw.body.mesh), threads_);
    parallel_for(
        positions.size(), threads_,
        [&](std::size_t i)
        {
            const Vec3& p = positions[i];
            if (is_cut_[i] || !is_near(p)) return;
            const double distance = query->closest_point(p).distance;
            const bool is_inside = draw.body.is_solid && is_inside_mesh(*query, p);
            if (distance < reach || is_inside)
                is_cut_[i] = is_inside && distance > touching_dp * field_->grid.dp ? 1 : touched;
        },
        1024);
}

Spans WallPainter::paint_over(std::size_t x, const Spans& spans, std::uint16_t mk, bool keeps_walls)
{
    if (!has_walls() || spans.empty()) return {};
    std::vector<std::uint16_t>& mks = field_->walls.particles.mk;
    if (x < anchors_.size())
    {
        auto span = spans.begin();
        for (const Anchor& a : anchors_[x])
        {
            while (span != spans.end() && (span->y < a.y || (span->y == a.y && span->z_end <= a.z)))
                ++span;
            if (span == spans.end()) break;
            if (span->y != a.y || a.z < span->z_begin || is_cut_[a.particle]) continue;
            if (keeps_walls)
                mks[a.particle] = mk;
            else
                is_cut_[a.particle] = 1;
        }
    }
    return keeps_walls ? intersect(spans, zone_of(field_->slabs[x])) : Spans{};
}

void WallPainter::reset()
{
    field_->walls = {};
    hollows_.clear();
    anchors_.clear();
    is_cut_.clear();
}

/// How much of a hollow body fills gave the mk of its wall.
double WallPainter::filled_share(const Hollow& hollow) const
{
    const std::uint16_t mk = field_->walls.bodies[hollow.body].mk;
    std::vector<std::array<std::uint64_t, 2>> counts(field_->slabs.size());
    parallel_for(counts.size(), threads_,
                 [&](std::size_t x)
                 {
                     if (hollow.nodes[x].empty()) return;
                     Spans own;
                     for (const Run& r : field_->slabs[x])
                         if (r.mk == mk) own.push_back({r.y, r.z_begin, r.z_end});
                     sort_and_join(own);
                     counts[x] = {count_nodes(hollow.nodes[x]),
                                  count_nodes(intersect(hollow.nodes[x], own))};
                 });
    std::uint64_t all = 0, filled = 0;
    for (const auto& [of_slab, own] : counts)
    {
        all += of_slab;
        filled += own;
    }
    return all > 0 ? static_cast<double>(filled) / static_cast<double>(all) : 0;
}

/// What touches a body takes particles of its wall, but nothing of its volume: the others of the
/// wall stand for it.
void WallPainter::hand_over_shares()
{
    struct Counts
    {
        double kept = 0, touched = 0;
    };
    std::vector<Counts> counts(field_->walls.bodies.size());
    for (std::size_t i = 0; i < is_cut_.size(); ++i)
    {
        Counts& of_body = counts[field_->walls.particles.bodies[i]];
        if (is_cut_[i] == 0) ++of_body.kept;
        if (is_cut_[i] == touched) ++of_body.touched;
    }
    for (std::size_t b = 0; b < counts.size(); ++b)
    {
        if (counts[b].kept == 0 || counts[b].touched == 0) continue;
        FittedBody& body = field_->walls.bodies[b];
        body.figures.kept = counts[b].kept / (counts[b].kept + counts[b].touched);
        body.settle_share(field_->grid.dp);
    }
}

void WallPainter::finish()
{
    for (const Hollow& hollow : hollows_)
    {
        FittedBody& body = field_->walls.bodies[hollow.body];
        body.figures.filled = filled_share(hollow);
        body.settle_share(field_->grid.dp);
    }
    hollows_.clear();
    FittedWalls& walls = field_->walls;
    WallParticles& all = walls.particles;
    hand_over_shares();
    for (std::size_t i = 0; i < all.size(); ++i)
    {
        if (!is_cut_[i]) continue;
        walls.cut.push_back(all.positions[i]);
        walls.cut_bodies.push_back(all.bodies[i]);
    }
    anchors_.clear();
    if (walls.cut.empty()) return;
    all.erase(is_cut_);
    is_cut_.clear();
    const double reach = held_distance_dp * field_->grid.dp;
    PointGrid cut(reach, walls.cut.size());
    Box3 cut_box;
    for (const Vec3& p : walls.cut)
    {
        cut.add(p);
        cut_box.add(p);
    }
    parallel_for(
        all.size(), threads_,
        [&](std::size_t i)
        {
            if (!is_within(all.positions[i], cut_box, reach)) return;
            cut.for_each_near(all.positions[i], reach,
                              [&](std::uint32_t c, double)
                              {
                                  if (walls.cut_bodies[c] == all.bodies[i]) all.held[i] = 1;
                              });
        },
        1024);
}

} // namespace fppg
