#include "lattice/wall_painter.h"

#include "core/parallel.h"
#include "lattice/flush_walls.h"
#include "meshes/crowded_points.h"
#include "meshes/inside_test.h"
#include "meshes/point_grid.h"
#include "nodes/cell_nodes.h"
#include "offset/wall_depth.h"

#include <algorithm>
#include <atomic>
#include <limits>
#include <tuple>
#include <utility>

namespace fppg
{
namespace
{

/// Later fitted bodies cut the particles of earlier ones within this distance of their surface, dp;
/// those of a lattice that are half a dp off it stay.
constexpr double cut_distance_dp = 0.5 - 1e-6;
/// Mark of a particle that a later body cuts although its place is not inside it.
constexpr char touched = 2;
/// Deeper in a later body than this a place is inside it, dp.
constexpr double touching_dp = 1e-6;
/// Nodes this near to a wall that a void touches stay those of its zone, dp.
constexpr double flush_zone_dp = 0.75;
/// A cut particle of a layer has another in its place so near, dp.
constexpr double replaced_dp = 0.9;
/// Fluid so near to the layer of a wall, on the wrong side of its surface, gives way to it, dp.
constexpr double before_layer_dp = 0.75;
/// Particles this near to a cut one are held in place, dp.
constexpr double held_distance_dp = 2;

/// The slab's runs that belong to the zone of a wall.
Spans zone_of(const std::vector<Run>& runs)
{
    Spans out;
    for (const Run& r : runs)
        if (r.is_covered) out.push_back({r.y, r.z_begin, r.z_end});
    sort_and_join(out);
    return out;
}

std::uint64_t count_nodes(const Spans& spans)
{
    std::uint64_t count = 0;
    for (const Span& s : spans) count += s.z_end - s.z_begin;
    return count;
}

/// How near to the surface of a later body others are cut, dp: what touches one whose particles
/// stand half a dp inside is far enough from them.
double cut_distance(const FittedDraw& draw, double dp)
{
    if (draw.body.is_inside) return touching_dp;
    double first = std::numeric_limits<double>::infinity();
    for (const FittedBody& layer : draw.layers) first = std::min(first, layer.depth / dp);
    return draw.layers.empty() ? cut_distance_dp
                               : std::clamp(least_pair_dp - first, touching_dp, cut_distance_dp);
}

} // namespace

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
            paint(field_->slabs[x], draw.zone[x], mk, true);
            for (const NodeShare& share : draw.shares)
            {
                paint(field_->slabs[x], intersect(draw.volume[x], share.nodes[x]), share.mk);
                paint(field_->slabs[x], intersect(draw.zone[x], share.nodes[x]), share.mk, true);
            }
        });
    walls.bodies.push_back(std::move(draw.body));
    hollowed_by_.resize(body + 1 + draw.layers.size());
    hollowed_by_[body] = std::move(draw.hollowed_by);
    for (FittedBody& layer : draw.layers)
    {
        layer.owner = body;
        layer.line = walls.bodies[body].line;
        layer.name += " of " + walls.bodies[body].name;
        layer.mk = mk;
        note_layered_wall(layer);
        walls.bodies.push_back(std::move(layer));
    }
    const std::size_t first = walls.particles.size();
    for (WallParticles* particles : {&draw.particles, &draw.second_sheet})
        for (std::size_t i = 0; i < particles->size(); ++i)
        {
            particles->bodies[i] += body;
            const std::vector<std::uint16_t>& facet_mk =
                walls.bodies[particles->bodies[i]].facet_mk;
            particles->mk[i] = facet_mk.empty() ? mk : facet_mk[particles->facets[i]];
        }
    if (first == 0)
        walls.particles = std::move(draw.particles);
    else
        walls.particles.append(draw.particles);
    walls.cut.insert(walls.cut.end(), draw.cut.begin(), draw.cut.end());
    for (const std::uint32_t of_draw : draw.cut_bodies) walls.cut_bodies.push_back(body + of_draw);
    walls.second_sheets.append(draw.second_sheet);
    is_cut_.resize(walls.particles.size(), 0);
    if (!draw.hollow.empty()) hollows_.push_back({body, std::move(draw.hollow)});
    anchor(first, draw.zone);
}

void WallPainter::anchor(std::size_t first_particle, const std::vector<Spans>& zone)
{
    const LatticeGrid& grid = field_->grid;
    const std::vector<Vec3>& positions = field_->walls.particles.positions;
    anchors_.resize(field_->slabs.size());
    std::vector<char> is_reached(anchors_.size(), 0);
    constexpr std::size_t most_at_once = 1'000'000;
    std::vector<Node> nodes;
    for (std::size_t first = first_particle; first < positions.size(); first += nodes.size())
    {
        nodes.resize(std::min(most_at_once, positions.size() - first));
        parallel_for(
            nodes.size(), threads_,
            [&](std::size_t i)
            { nodes[i] = find_node_in(zone, positions[first + i], grid).value_or(Node{}); },
            1024);
        for (std::size_t i = 0; i < nodes.size(); ++i)
        {
            const auto x = static_cast<std::size_t>(nodes[i].x);
            anchors_[x].push_back({static_cast<std::uint32_t>(nodes[i].y),
                                   static_cast<std::uint32_t>(nodes[i].z),
                                   static_cast<std::uint32_t>(first + i)});
            is_reached[x] = 1;
        }
    }
    parallel_for(anchors_.size(), threads_,
                 [&](std::size_t x)
                 {
                     if (!is_reached[x]) return;
                     std::sort(anchors_[x].begin(), anchors_[x].end(),
                               [](const Anchor& a, const Anchor& b) {
                                   return std::tuple(a.y, a.z, a.particle) <
                                          std::tuple(b.y, b.z, b.particle);
                               });
                 });
}

void WallPainter::cut_by(const FittedDraw& draw)
{
    const double reach = cut_distance(draw, field_->grid.dp) * field_->grid.dp;
    Box3 bounds;
    for (const auto& f : draw.body.mesh.facets)
        for (const std::uint32_t v : f) bounds.add(draw.body.mesh.vertices[v]);
    double deepest = 0;
    for (const FittedBody& layer : draw.layers) deepest = std::max(deepest, layer.depth);
    const auto is_near = [&](const Vec3& p) { return bounds.has(p, deepest + reach); };
    const std::vector<Vec3>& positions = field_->walls.particles.positions;
    if (std::none_of(positions.begin(), positions.end(), is_near)) return;
    const InsideTest test(soup_of(draw.body.mesh), threads_);
    test.query().prepare_nearest();
    // Layers take the place of what stood there, as the nodes between them are taken.
    const auto is_among_layers = [&](const Vec3& p)
    {
        return std::any_of(draw.layers.begin(), draw.layers.end(),
                           [&](const FittedBody& layer)
                           {
                               const DepthPlace place = layer.wall->at(p);
                               return !place.is_beyond_rim && place.depth > 0 &&
                                      place.depth < layer.depth + reach;
                           });
    };
    parallel_for(
        positions.size(), threads_,
        [&](std::size_t i)
        {
            const Vec3& p = positions[i];
            if (is_cut_[i] || !is_near(p)) return;
            const double distance = test.query().closest_point(p).distance;
            const bool is_inside = (draw.body.is_solid && test.is_inside(p)) || is_among_layers(p);
            if (distance < reach || is_inside)
                is_cut_[i] = is_inside && distance > touching_dp * field_->grid.dp ? 1 : touched;
        },
        1024);
}

void WallPainter::set_extent(TriangleSoup&& extent, bool is_void)
{
    extent_.reset();
    is_flush_.assign(field_->walls.particles.size(), 0);
    flush_ = PointGrid(flush_zone_dp * field_->grid.dp, 0);
    if (extent.size() == 0) return;
    extent_ = std::make_unique<const InsideTest>(std::move(extent), threads_);
    extent_->query().prepare_nearest();
    if (!is_void) return;
    is_flush_ = flush_particles(field_->walls, *extent_, field_->grid.dp, threads_);
    for (std::size_t i = 0; i < is_flush_.size(); ++i)
        if (is_flush_[i]) flush_.add(field_->walls.particles.positions[i]);
}

bool WallPainter::cut_by_shape(const SourceRef& draw, FittedStep& step)
{
    set_extent(std::move(step.extent), step.is_void);
    const std::vector<FittedBody>& bodies = field_->walls.bodies;
    is_spared_.assign(bodies.size(), 0);
    if (!step.openings.empty()) is_spared_ = sheets_among(bodies);
    spared_mks_.clear();
    is_of_wall_.assign(65536, 0);
    for (const FittedBody& body : bodies)
    {
        is_of_wall_[body.mk] = 1;
        for (const std::uint16_t mk : body.facet_mk) is_of_wall_[mk] = 1;
    }
    for (std::size_t b = 0; b < bodies.size(); ++b)
    {
        const std::vector<const SourceRef*>& by =
            hollowed_by_[bodies[b].is_layer() ? bodies[b].owner : b];
        if (std::find(by.begin(), by.end(), &draw) == by.end()) continue;
        is_spared_[b] = 1;
        spared_mks_.push_back(bodies[b].mk);
        for (WallOpening& opening : step.openings)
            opening.shaped.push_back(static_cast<std::uint32_t>(b));
    }
    for (WallOpening& opening : step.openings)
    {
        opening.bodies = static_cast<std::uint32_t>(bodies.size());
        openings_.push_back(std::move(opening));
    }
    return extent_ != nullptr ||
           std::find(is_spared_.begin(), is_spared_.end(), 1) != is_spared_.end();
}

bool WallPainter::is_in_extent(const Vec3& p) const
{
    return extent_->is_inside(p) ||
           extent_->query().closest_point(p).distance < on_face_dp * field_->grid.dp;
}

void WallPainter::note_layered_wall(const FittedBody& layer)
{
    if (layer.wall == nullptr || layer.mesh.facets.empty()) return; // shared by two sides
    if (layered_walls_.empty() || layered_walls_.back().wall != layer.wall.get())
    {
        layered_walls_.push_back({{}, layer.wall.get(), {}});
        for (const Vec3& v : layer.wall->mesh().vertices) layered_walls_.back().box.add(v);
    }
    layered_walls_.back().depths.push_back(layer.depth);
}

/// Whether a place is behind the surface of a wall and near to a layer of it that the draw does not
/// reach.
bool WallPainter::is_before_layer(const Vec3& p) const
{
    const double dp = field_->grid.dp;
    return std::any_of(
        layered_walls_.begin(), layered_walls_.end(),
        [&](const LayeredWall& wall)
        {
            if (!wall.box.has(p, wall.depths.back())) return false;
            const DepthPlace place = wall.wall->at(p);
            if (place.is_beyond_rim || !(place.depth > touching_dp * dp)) return false;
            const auto next = std::lower_bound(wall.depths.begin(), wall.depths.end(), place.depth);
            return next != wall.depths.end() && *next - place.depth < before_layer_dp * dp &&
                   !is_in_extent(place.foot + *next * place.direction);
        });
}

Spans WallPainter::without_spared(std::size_t x, const Spans& spans) const
{
    if (spared_mks_.empty() && extent_ == nullptr) return spans;
    Spans zone;
    for (const Run& r : field_->slabs[x])
        if (r.is_covered &&
            std::find(spared_mks_.begin(), spared_mks_.end(), r.mk) != spared_mks_.end())
            zone.push_back({r.y, r.z_begin, r.z_end});
    sort_and_join(zone);
    Spans left = subtract(spans, zone);
    if (extent_ == nullptr) return left;
    Spans walls;
    for (const Run& r : field_->slabs[x])
        if (r.is_covered || is_of_wall_[r.mk] != 0) walls.push_back({r.y, r.z_begin, r.z_end});
    sort_and_join(walls);
    Spans beyond;
    for (const Span& s : intersect(left, walls))
        for (std::uint32_t z = s.z_begin; z < s.z_end; ++z)
        {
            const Vec3 p = position(Node{static_cast<std::int64_t>(x), s.y, z}, field_->grid);
            if (!is_in_extent(p) || is_before_layer(p) ||
                flush_.has_nearer(p, flush_zone_dp * field_->grid.dp))
                beyond.push_back({s.y, z, z + 1});
        }
    sort_and_join(beyond);
    return subtract(left, beyond);
}

Spans WallPainter::paint_over(std::size_t x, const Spans& spans, std::uint16_t mk, bool keeps_walls,
                              bool spares)
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
            else if (!spares || !is_spared(a.particle))
                is_cut_[a.particle] = 1;
        }
    }
    return keeps_walls ? intersect(spans, zone_of(field_->slabs[x])) : Spans{};
}

bool WallPainter::is_spared(std::uint32_t particle) const
{
    const WallParticles& all = field_->walls.particles;
    return is_spared_[all.bodies[particle]] != 0 || is_flush_[particle] != 0 ||
           (extent_ != nullptr && !is_in_extent(all.positions[particle]));
}

void WallPainter::cut_where(const std::function<bool(const Vec3&)>& is_cut)
{
    const std::vector<Vec3>& positions = field_->walls.particles.positions;
    parallel_for(
        positions.size(), threads_,
        [&](std::size_t i)
        {
            if (is_cut(positions[i])) is_cut_[i] = 1;
        },
        1024);
}

void WallPainter::reset()
{
    field_->walls = {};
    hollows_.clear();
    anchors_.clear();
    is_cut_.clear();
    openings_.clear();
    hollowed_by_.clear();
    layered_walls_.clear();
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
                         if (r.mk == mk && !r.is_covered) own.push_back({r.y, r.z_begin, r.z_end});
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
        const std::uint32_t b = field_->walls.particles.bodies[i];
        const FittedBody& drawn = field_->walls.bodies[b];
        Counts& of_body = counts[drawn.is_layer() ? drawn.owner : b];
        if (is_cut_[i] == 0) ++of_body.kept;
        if (is_cut_[i] == touched) ++of_body.touched;
    }
    for (std::size_t b = 0; b < counts.size(); ++b)
    {
        if (counts[b].kept == 0 || counts[b].touched == 0) continue;
        FittedBody& body = field_->walls.bodies[b];
        body.measures.kept = counts[b].kept / (counts[b].kept + counts[b].touched);
        body.settle_share(field_->grid.dp);
    }
}

void WallPainter::cut_crowded()
{
    FittedWalls& walls = field_->walls;
    const WallParticles& all = walls.particles;
    const double distance = least_pair_dp * field_->grid.dp;
    const auto owner_of = [&](std::size_t i) -> std::size_t
    {
        const FittedBody& body = walls.bodies[all.bodies[i]];
        return body.is_layer() ? body.owner : all.bodies[i];
    };
    std::vector<Box3> boxes(walls.bodies.size());
    for (std::size_t i = 0; i < all.size(); ++i)
        if (is_cut_[i] == 0) boxes[owner_of(i)].add(all.positions[i]);
    std::vector<std::vector<Box3>> near(boxes.size()); // of others that a body may touch
    for (std::size_t a = 0; a < boxes.size(); ++a)
        for (std::size_t b = 0; b < boxes.size(); ++b)
        {
            if (a == b || boxes[a].is_empty() || boxes[b].is_empty()) continue;
            bool meet = true;
            for (int axis = 0; axis < 3; ++axis)
                meet = meet && boxes[a].min[axis] <= boxes[b].max[axis] + distance &&
                       boxes[b].min[axis] <= boxes[a].max[axis] + distance;
            if (meet) near[a].push_back(boxes[b]);
        }
    std::vector<std::size_t> found; // later draws first, which stay
    for (std::size_t i = all.size(); i-- > 0;)
    {
        if (is_cut_[i] != 0) continue;
        const std::vector<Box3>& others = near[owner_of(i)];
        if (std::any_of(others.begin(), others.end(),
                        [&](const Box3& box) { return box.has(all.positions[i], distance); }))
            found.push_back(i);
    }
    std::vector<Vec3> points;
    std::vector<std::uint32_t> rank;
    for (const std::size_t i : found)
    {
        points.push_back(all.positions[i]);
        rank.push_back(4 * static_cast<std::uint32_t>(walls.bodies[all.bodies[i]].layer) +
                       static_cast<std::uint32_t>(all.kinds[i]));
    }
    const auto may_stay = [&](std::size_t a, std::size_t b)
    { return owner_of(found[a]) == owner_of(found[b]); };
    const std::vector<char> goes = find_crowded(points, rank, distance, may_stay, threads_);
    for (std::size_t k = 0; k < found.size(); ++k)
    {
        if (goes[k] == 0) continue;
        is_cut_[found[k]] = touched;
        ++walls.bodies[owner_of(found[k])].left_out[static_cast<std::size_t>(all.kinds[found[k]])];
    }
}

/// Tells the walls which particles were cut; where a later layer has taken the place of another
/// nothing is missing.
void WallPainter::note_missing()
{
    FittedWalls& walls = field_->walls;
    const WallParticles& all = walls.particles;
    const double replaced = replaced_dp * field_->grid.dp;
    const auto is_of_layer = [&](std::size_t i) { return walls.bodies[all.bodies[i]].is_layer(); };
    PointGrid of_layers(replaced, 0);
    Box3 box;
    std::vector<std::size_t> cut;
    for (std::size_t i = 0; i < all.size(); ++i)
    {
        if (is_cut_[i] == 0) continue;
        cut.push_back(i);
        if (!is_of_layer(i)) continue;
        of_layers.add(all.positions[i]);
        box.add(all.positions[i]);
    }
    std::vector<std::atomic<bool>> is_replaced(of_layers.points().size());
    parallel_for(
        all.size(), threads_,
        [&](std::size_t i)
        {
            const Vec3& p = all.positions[i];
            if (is_cut_[i] == 0 && box.has(p, replaced) && is_of_layer(i))
                of_layers.for_each_near(p, replaced,
                                        [&](std::uint32_t c, double)
                                        { is_replaced[c].store(true, std::memory_order_relaxed); });
        },
        1024);
    std::size_t layered = 0;
    for (const std::size_t i : cut)
    {
        const bool has_other =
            is_of_layer(i) && is_replaced[layered++].load(std::memory_order_relaxed);
        if (has_other && is_cut_[i] == touched) continue; // beside the other, some may be missing
        (has_other ? walls.replaced : walls.cut).push_back(all.positions[i]);
        (has_other ? walls.replaced_bodies : walls.cut_bodies).push_back(all.bodies[i]);
    }
}

void WallPainter::finish()
{
    cut_openings(openings_, field_->walls, field_->grid.dp, threads_, is_cut_);
    openings_.clear();
    cut_crowded();
    for (const Hollow& hollow : hollows_)
    {
        FittedBody& body = field_->walls.bodies[hollow.body];
        body.measures.filled = filled_share(hollow);
        body.settle_share(field_->grid.dp);
    }
    hollows_.clear();
    FittedWalls& walls = field_->walls;
    WallParticles& all = walls.particles;
    hand_over_shares();
    note_missing();
    anchors_.clear();
    if (std::any_of(is_cut_.begin(), is_cut_.end(), [](char c) { return c != 0; }))
        all.erase(is_cut_);
    is_cut_.clear();
    hold_beside_second_sheets();
    hold_beside(walls.cut, walls.cut_bodies);
    hold_beside(walls.replaced, walls.replaced_bodies);
}

/// Holds the particles that are near to places where none may be put.
///
/// holds  whether place c holds particle i
void WallPainter::hold_near(const std::vector<Vec3>& places,
                            const std::function<bool(std::size_t c, std::size_t i)>& holds)
{
    if (places.empty()) return;
    WallParticles& all = field_->walls.particles;
    const double reach = held_distance_dp * field_->grid.dp;
    PointGrid near(reach, places.size());
    Box3 box;
    for (const Vec3& p : places)
    {
        near.add(p);
        box.add(p);
    }
    parallel_for(
        all.size(), threads_,
        [&](std::size_t i)
        {
            if (!box.has(all.positions[i], reach)) return;
            near.for_each_near(all.positions[i], reach,
                               [&](std::uint32_t c, double)
                               {
                                   if (holds(c, i)) all.held[i] = 1;
                               });
        },
        1024);
}

void WallPainter::hold_beside(const std::vector<Vec3>& places,
                              const std::vector<std::uint32_t>& bodies)
{
    const WallParticles& all = field_->walls.particles;
    hold_near(places, [&](std::size_t c, std::size_t i) { return bodies[c] == all.bodies[i]; });
}

void WallPainter::hold_beside_second_sheets()
{
    const FittedWalls& walls = field_->walls;
    const WallParticles& all = walls.particles;
    const WallParticles& second = walls.second_sheets;
    hold_near(second.positions,
              [&](std::size_t c, std::size_t i)
              {
                  const FittedBody& body = walls.bodies[all.bodies[i]];
                  return second.bodies[c] == all.bodies[i] && !body.is_layer() &&
                         dot(body.mesh.normals[second.facets[c]],
                             body.mesh.normals[all.facets[i]]) > 0;
              });
}

} // namespace fppg
