#include "normals/wet_surface.h"

#include "core/parallel.h"
#include "meshes/point_grid.h"
#include "offset/wall_depth.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace fppg
{
namespace
{

/// Fluid is looked for so far off a surface, dp.
constexpr double off_surface_dp = 1.2;
/// A side can be dry when the way to it is so much longer, or rises so much higher, dp.
constexpr double longer_way_dp = 10;
constexpr double higher_way_dp = 10;
/// Facets are judged in pieces of at most this length, dp.
constexpr double longest_piece_dp = 3;
constexpr double opposing = -0.5;
/// Pieces of one side turn by less than 60 degrees from one to the next.
constexpr double same_facing = 0.5;

bool is_same_side(const FittedBody& a, const FittedBody& b)
{
    return a.is_layer() && a.owner == b.owner && a.wall->sign() == b.wall->sign();
}

constexpr char is_wet = 0;
constexpr char is_dry = 1;
constexpr char is_thin = 2; ///< wet, and so is the other side

/// Whether one side of a wall is dry beside the other.
bool is_dry_beside(const FluidWay::Way& here, const FluidWay::Way& there, bool is_moving)
{
    if (!(here.length > there.length + longer_way_dp)) return false;
    if (is_moving) return here.runs_out && !there.runs_out;
    return here.runs_out || here.rise > there.rise + higher_way_dp;
}

} // namespace

WetSurface::WetSurface(const RunField& field, const Setup& setup, int threads)
    : setup_(setup), reach_(setup.reach)
{
    cut_pieces(field);
    if (pieces_.empty()) return;
    if (std::any_of(pieces_.begin(), pieces_.end(), [](const Piece& p) { return p.is_closed; }))
        judge(field, FluidWay(field, setup.first_bound, setup.gravity), threads);
    note_thin_walls(field);
    make_query(threads);
    pieces_ = {};
    facets_ = {};
}

/// Of the wet pieces; those of a facet that is wet all over are the facet.
void WetSurface::make_query(int threads)
{
    TriangleSoup wet;
    const auto add = [&](const std::array<Vec3, 3>& corners, const WallDepth* exact_wall)
    {
        wet.vertices.insert(wet.vertices.end(), corners.begin(), corners.end());
        exact_walls_.push_back(exact_wall);
    };
    for (std::size_t f = 0; f < facets_.size(); ++f)
    {
        const auto begin = pieces_.begin() + static_cast<std::ptrdiff_t>(facets_[f].first_piece);
        const auto end =
            f + 1 < facets_.size()
                ? pieces_.begin() + static_cast<std::ptrdiff_t>(facets_[f + 1].first_piece)
                : pieces_.end();
        const auto dry =
            std::count_if(begin, end, [](const Piece& p) { return p.state == is_dry; });
        if (dry == 0)
            add(facets_[f].corners, begin->exact_wall);
        else
            for (auto piece = begin; piece != end; ++piece)
                if (piece->state != is_dry) add(piece->corners, piece->exact_wall);
        has_dry_sides_ = has_dry_sides_ || dry > 0;
    }
    if (wet.vertices.empty()) return;
    query_ = std::make_unique<MeshQuery>(std::move(wet), threads);
    query_->prepare_nearest();
}

void WetSurface::cut_pieces(const RunField& field)
{
    const double longest = longest_piece_dp * field.grid.dp;
    const std::vector<FittedBody>& bodies = field.walls.bodies;
    for (std::uint32_t b = 0; b < bodies.size(); ++b)
    {
        // The first layer on each side names the surface and the way to the fluid.
        if (!bodies[b].is_layer() || is_same_side(bodies[b - 1], bodies[b])) continue;
        const SurfaceMesh& mesh = bodies[b].wall->mesh();
        Piece piece;
        piece.body = bodies[b].owner;
        piece.is_closed = bodies[piece.body].measures.volume > 0;
        piece.exact_wall = bodies[b].wall->is_exact() ? bodies[b].wall.get() : nullptr;
        for (std::size_t f = 0; f < mesh.facets.size(); ++f)
        {
            for (std::size_t c = 0; c < 3; ++c) piece.corners[c] = mesh.vertices[mesh.facets[f][c]];
            piece.normal = bodies[b].wall->sign() * mesh.normals[f];
            const FittedBody& owner = bodies[piece.body];
            piece.mk = owner.facet_mk.empty() ? owner.mk : owner.facet_mk[f];
            piece.is_moving = setup_.is_moving[piece.mk] != 0;
            facets_.push_back({piece.corners, pieces_.size()});
            add_pieces(piece, piece.is_closed ? longest : std::numeric_limits<double>::infinity());
        }
    }
}

void WetSurface::add_pieces(const Piece& whole, double longest)
{
    std::vector<Piece> todo{whole};
    while (!todo.empty())
    {
        const Piece now = todo.back();
        todo.pop_back();
        std::size_t side = 0;
        double length = 0;
        for (std::size_t s = 0; s < 3; ++s)
        {
            const double l = norm(now.corners[(s + 1) % 3] - now.corners[s]);
            if (l <= length) continue;
            length = l;
            side = s;
        }
        if (length <= longest)
        {
            pieces_.push_back(now);
            continue;
        }
        const Vec3 middle = 0.5 * (now.corners[side] + now.corners[(side + 1) % 3]);
        for (const std::size_t kept : {side, (side + 1) % 3})
        {
            Piece half = now;
            half.corners[kept] = middle;
            todo.push_back(half);
        }
    }
}

void WetSurface::judge(const RunField& field, const FluidWay& way, int threads)
{
    const double dp = field.grid.dp;
    std::vector<BodyWall> walls(field.walls.bodies.size());
    for (const FittedBody& body : field.walls.bodies)
    {
        if (!body.is_layer()) continue;
        BodyWall& wall = walls[body.owner];
        wall.depth = body.wall.get();
        wall.is_closed = field.walls.bodies[body.owner].measures.volume > 0;
        wall.is_moving = setup_.is_moving[body.mk] != 0;
        if (wall.box.is_empty())
            for (const Vec3& v : wall.depth->mesh().vertices) wall.box.add(v);
    }
    const auto before = [&](const Piece& piece)
    { return piece.middle() + (off_surface_dp * dp) * piece.normal; };
    std::vector<char> is_closed_in(65536, 0);
    parallel_for(
        pieces_.size(), threads,
        [&](std::size_t i)
        {
            if (pieces_[i].is_closed) pieces_[i].way = way.to(before(pieces_[i]));
        },
        256);
    for (const Piece& piece : pieces_)
        if (piece.is_closed && piece.is_moving && !piece.way.is_free) is_closed_in[piece.mk] = 1;
    // What others are too near to at the start gets free when it moves.
    std::vector<std::uint16_t> closed_in;
    for (std::size_t mk = 0; mk < is_closed_in.size(); ++mk)
        if (is_closed_in[mk] != 0) closed_in.push_back(static_cast<std::uint16_t>(mk));
    parallel_for(closed_in.size(), threads,
                 [&](std::size_t i)
                 {
                     const std::uint16_t mk = closed_in[i];
                     const FluidWay alone = FluidWay::around(field, setup_.first_bound, mk);
                     for (Piece& piece : pieces_)
                         if (piece.is_closed && piece.mk == mk && !piece.way.is_free)
                             piece.way = alone.to(before(piece));
                 });
    parallel_for(
        pieces_.size(), threads,
        [&](std::size_t i)
        {
            Piece& piece = pieces_[i];
            if (!piece.is_closed) return;
            if (is_covered(piece, walls, dp))
                piece.state = is_dry;
            else
                compare_sides(piece, *walls[piece.body].depth, way, dp);
        },
        64);
    const auto is_reached = [](const Piece& p)
    { return p.state != is_dry && std::isfinite(p.way.length); };
    if (std::any_of(pieces_.begin(), pieces_.end(), is_reached))
        for (Piece& piece : pieces_)
            if (!std::isfinite(piece.way.length)) piece.state = is_dry;
    dry_to_the_rims();
    dry_along_edges(threads);
}

/// Whether another closed wall begins right before a piece.
bool WetSurface::is_covered(const Piece& piece, const std::vector<BodyWall>& walls, double dp)
{
    const Vec3 before = piece.middle() + (0.3 * dp) * piece.normal;
    for (std::size_t b = 0; b < walls.size(); ++b)
    {
        const BodyWall& wall = walls[b];
        if (b == piece.body || wall.depth == nullptr || !wall.is_closed ||
            wall.is_moving != piece.is_moving)
            continue;
        bool is_in_box = true;
        for (int axis = 0; axis < 3; ++axis)
            is_in_box =
                is_in_box && before[axis] > wall.box.min[axis] && before[axis] < wall.box.max[axis];
        if (is_in_box && wall.depth->at(before).depth > 0) return true;
    }
    return false;
}

/// The other side of a thin wall is looked for half a reach and a reach under a piece.
void WetSurface::compare_sides(Piece& piece, const WallDepth& wall, const FluidWay& way,
                               double dp) const
{
    const Vec3 middle = piece.middle();
    DepthPlace other;
    Vec3 other_normal = piece.normal;
    for (const double share : {0.5, 1.0})
    {
        if (dot(other_normal, piece.normal) <= opposing) continue;
        other = wall.at(middle - (share * reach_) * piece.normal);
        other_normal = wall.sign() * wall.mesh().normals[other.facet];
    }
    if (dot(other_normal, piece.normal) > opposing) return;
    piece.thickness = dot(middle - other.nearest, piece.normal);
    piece.is_straight =
        norm(middle - piece.thickness * piece.normal - other.nearest) < piece.thickness;
    // Particles nearer to one side are within reach of the other.
    if (!(piece.thickness < 2 * reach_)) return;
    const FluidWay::Way there = way.to(other.nearest + (off_surface_dp * dp) * other_normal);
    piece.other_way = there.length;
    if (!std::isfinite(piece.way.length) && !std::isfinite(there.length)) return;
    if (is_dry_beside(piece.way, there, piece.is_moving))
        piece.state = is_dry;
    else if (!is_dry_beside(there, piece.way, piece.is_moving))
        piece.state = is_thin;
}

/// Towards the rim of a tank the way to the outside is shorter. Its walls would look aslant to the
/// strip there instead of through themselves.
void WetSurface::dry_to_the_rims()
{
    std::vector<std::size_t> front;
    std::vector<std::size_t> candidates;
    PointGrid near(reach_, pieces_.size() / 4);
    for (std::size_t i = 0; i < pieces_.size(); ++i)
    {
        const Piece& piece = pieces_[i];
        if (piece.state == is_dry) front.push_back(i);
        if (piece.state != is_thin || !(piece.way.length > piece.other_way + 1)) continue;
        candidates.push_back(i);
        near.add(piece.middle());
    }
    while (!front.empty() && !candidates.empty())
    {
        const Piece from = pieces_[front.back()];
        front.pop_back();
        near.for_each_near(from.middle(), reach_,
                           [&](std::uint32_t c, double)
                           {
                               Piece& piece = pieces_[candidates[c]];
                               if (piece.state == is_dry || piece.body != from.body ||
                                   dot(piece.normal, from.normal) < same_facing)
                                   return;
                               piece.state = is_dry;
                               front.push_back(candidates[c]);
                           });
    }
}

/// Along the edges of a dry side no place lies right behind another: what is far from the fluid and
/// near to a dry piece is dry too.
void WetSurface::dry_along_edges(int threads)
{
    const auto is_far_from_fluid = [](const Piece& piece)
    {
        return piece.way.length > longer_way_dp &&
               (piece.way.runs_out || (!piece.is_moving && piece.way.rise > higher_way_dp));
    };
    PointGrid dry(2 * reach_, pieces_.size() / 4);
    for (const Piece& piece : pieces_)
        if (piece.state == is_dry) dry.add(piece.middle());
    if (dry.points().empty()) return;
    parallel_for(
        pieces_.size(), threads,
        [&](std::size_t i)
        {
            Piece& piece = pieces_[i];
            if (piece.is_closed && piece.state == is_wet && piece.thickness == 0 &&
                is_far_from_fluid(piece) && dry.has_nearer(piece.middle(), 2 * reach_))
                piece.state = is_dry;
        },
        256);
}

void WetSurface::note_thin_walls(const RunField& field)
{
    const double enough = reach_ - 0.5 * field.grid.dp;
    for (const Piece& piece : pieces_)
    {
        if (piece.state != is_thin || !piece.is_straight || !(piece.thickness < enough)) continue;
        const std::uint16_t mk = field.walls.bodies[piece.body].mk;
        auto found = std::find_if(thin_walls_.begin(), thin_walls_.end(),
                                  [&](const ThinWall& wall) { return wall.mk == mk; });
        if (found == thin_walls_.end()) found = thin_walls_.insert(found, {mk, piece.thickness, 0});
        found->thickness = std::min(found->thickness, piece.thickness);
        found->area += 0.5 * norm(cross(piece.corners[1] - piece.corners[0],
                                        piece.corners[2] - piece.corners[0]));
    }
}

Vec3 WetSurface::vector_from(const Vec3& p, double most) const
{
    if (query_ == nullptr) return {};
    const ClosestPoint near = query_->closest_point(p, most);
    if (!(near.distance <= most)) return {};
    const WallDepth* exact_wall = exact_walls_[near.facet];
    if (exact_wall == nullptr) return near.point - p;
    // From the facets to their exact surface. Its nearest place may be on a dry side.
    const Vec3 nearest = exact_wall->at(p).nearest;
    const bool is_wet_one = std::fabs(norm(nearest - p) - near.distance) <= 2 * exact_wall->chord();
    return (is_wet_one ? nearest : exact_wall->at(near.point).nearest) - p;
}

} // namespace fppg
